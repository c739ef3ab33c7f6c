//! Painting both sides of a leaf, by the side of the texture.
//!
//! `cargo bench --bench texture`; set RAYON_NUM_THREADS=1 for the cost on one core.

#[path = "../tests/suite/sample_leaf.rs"]
#[expect(dead_code, reason = "shared with the tests, which also want a leaf without veins")]
mod sample_leaf;

use venation::observer::Silent;
use venation::seed::Seed;
use venation::texture::damage::DamageSpec;
use venation::texture::map::{MapKind, MapSet};
use venation::texture::petiole::PetioleSpec;
use venation::texture::pigment::{ColourSpec, StateSpec};
use venation::texture::relief::ReliefSpec;
use venation::texture::{Paint, TextureSpec, paint};

fn main() {
    divan::main();
}

#[divan::bench(args = [256, 512, 1024, 2048, 4096], max_time = 5)]
fn both_sides(bencher: divan::Bencher<'_, '_>, size_px: u64) {
    let margin = sample_leaf::ovate(80.0);
    let veins = sample_leaf::veins(&margin);
    let texture = TextureSpec { size_px, ..TextureSpec::default() };
    let (petiole, colour) = (PetioleSpec::default(), ColourSpec::default());
    let (relief, state) = (ReliefSpec::default(), StateSpec::default());
    let damage = DamageSpec::default();
    bencher.bench(|| {
        let settings = Paint {
            texture: &texture,
            petiole: &petiole,
            colour: &colour,
            relief: &relief,
            state: &state,
            damage: &damage,
            maps: MapSet::of(&[
                MapKind::BaseColour,
                MapKind::Height,
                MapKind::Normal,
                MapKind::Orm,
            ]),
            default_speckles: 6,
        };
        paint(&settings, &margin, &veins, Seed(3), &mut Silent)
    });
}
