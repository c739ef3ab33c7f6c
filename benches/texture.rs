//! Painting both sides of a leaf, and packing the same maps, by the side of the texture.
//!
//! `cargo bench --bench texture`; set RAYON_NUM_THREADS=1 for the cost on one core. Before the benches
//! it prints the CPU time of painting over that of packing, the least of some runs in turn: of a first leaf, in memory
//! that the system hands out meanwhile; of a leaf painted over one that has been written, as in a batch; and of a
//! leaf painted again under another season, as in a film.

use std::time::Duration;

use cpu_time::ProcessTime;
use venation::io::image::{Caption, map_png};
use venation::observer::Silent;
use venation::pipeline::{self, Grown, Painter};
use venation::presets;
use venation::seed::Seed;
use venation::spec::LeafSpec;
use venation::texture::map::MapKind;
use venation::texture::{SideMaps, TextureSet};

fn main() {
    if std::env::args().any(|arg| arg == "--bench") {
        for name in ["beech", "lotus"] {
            let leaf = Leaf::grown(name);
            for size_px in [2048, 4096] {
                leaf.compare(name, size_px);
            }
        }
    }
    divan::main();
}

/// The maps whose painting and packing are compared.
const MAPS: [MapKind; 4] = [MapKind::BaseColour, MapKind::Height, MapKind::Normal, MapKind::Orm];

struct Leaf {
    spec: LeafSpec,
    grown: Grown,
}

impl Leaf {
    fn grown(preset: &str) -> Self {
        let preset = presets::find(preset).expect("a preset");
        let document = preset.document().expect("presets are valid");
        let mut spec = document.resolve(Seed(1)).expect("presets are valid");
        spec.output.maps = MAPS.map(MapKind::word).join(",");
        let grown = pipeline::grow(&spec, Seed(1), &mut Silent).expect("presets grow");
        Self { spec, grown }
    }

    fn paint(&self, size_px: u64) -> TextureSet {
        let mut spec = self.spec.clone();
        spec.texture.size_px = size_px;
        pipeline::paint(&spec, &self.grown, Seed(1), &mut Silent).expect("a leaf can be painted")
    }

    fn compare(&self, name: &str, size_px: u64) {
        let mut spec = self.spec.clone();
        spec.texture.size_px = size_px;
        let (mut painting, mut packing) = ([Duration::MAX; 3], Duration::MAX);
        for run in 0..5_u8 {
            let mut painted = |painter: &mut Painter<'_>, kind: usize| {
                // The second kind is as the first, but in memory that is there.
                spec.state.season = if kind == 2 { f64::from(run + 1) / 10.0 } else { 0.0 };
                let start = ProcessTime::now();
                let set = painter.paint(&spec, &mut Silent).expect("a leaf can be painted");
                painting[kind] = painting[kind].min(start.elapsed());
                set
            };
            let mut painter = Painter::new(&self.grown, Seed(1));
            let set = painted(&mut painter, 0);
            let start = ProcessTime::now();
            pack(&set);
            packing = packing.min(start.elapsed());
            let mut painter = Painter::new(&self.grown, Seed(1));
            painter.take_back(set);
            let set = painted(&mut painter, 1);
            painter.take_back(set);
            painted(&mut painter, 2);
        }
        let [first, next, again] = painting.map(|time| {
            let ratio = time.as_secs_f64() / packing.as_secs_f64();
            format!("{time:.2?} ({ratio:.2})")
        });
        println!(
            "{name} {size_px}: packing {packing:.2?}; painting a first leaf {first}, the next {next}, the same again \
             {again}"
        );
    }
}

fn pack(set: &TextureSet) -> usize {
    let packed = |side: &SideMaps, map: MapKind| {
        let (size, samples) = (side.dimensions(map), side.samples(map));
        map_png(map, map.bits(), size, &samples, &Caption::default()).len()
    };
    let sides = [&set.front, &set.back].into_iter();
    sides.flat_map(|side| MAPS.map(|map| packed(side, map))).sum()
}

#[divan::bench(args = [256, 512, 1024, 2048, 4096], max_time = 5)]
fn paint_both_sides(bencher: divan::Bencher<'_, '_>, size_px: u64) {
    let leaf = Leaf::grown("beech");
    bencher.bench(|| leaf.paint(size_px));
}

#[divan::bench(args = [256, 512, 1024, 2048, 4096], max_time = 5)]
fn pack_both_sides(bencher: divan::Bencher<'_, '_>, size_px: u64) {
    let set = Leaf::grown("beech").paint(size_px);
    bencher.bench(|| pack(&set));
}
