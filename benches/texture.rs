//! Painting both sides of a leaf, and packing the same maps, by the side of the texture.
//!
//! `cargo bench --bench texture`; set RAYON_NUM_THREADS=1 for the cost on one core.

#[path = "../tests/suite/sample_leaf.rs"]
#[expect(dead_code, reason = "shared with the tests, which also want a leaf without veins")]
mod sample_leaf;

use venation::io::image::{Caption, map_png};
use venation::margin::Margin;
use venation::observer::Silent;
use venation::seed::Seed;
use venation::texture::damage::DamageSpec;
use venation::texture::map::{MapKind, MapSet};
use venation::texture::petiole::PetioleSpec;
use venation::texture::pigment::{ColourSpec, StateSpec};
use venation::texture::relief::ReliefSpec;
use venation::texture::{Paint, TextureSet, TextureSpec, paint};
use venation::veins::Venation;

fn main() {
    divan::main();
}

/// The maps whose painting and packing are compared.
const MAPS: [MapKind; 4] = [MapKind::BaseColour, MapKind::Height, MapKind::Normal, MapKind::Orm];

fn painted(size_px: u64) -> TextureSet {
    let margin = sample_leaf::ovate(80.0);
    paint_on(&margin, &sample_leaf::veins(&margin), size_px)
}

fn paint_on(margin: &Margin, veins: &Venation, size_px: u64) -> TextureSet {
    let settings = Paint {
        texture: &TextureSpec { size_px, ..TextureSpec::default() },
        petiole: &PetioleSpec::default(),
        colour: &ColourSpec::default(),
        state: &StateSpec::default(),
        damage: &DamageSpec::default(),
        relief: &ReliefSpec::default(),
        maps: MapSet::of(&MAPS),
        default_speckles: 6,
    };
    paint(&settings, margin, veins, Seed(3), &mut Silent).expect("a leaf can be painted")
}

#[divan::bench(args = [256, 512, 1024, 2048, 4096], max_time = 5)]
fn paint_both_sides(bencher: divan::Bencher<'_, '_>, size_px: u64) {
    let margin = sample_leaf::ovate(80.0);
    let veins = sample_leaf::veins(&margin);
    bencher.bench(|| paint_on(&margin, &veins, size_px));
}

#[divan::bench(args = [256, 512, 1024, 2048, 4096], max_time = 5)]
fn encode_both_sides(bencher: divan::Bencher<'_, '_>, size_px: u64) {
    let set = painted(size_px);
    bencher.bench(|| {
        let sides = [&set.front, &set.back].into_iter();
        sides
            .flat_map(|side| MAPS.map(|map| map_png(map, side, &Caption::default()).len()))
            .sum::<usize>()
    });
}
