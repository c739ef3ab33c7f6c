//! The pictures of a set of textures: which there are, what they are called and what is in them.
//!
//! Names follow a [`Profile`]; the words that other programs sort maps by are facts about those
//! programs. Smaller levels lie in a folder `mips` beside their map, out of sight of importers that take
//! every picture of a folder.

use super::card::{MapPaths, Side};
use super::file_stem;
use super::image::{Caption, map_png};
use super::manifest::FileRecord;
use crate::spec::{Output, Profile};
use crate::texture::map::{MapKind, Outside};
use crate::texture::{SideMaps, TextureSet, mip};

/// One picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MapFile {
    pub side: Side,
    pub map: MapKind,
    /// 0 is the map itself, 1 half its size, …
    pub level: usize,
}

/// Every picture, by its path, in the order of writing. Words that were asked for twice count once.
pub(super) fn list(name: &str, size: usize, output: &Output) -> Vec<(String, MapFile)> {
    let levels = if output.mips { mip::sizes(size).len() } else { 0 };
    let mut files = Vec::new();
    for side in Side::ALL {
        for &map in MapKind::ALL.iter().filter(|map| output.maps.contains(map)) {
            if side == Side::Back && !map.has_back() {
                continue;
            }
            let levels = if map.outside() == Outside::Paper { 0 } else { levels };
            for level in 0..=levels {
                files.push((
                    path(name, output.profile, side, map, level),
                    MapFile { side, map, level },
                ));
            }
        }
    }
    files
}

fn path(name: &str, profile: Profile, side: Side, map: MapKind, level: usize) -> String {
    let file = file_name(name, profile, map);
    match level {
        0 => format!("{}{file}.png", side.folder()),
        level => format!("{}mips/{file}_{level}.png", side.folder()),
    }
}

/// Where a side's maps lie that a card may name; those that are not written are `None`.
pub(super) fn paths(name: &str, side: Side, output: &Output) -> MapPaths {
    let of =
        |map: MapKind| output.maps.contains(&map).then(|| path(name, output.profile, side, map, 0));
    MapPaths {
        base_colour: of(MapKind::BaseColour),
        opacity: of(MapKind::Opacity),
        normal: of(MapKind::Normal),
        roughness: of(MapKind::Roughness),
        occlusion: of(MapKind::AmbientOcclusion),
    }
}

/// The name of a map's file, without its ending.
fn file_name(name: &str, profile: Profile, map: MapKind) -> String {
    let stem = file_stem(name);
    let suffix = suffix(profile, map);
    match profile {
        Profile::Unreal => format!("T_{stem}_{suffix}"),
        // Small letters, digits and `_` are all that a slug may have.
        Profile::PolyHaven => {
            let plain =
                |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' };
            format!("{}_{suffix}", stem.chars().map(plain).collect::<String>())
        }
        _ => format!("{stem}_{suffix}"),
    }
}

/// The end of a map's name. Maps that a profile does not know keep their own.
const fn suffix(profile: Profile, map: MapKind) -> &'static str {
    use MapKind as M;
    match (profile, map) {
        (Profile::Unreal, M::BaseColour) => "BC",
        (Profile::Unreal, M::NormalDx) => "N",
        (Profile::Unreal, M::Normal) => "NGL",
        (Profile::Unreal, M::Height) => "H",
        (Profile::Unreal, M::Roughness) => "R",
        (Profile::Unreal, M::AmbientOcclusion) => "AO",
        (Profile::Unreal, M::Opacity) => "O",
        (Profile::Unreal, M::Translucency) => "T",
        (Profile::UnityHdrp, M::BaseColour) => "BaseMap",
        (Profile::PolyHaven, M::BaseColour) => "diff",
        (Profile::PolyHaven, M::Normal) => "nor_gl",
        (Profile::PolyHaven, M::NormalDx) => "nor_dx",
        (Profile::PolyHaven, M::Height) => "disp",
        (Profile::PolyHaven, M::Roughness) => "rough",
        (Profile::PolyHaven, M::AmbientOcclusion) => "ao",
        (Profile::PolyHaven, M::Orm) => "arm",
        (Profile::PolyHaven, M::Opacity) => "alpha",
        (Profile::PolyHaven, M::Translucency) => "translucency",
        (Profile::PolyHaven, M::Thickness) => "thickness",
        (Profile::PolyHaven, M::VeinMask) => "mask",
        (Profile::AmbientCg, M::BaseColour) => "Color",
        (Profile::AmbientCg, M::Normal) => "NormalGL",
        (Profile::AmbientCg, M::Height) => "Displacement",
        (Profile::SpeedTree, M::BaseColour) => "Color",
        (Profile::SpeedTree, M::Translucency) => "SubsurfaceColor",
        (Profile::SpeedTree, M::Thickness) => "SubsurfaceAmount",
        (Profile::SpeedTree, M::AmbientOcclusion) => "AO",
        (_, map) => map.suffix(),
    }
}

/// What the pictures say of themselves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Texts<'a> {
    pub title: &'a str,
    pub name: &'a str,
    /// One seed, or the list of them.
    pub seed: &'a str,
    /// The resolved settings.
    pub settings: &'a str,
}

/// Textures and their smaller levels, ready to be written.
pub(super) struct Pictures<'a> {
    textures: &'a TextureSet,
    levels: [Vec<SideMaps>; 2],
    bits: u8,
}

impl<'a> Pictures<'a> {
    pub(super) fn new(textures: &'a TextureSet, output: &Output) -> Self {
        let levels = if output.mips {
            [mip::levels(&textures.front), mip::levels(&textures.back)]
        } else {
            [Vec::new(), Vec::new()]
        };
        Self { textures, levels, bits: output.bits }
    }

    fn maps(&self, file: MapFile) -> &SideMaps {
        let (full, levels) = match file.side {
            Side::Front => (&self.textures.front, &self.levels[0]),
            Side::Back => (&self.textures.back, &self.levels[1]),
        };
        file.level.checked_sub(1).map_or(full, |below| &levels[below])
    }

    pub(super) fn encode(&self, file: MapFile, texts: &Texts<'_>) -> Vec<u8> {
        let MapFile { side, map, level } = file;
        let maps = self.maps(file);
        let description = format!("{} side; {}", side.word(), map.meaning());
        // The picture that is passed on alone carries the settings, so that it can be made again.
        let whole = map == MapKind::BaseColour && level == 0;
        let texts: Vec<(&str, &str)> = [
            ("Title", texts.title),
            ("Description", &description),
            ("Name", texts.name),
            ("Seed", texts.seed),
        ]
        .into_iter()
        .chain(whole.then_some(("Settings", texts.settings)))
        .collect();
        let pixels_per_mm = self.textures.frame.pixels_per_mm(maps.size());
        let caption = Caption { pixels_per_mm: Some(pixels_per_mm), texts: &texts };
        let per_texel = self.textures.height_range_mm / 65535.0 * pixels_per_mm;
        let samples = maps.samples_of(map, self.bits, per_texel as f32);
        map_png(map, map.bits_of(self.bits), maps.dimensions(map), &samples, &caption)
    }

    /// A picture as a card carries it inside: 8 bits, nothing said.
    pub(super) fn plain(&self, side: Side, map: MapKind) -> Vec<u8> {
        let maps = self.maps(MapFile { side, map, level: 0 });
        map_png(map, map.bits(), maps.dimensions(map), &maps.samples(map), &Caption::default())
    }

    /// Fills what a manifest says of a picture.
    pub(super) fn describe(&self, file: MapFile, record: &mut FileRecord) {
        let (width, height) = self.maps(file).dimensions(file.map);
        record.map = Some(file.map.word().to_owned());
        record.side = Some(file.side.word().to_owned());
        record.level = (file.level > 0).then_some(file.level);
        record.channels = Some(file.map.channels().word().to_owned());
        record.bits = Some(file.map.bits_of(self.bits));
        record.colour_space = Some(file.map.colour_space().to_owned());
        (record.width, record.height) = (Some(width), Some(height));
    }
}
