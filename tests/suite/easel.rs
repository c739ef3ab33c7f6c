//! A leaf painted again and again has the bytes of one that is painted once, whatever was painted before it.

use venation::observer::Silent;
use venation::pipeline::{self, Grown, Painter};
use venation::presets;
use venation::raster::Grid;
use venation::seed::Seed;
use venation::spec::LeafSpec;
use venation::texture::pigment::ColourType;
use venation::texture::{Canvas, Style, TextureSet};

/// A leaf of few veins with all maps, 120 texels wide.
fn leaf(preset: &str) -> (LeafSpec, Grown) {
    let document = presets::find(preset).expect(preset).document().expect("it parses");
    let mut spec = document.resolve(Seed(2)).expect("it resolves");
    spec.texture.size_px = 120;
    spec.veins.spawn_rate /= 20.0;
    spec.output.maps = "all".into();
    let grown = pipeline::grow(&spec, Seed(2), &mut Silent).expect("it grows");
    (spec, grown)
}

fn painted(spec: &LeafSpec, grown: &Grown) -> TextureSet {
    pipeline::paint(spec, grown, Seed(2), &mut Silent).expect("it paints")
}

/// A change of settings, by its name.
type Change = (&'static str, fn(&mut LeafSpec));

/// What touches the layout, and what does not.
const CHANGES: [Change; 21] = [
    ("nothing", |_| {}),
    ("autumn", |spec| spec.state.season = 0.5),
    ("sick", |spec| spec.state.health = 0.3),
    ("young", |spec| spec.state.maturity = 0.2),
    ("flat", |spec| (spec.relief.back_height, spec.relief.pleat_mm) = (0.3, 0.0)),
    ("rough", |spec| spec.relief.roughness = 0.9),
    ("red petiole", |spec| spec.petiole.colour.hue_deg = 5.0),
    ("yellow", |spec| spec.colour.pigments.leaf.chlorophyll_ug_cm2 = 4.0),
    ("speckled", |spec| spec.colour.r#type = ColourType::Speckled),
    ("many speckles", |spec| spec.colour.speckle_count = 77),
    ("spread", |spec| spec.colour.spread_mm = 3.0),
    ("from veins", |spec| {
        (spec.colour.r#type, spec.colour.vein_spread) = (ColourType::FromVeins, 4.0);
    }),
    ("no undertone", |spec| spec.colour.undertone = 0.0),
    ("short petiole", |spec| spec.petiole.length_mm *= 0.4),
    ("wide gutter", |spec| spec.texture.gutter = 0.2),
    ("larger", |spec| spec.texture.size_px = 137),
    ("eaten", |spec| (spec.damage.holes, spec.damage.skeletonise) = (0.2, 0.2)),
    ("eaten elsewhere", |spec| (spec.damage.holes, spec.damage.seed) = (0.2, 5)),
    ("eaten in autumn", |spec| (spec.damage.holes, spec.state.season) = (0.2, 0.7)),
    ("enhanced", |spec| spec.texture.style = Style::Enhanced),
    ("few maps", |spec| spec.output.maps = "opacity,thickness,veinorder".into()),
];

#[test]
fn a_leaf_painted_again_is_the_same_as_one_painted_once() {
    let (spec, grown) = leaf("maple");
    let changed = CHANGES.map(|(name, change)| {
        let mut spec = spec.clone();
        change(&mut spec);
        let once = painted(&spec, &grown);
        (name, spec, once)
    });
    let first = &changed[0].2;
    assert!(changed[1..].iter().all(|(_, _, once)| once != first), "every change is seen");
    // Each after the one before it, and after the third before it.
    for step in [1, 3] {
        let mut painter = Painter::new(&grown, Seed(2));
        for i in 0..3 * changed.len() {
            let (name, spec, once) = &changed[i * step % changed.len()];
            let again = painter.paint(spec, &mut Silent).expect("it paints");
            assert!(again == *once, "{name}, as number {i} with steps of {step}");
            if i % 4 != 0 {
                painter.take_back(again);
            }
        }
    }
}

/// Pictures in which nothing is as it should be.
fn scribbled(mut set: TextureSet) -> Canvas {
    fn scribble<T: Copy>(plane: &mut Grid<T>, value: T) {
        plane.values_mut().fill(value);
    }
    for side in [&mut set.front, &mut set.back] {
        scribble(&mut side.base_colour, [201, 7, 99, 255]);
        scribble(&mut side.normal, [1, 2, 3]);
        scribble(&mut side.height, 999);
        scribble(&mut side.roughness, 77);
        scribble(&mut side.occlusion, 78);
        scribble(&mut side.transmission, 79);
        scribble(&mut side.translucency, [80; 3]);
        scribble(&mut side.thickness, 8100);
        scribble(&mut side.vein_mask, 82);
        scribble(&mut side.vein_order, 83);
        scribble(&mut side.bump, 84);
        scribble(&mut side.preview, [85; 3]);
        scribble(&mut side.enhancement, [86; 3]);
        if let Some(deep) = &mut side.deep {
            scribble(&mut deep.base_colour, [1000, 2000, 3000, u16::MAX]);
            scribble(&mut deep.roughness, 1001);
            scribble(&mut deep.occlusion, 1002);
            scribble(&mut deep.transmission, 1003);
            scribble(&mut deep.translucency, [1004; 3]);
            scribble(&mut deep.vein_mask, 1005);
        }
    }
    set.into()
}

#[test]
fn nothing_is_left_of_what_a_leaf_is_painted_over() {
    // The last is so slender that no texel is covered by it alone.
    for (preset, size_px) in [("oak", 120), ("grass", 120), ("grass", 16)] {
        let (mut spec, grown) = leaf(preset);
        spec.texture.size_px = size_px;
        for (bits, holes) in [(8, 0.0), (16, 0.0), (16, 0.3)] {
            (spec.output.bits, spec.damage.holes) = (bits, holes);
            let fresh = painted(&spec, &grown);
            let mut painter = Painter::new(&grown, Seed(2));
            painter.take_back(scribbled(fresh.clone()));
            let over = painter.paint(&spec, &mut Silent).expect("it paints");
            assert!(over == fresh, "{preset} {size_px} px, {bits} bits, {holes} eaten");
        }
        let full = painted(&spec, &grown).front;
        let covered = full.base_colour.values().iter().any(|texel| texel[3] == 255);
        assert_eq!(covered, size_px > 16, "{preset} {size_px}");
    }
}
