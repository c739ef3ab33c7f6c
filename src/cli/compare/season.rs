//! One leaf through its year: a sheet of states, or a film of the season. It grows once.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use venation::document::Document;
use venation::io::animation::apng;
use venation::io::image::{Caption, colour_png};
use venation::io::write::{Overwrite, write_files};
use venation::observer::Silent;
use venation::pipeline::{self, Grown, Painter};
use venation::raster::Grid;
use venation::raster::montage::{self, Layout, Panel};
use venation::seed::Seed;
use venation::spec::LeafSpec;
use venation::texture::TextureSet;
use venation::texture::pigment::StateSpec;

use super::super::{Context, Failure, leaf_args, save};

/// Whether a film is written into one file of this name, and not into a folder.
pub(super) fn is_animation(out: &Path) -> bool {
    let ending = out.extension();
    ending.is_some_and(|end| ["png", "apng"].iter().any(|known| end.eq_ignore_ascii_case(known)))
}

/// States of a year: name, season, maturity.
const YEAR: [(&str, f64, f64); 6] = [
    ("spring", 0.0, 0.15),
    ("summer", 0.0, 1.0),
    ("early autumn", 0.32, 1.0),
    ("autumn", 0.55, 1.0),
    ("late autumn", 0.78, 1.0),
    ("litter", 1.0, 1.0),
];

/// Pictures a second of a film.
const FILM_RATE: u16 = 12;

/// Panels are no larger than this (pixels).
const PANEL_PX: usize = 420;

/// A leaf that has grown.
pub(super) struct Year {
    spec: LeafSpec,
    grown: Grown,
    seed: u64,
}

impl Year {
    pub(super) fn new(document: &Document, seed: u64) -> Result<Self, Failure> {
        let spec = leaf_args::resolve(document, seed)?;
        let grown = pipeline::grow(&spec, Seed(seed), &mut Silent)?;
        Ok(Self { spec, grown, seed })
    }

    /// Paints these maps of the leaf at one time after another.
    fn times(&self, maps: &str) -> Times<'_> {
        let mut spec = self.spec.clone();
        spec.output.maps = maps.into();
        Times { painter: Painter::new(&self.grown, Seed(self.seed)), spec }
    }

    /// The labelled sheet: front, back and against the light, a column for every state; and the states.
    pub(super) fn sheet(&self) -> Result<(Vec<u8>, Vec<State>), Failure> {
        let mut times = self.times("basecolor,preview");
        let mut rows: [Vec<Panel>; 3] = Default::default();
        let mut states = Vec::new();
        for (name, season, maturity) in YEAR {
            let set = times.paint(season, maturity)?;
            let colour = mean(&set.front.base_colour);
            states.push(State { name, season, maturity, seed: self.seed, colour });
            let notes = vec![if maturity < 1.0 {
                format!("maturity {maturity}")
            } else {
                format!("season {season}")
            }];
            let against = against_the_light(&set);
            rows[0].push(Panel { picture: set.front.base_colour, label: name.into(), notes });
            let plain =
                |picture, label: &str| Panel { picture, label: label.into(), notes: vec![] };
            rows[1].push(plain(set.back.base_colour, "back"));
            rows[2].push(plain(against, "against the light"));
        }
        let panels: Vec<Panel> = rows.into_iter().flatten().collect();
        let title = format!("{}: season, seed {}", self.spec.name, self.seed);
        let panel_px = (self.spec.texture.size_px as usize).min(PANEL_PX);
        let picture = montage::sheet(&title, &panels, Layout { columns: YEAR.len(), panel_px });
        Ok((colour_png(&picture, &Caption::default()), states))
    }

    /// The season from 0 to 1 in `frames` pictures: an animated PNG where `out` ends in `.png`, else
    /// single pictures in a folder.
    pub(super) fn film(
        &self,
        frames: usize,
        out: &Path,
        (force, dry_run): (bool, bool),
        context: &mut Context<'_>,
    ) -> Result<(), Failure> {
        let mut times = self.times("basecolor");
        let maturity = self.spec.state.maturity;
        let season = |i: usize| i as f64 / (frames - 1).max(1) as f64;
        if is_animation(out) {
            super::super::refuse_existing([&out.to_path_buf()], force)?;
            if dry_run {
                writeln!(context.stdout, "{}", out.display())?;
                return Ok(());
            }
            let pictures: Vec<Grid<[u8; 4]>> = (0..frames)
                .map(|i| Ok(times.paint(season(i), maturity)?.front.base_colour))
                .collect::<Result<_, Failure>>()?;
            save(out, apng(&pictures, FILM_RATE))?;
            writeln!(context.stdout, "{}", out.display())?;
            return Ok(());
        }
        let name = |i: usize| format!("{}_season_{:04}.png", self.spec.name, i + 1);
        let paths: Vec<PathBuf> = (0..frames).map(|i| out.join(name(i))).collect();
        super::super::refuse_existing(&paths, force)?;
        for (i, path) in paths.iter().enumerate() {
            if dry_run {
                writeln!(context.stdout, "{}", path.display())?;
                continue;
            }
            let set = times.paint(season(i), maturity)?;
            let file = (name(i), colour_png(&set.front.base_colour, &Caption::default()));
            times.painter.take_back(set);
            write_files(out, &[file], Overwrite::Force)?;
            writeln!(context.stdout, "{}", path.display())?;
        }
        Ok(())
    }
}

/// A leaf that is painted at one time of the year after another.
struct Times<'a> {
    painter: Painter<'a>,
    spec: LeafSpec,
}

impl Times<'_> {
    fn paint(&mut self, season: f64, maturity: f64) -> Result<TextureSet, Failure> {
        let health = self.spec.state.health;
        self.spec.state = StateSpec { season, maturity, health };
        Ok(self.painter.paint(&self.spec, &mut Silent)?)
    }
}

/// What a leaf looks like at a time of the year.
pub(super) struct State {
    name: &'static str,
    season: f64,
    maturity: f64,
    seed: u64,
    /// The mean of its front, in sRGB numbers.
    colour: [f64; 3],
}

impl State {
    pub(super) fn record(&self) -> Value {
        let Self { name, season, maturity, seed, colour: [red, green, blue] } = self;
        json!({
            "state": name,
            "season": season,
            "maturity": maturity,
            "seed": seed,
            "red": red,
            "green": green,
            "blue": blue,
            "hue_deg": hue_deg(self.colour),
        })
    }
}

/// States as CSV.
pub(super) fn table(states: &[State]) -> String {
    let mut text = "state,season,maturity,seed,red,green,blue,hue_deg\n".to_owned();
    for state in states {
        let State { name, season, maturity, seed, colour: [r, g, b] } = state;
        let hue = hue_deg(state.colour);
        text += &format!("{name},{season},{maturity},{seed},{r:.1},{g:.1},{b:.1},{hue:.1}\n");
    }
    text
}

/// The leaf as one sees it against the light: the last picture of its preview.
fn against_the_light(set: &TextureSet) -> Grid<[u8; 4]> {
    let preview = &set.front.preview;
    let side = preview.height();
    Grid::computed(side, side, |x, y| {
        let [r, g, b] = preview[(preview.width() - side + x, y)];
        [r, g, b, u8::MAX]
    })
}

/// The mean colour of what is fully covered, in sRGB numbers.
fn mean(picture: &Grid<[u8; 4]>) -> [f64; 3] {
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for texel in picture.values().iter().filter(|texel| texel[3] == 255) {
        sum = std::array::from_fn(|c| sum[c] + f64::from(texel[c]));
        count += 1.0;
    }
    sum.map(|v| v / f64::max(count, 1.0))
}

fn hue_deg([r, g, b]: [f64; 3]) -> f64 {
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    let spread = most - least;
    if spread == 0.0 {
        return 0.0;
    }
    let sixths = if most == r {
        ((g - b) / spread).rem_euclid(6.0)
    } else if most == g {
        (b - r) / spread + 2.0
    } else {
        (r - g) / spread + 4.0
    };
    60.0 * sixths
}
