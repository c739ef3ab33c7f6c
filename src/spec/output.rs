//! What is written of a leaf: maps, formats, and how they are named and drawn.

use crate::parameter::{Choice as _, parameters, words};
use crate::spelling::advice;
use crate::texture::TextureError;
use crate::texture::map::{MapKind, MapSet};

words! {
    /// A form of the leaf other than pictures.
    pub enum FormatKind {
        /// A textured card.
        Obj = "obj",
        /// A textured card in one binary file.
        Glb = "glb",
        /// A textured card as text.
        Usda = "usda",
        /// Outline and veins as vectors.
        Svg = "svg",
        /// Outline and veins for cutters.
        Dxf = "dxf",
        /// The vein graph.
        Json = "json",
        /// The vein graph for networkx, Gephi, igraph.
        GraphMl = "graphml",
        /// Tables of nodes, edges and areoles.
        Csv = "csv",
    }
}

impl FormatKind {
    /// The formats that are written unless others are asked for.
    pub const DEFAULT: &'static [Self] = &[Self::Obj];
}

words! {
    /// The sheet that a card's pictures lie on.
    pub enum CardShape {
        /// The square of the textures.
        Square = "square",
        /// A few dozen corners around the leaf: hardly a texel is drawn for nothing.
        Outline = "outline",
    }
}

words! {
    /// What the lines of an SVG are for.
    pub enum SvgStyle {
        /// To look at: veins as wide as they are.
        Print = "print",
        /// A pen of its own width: single lines, each as long as it goes on.
        Plotter = "plotter",
        /// Hairlines, red to cut through and blue to score.
        Laser = "laser",
    }
}

words! {
    /// Whose names and packing the maps follow.
    pub enum Profile {
        /// Names that Blender's Node Wrangler and most importers sort by.
        Default = "default",
        /// `T_name_BC`, `_N` (DirectX), `_ORM`.
        Unreal = "unreal",
        /// `_BaseMap`, `_Normal`, `_MaskMap`.
        UnityHdrp = "unity-hdrp",
        /// `_diff`, `_nor_gl`, `_disp`, `_arm`, names in small letters.
        PolyHaven = "polyhaven",
        /// `_Color`, `_NormalGL`, `_NormalDX`, `_Displacement`.
        AmbientCg = "ambientcg",
        /// `_Color`, `_Normal`, `_Gloss`, `_SubsurfaceColor`.
        SpeedTree = "speedtree",
    }
}

impl Profile {
    /// The maps that are written unless others are asked for.
    #[must_use]
    pub const fn maps(self) -> &'static [MapKind] {
        use MapKind as M;
        match self {
            Self::Default => MapKind::DEFAULT,
            Self::Unreal => &[M::BaseColour, M::NormalDx, M::Orm, M::Height, M::Translucency],
            Self::UnityHdrp => {
                &[M::BaseColour, M::Normal, M::Height, M::MaskMap, M::Translucency, M::Thickness]
            }
            Self::PolyHaven => &[
                M::BaseColour,
                M::Opacity,
                M::Normal,
                M::NormalDx,
                M::Height,
                M::Roughness,
                M::AmbientOcclusion,
                M::Orm,
                M::Translucency,
            ],
            Self::AmbientCg => &[
                M::BaseColour,
                M::Opacity,
                M::Normal,
                M::NormalDx,
                M::Height,
                M::Roughness,
                M::AmbientOcclusion,
                M::Translucency,
            ],
            Self::SpeedTree => &[
                M::BaseColour,
                M::Opacity,
                M::Normal,
                M::Height,
                M::Gloss,
                M::AmbientOcclusion,
                M::Translucency,
                M::Thickness,
            ],
        }
    }
}

parameters! {
    /// What is written of a leaf.
    pub struct OutputSpec {
        /// Maps to write of each side: some of basecolor, opacity, normal, normaldx, height,
        /// roughness, gloss, ambientocclusion, orm, maskmap, translucency, thickness, veinmask,
        /// veinorder, bump, for people preview and enhancement; or default (the profile's), or all, or
        /// none.
        maps: text("default"),
        /// Other files to write: some of obj, glb, usda, svg, dxf, json, graphml, csv; or all, or none.
        formats: text("obj"),
        /// Whose names and packing the maps follow.
        profile: choice(Profile, Profile::Default),
        /// Bits of a channel, 8 or 16; heights and thickness always have 16, vein orders 8.
        bits: one_of(8, &[8, 16]),
        /// Whether every map comes with its smaller levels, in mips/: colour as a mean of light, coverage
        /// kept.
        mips: flag(false),
        /// The sheet of the cards in obj, glb and usda.
        card: choice(CardShape, CardShape::Square),
        /// What the lines of the svg are for.
        svg_style: choice(SvgStyle, SvgStyle::Print),
        /// Whether the outline in svg and dxf goes around the petiole, too, in one line with the blade's.
        petiole: flag(false),
        /// Veins narrower than this are left out of svg and dxf: no cutter or pen could keep them.
        least_width_mm: number(0.0, 0.0..=100.0, "mm"),
    }
}

/// Why it is not known what to write.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// A map that there is not.
    #[error(transparent)]
    Map(#[from] TextureError),
    /// A format that there is not.
    #[error("output.formats: `{word}` {}", advice(word, "format", FormatKind::WORDS.iter().copied()))]
    Format {
        /// As given.
        word: String,
    },
    /// Neither 8 nor 16.
    #[error("output.bits = {bits}: a channel has 8 or 16")]
    Bits {
        /// As given.
        bits: u64,
    },
}

impl OutputError {
    /// The key that is to be changed.
    #[must_use]
    pub fn key(&self) -> &'static str {
        match self {
            Self::Map(_) => "output.maps",
            Self::Format { .. } => "output.formats",
            Self::Bits { .. } => "output.bits",
        }
    }
}

/// [`OutputSpec`] with every word understood.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    /// The maps to write of each side.
    pub maps: Vec<MapKind>,
    /// The other forms to write.
    pub formats: Vec<FormatKind>,
    /// Whose names the maps have.
    pub profile: Profile,
    /// Bits of a channel where a map may have either: 8 or 16.
    pub bits: u8,
    /// Whether smaller levels are written too.
    pub mips: bool,
    /// The sheet of the cards.
    pub card: CardShape,
    /// What the lines of the SVG are for.
    pub svg_style: SvgStyle,
    /// Whether the outline that is drawn is that of the blade and the petiole.
    pub petiole: bool,
    /// Veins narrower than this are not drawn (mm).
    pub least_width_mm: f64,
}

impl OutputSpec {
    /// Understands every word.
    ///
    /// # Errors
    ///
    /// [`OutputError`] with the word that means nothing.
    pub fn resolve(&self) -> Result<Output, OutputError> {
        let maps = match self.maps.trim() {
            word if is_default(word) => self.profile.maps().to_vec(),
            // Among others `default` stands for its words.
            words => {
                let standard = self.profile.maps().iter().map(|map| map.word());
                let standard = standard.collect::<Vec<_>>().join(",");
                let spelt = words.split(',').map(|word| match word.trim() {
                    word if is_default(word) => &standard[..],
                    word => word,
                });
                MapKind::list(&spelt.collect::<Vec<_>>().join(","))?
            }
        };
        let formats = match self.formats.trim().to_ascii_lowercase().as_str() {
            "none" => Vec::new(),
            "all" => FormatKind::ALL.to_vec(),
            words => words.split(',').map(format).collect::<Result<_, _>>()?,
        };
        let bits = match self.bits {
            8 => 8,
            16 => 16,
            bits => return Err(OutputError::Bits { bits }),
        };
        Ok(Output {
            maps,
            formats,
            profile: self.profile,
            bits,
            mips: self.mips,
            card: self.card,
            svg_style: self.svg_style,
            petiole: self.petiole,
            least_width_mm: self.least_width_mm,
        })
    }
}

impl OutputSpec {
    /// The same with the maps and formats of another added.
    ///
    /// # Errors
    ///
    /// As [`resolve`](Self::resolve), of either.
    pub fn joined(&self, other: &Self) -> Result<Self, OutputError> {
        let (own, others) = (self.resolve()?, other.resolve()?);
        let mut joined = self.clone();
        if !others.maps.iter().all(|map| own.maps.contains(map)) {
            let of_either = |map: &&MapKind| own.maps.contains(map) || others.maps.contains(map);
            let words = MapKind::ALL.iter().filter(of_either).map(|map| map.word());
            joined.maps = words.collect::<Vec<_>>().join(",");
        }
        if !others.formats.iter().all(|format| own.formats.contains(format)) {
            let of_either =
                |kind: &&FormatKind| own.formats.contains(kind) || others.formats.contains(kind);
            let words = FormatKind::ALL.iter().filter(of_either).map(|kind| kind.word());
            joined.formats = words.collect::<Vec<_>>().join(",");
        }
        Ok(joined)
    }
}

fn is_default(word: &str) -> bool {
    word.eq_ignore_ascii_case("default")
}

fn format(word: &str) -> Result<FormatKind, OutputError> {
    let word = word.trim();
    let known = FormatKind::ALL.iter().copied().find(|kind| kind.word().eq_ignore_ascii_case(word));
    known.ok_or_else(|| OutputError::Format { word: word.to_owned() })
}

impl Output {
    /// The maps and formats of the default profile.
    #[must_use]
    pub fn standard() -> Self {
        OutputSpec::default().resolve().expect("the default words are known")
    }

    /// The planes of pixels that all this is made from.
    #[must_use]
    pub fn planes(&self) -> MapSet {
        let mut maps = self.maps.clone();
        if self.formats.contains(&FormatKind::Glb) {
            maps.extend([MapKind::Normal, MapKind::Orm, MapKind::Translucency]);
        }
        if self.bits == 16 {
            // Fine normals are made from heights.
            maps.push(MapKind::Height);
            return MapSet::of(&maps).deep();
        }
        MapSet::of(&maps)
    }
}
