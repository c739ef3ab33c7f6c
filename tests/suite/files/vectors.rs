//! SVG for plotters and lasers, and DXF, by readers of our own: what is closed, what stands twice, how
//! wide things are.

use std::collections::{BTreeMap, HashSet};

use glam::DVec2;
use venation::geometry::polygon;
use venation::io::{FormatKind, LeafFiles, encode_leaf};
use venation::observer::Silent;
use venation::seed::Seed;
use venation::spec::{Output, SvgStyle};
use venation::{pipeline, presets};

use super::{SmallLeaf, text_of};

fn drawn(leaf: &SmallLeaf, svg_style: SvgStyle, least_width_mm: f64) -> Vec<(String, Vec<u8>)> {
    let formats = vec![FormatKind::Svg, FormatKind::Dxf];
    let output =
        Output { maps: Vec::new(), formats, svg_style, least_width_mm, ..Output::standard() };
    encode_leaf(&LeafFiles { output: &output, ..leaf.files() })
}

/// The points of every polyline.
fn polylines(svg: &str) -> Vec<Vec<&str>> {
    let of = |line: &&str| line.starts_with("<polyline");
    let points =
        |line: &str| line.split("points=\"").nth(1).unwrap().trim_end_matches("\"/>").len();
    svg.lines()
        .filter(of)
        .map(|line| {
            let start = line.find("points=\"").unwrap() + 8;
            line[start..start + points(line)].split(' ').collect()
        })
        .collect()
}

#[test]
fn a_pen_draws_each_vein_in_one_go_and_a_laser_tells_cut_from_score() {
    let leaf = SmallLeaf::new("oak");
    let pen = drawn(&leaf, SvgStyle::Plotter, 0.0);
    let svg = text_of(&pen, "oak.svg");
    // The midrib, two side veins and their ends, and the join.
    assert_eq!(polylines(svg).len(), 1 + 2 + 2 + 1);
    assert!(!svg.contains("<polyline stroke-width"));
    let mut segments = HashSet::new();
    for line in polylines(svg) {
        for pair in line.windows(2) {
            assert!(
                segments.insert((pair[0].min(pair[1]), pair[0].max(pair[1]))),
                "{pair:?} twice"
            );
        }
    }
    let graph = leaf.venation.graph();
    assert_eq!(segments.len(), graph.edges().count() + graph.joins().len());

    let cut = drawn(&leaf, SvgStyle::Laser, 0.0);
    let svg = text_of(&cut, "oak.svg");
    let layers: Vec<&str> = svg.lines().filter(|line| line.starts_with("<g ")).collect();
    for (i, layer) in layers.iter().enumerate() {
        let colour = if i == 0 { "#ff0000" } else { "#0000ff" };
        assert!(layer.contains(&format!("stroke=\"{colour}\" stroke-width=\"0.01\"")), "{layer}");
    }
    let closed = svg.lines().find(|line| line.starts_with("<path")).unwrap();
    assert!(closed.ends_with(" Z\"/>"));
    usvg::Tree::from_str(svg, &usvg::Options::default()).unwrap();
}

#[test]
fn veins_too_narrow_are_left_out_and_the_rest_hangs_together() {
    let leaf = SmallLeaf::new("oak");
    // Side veins are 0.4 mm wide, their ends 0.1.
    for (least, lines) in [(0.0, 6), (0.2, 3), (0.5, 1), (9.0, 0)] {
        let files = drawn(&leaf, SvgStyle::Plotter, least);
        assert_eq!(polylines(text_of(&files, "oak.svg")).len(), lines, "{least}");
        let print = drawn(&leaf, SvgStyle::Print, least);
        for line in text_of(&print, "oak.svg").lines().filter(|l| l.starts_with("<polyline")) {
            let width: f64 = line.split('"').nth(1).unwrap().parse().unwrap();
            assert!(width >= least, "{line}");
        }
        let dxf = text_of(&files, "oak.dxf").matches("LWPOLYLINE").count();
        // The outline and the slit stay.
        assert_eq!(dxf, lines + 2);
    }
}

/// Layer, whether closed, and points as they are printed.
type Line<'a> = (&'a str, bool, Vec<(String, String)>);

/// Group codes and values.
fn groups(dxf: &str) -> Vec<(u32, &str)> {
    let lines: Vec<&str> = dxf.lines().collect();
    assert_eq!(lines.len() % 2, 0);
    lines.chunks(2).map(|pair| (pair[0].trim().parse().unwrap(), pair[1])).collect()
}

#[test]
fn the_dxf_is_in_millimetres_closed_and_draws_nothing_twice() {
    let leaf = SmallLeaf::new("oak");
    let files = drawn(&leaf, SvgStyle::Print, 0.0);
    let groups = groups(text_of(&files, "oak.dxf"));
    let after = |name: &str| {
        let at = groups.iter().position(|group| *group == (9, name)).unwrap();
        groups[at + 1]
    };
    assert_eq!(after("$INSUNITS"), (70, "4"));
    assert_eq!(after("$ACADVER"), (1, "AC1015"));
    assert_eq!(groups.last(), Some(&(0, "EOF")));

    // Handles are there once each, below the one said to be free, and owners exist.
    let seed = u32::from_str_radix(after("$HANDSEED").1, 16).unwrap();
    let header = groups.iter().position(|group| *group == (0, "ENDSEC")).unwrap();
    let mut handles = HashSet::from([0]);
    for (_, value) in groups[header..].iter().filter(|(code, _)| *code == 5) {
        let handle = u32::from_str_radix(value, 16).unwrap();
        assert!(handle < seed && handles.insert(handle), "{value}");
    }
    for (code, value) in &groups {
        if [330, 350].contains(code) {
            assert!(handles.contains(&u32::from_str_radix(value, 16).unwrap()), "{value}");
        }
    }

    // Every line on a layer that is there.
    let entities = groups.iter().position(|group| *group == (2, "ENTITIES")).unwrap();
    let layers: HashSet<&str> = groups
        .windows(2)
        .filter(|pair| pair[0] == (100, "AcDbLayerTableRecord"))
        .map(|pair| pair[1].1)
        .collect();
    let mut lines: Vec<Line<'_>> = Vec::new();
    let mut layer = "";
    for window in groups[entities..].windows(2) {
        match window {
            [(0, "ENDSEC"), _] => break,
            [(8, name), _] => layer = name,
            [(70, closed), (43, _)] => lines.push((layer, *closed == "1", Vec::new())),
            [(10, x), (20, y)] => {
                lines.last_mut().unwrap().2.push(((*x).to_owned(), (*y).to_owned()));
            }
            _ => {}
        }
    }
    let mut by_layer: BTreeMap<&str, usize> = BTreeMap::new();
    let mut segments = HashSet::new();
    for (layer, closed, points) in &lines {
        assert!(layers.contains(layer), "{layer}");
        *by_layer.entry(layer).or_default() += 1;
        let mut points = points.clone();
        if *closed {
            assert_ne!(points.first(), points.last());
            points.push(points[0].clone());
        }
        for pair in points.windows(2) {
            let (a, b) =
                (pair[0].clone().min(pair[1].clone()), pair[0].clone().max(pair[1].clone()));
            assert!(segments.insert((a, b)), "{pair:?} twice");
        }
    }
    assert!(lines[0].1, "the outline is closed");
    assert_eq!(lines[0].2.len(), leaf.margin.outline().len());
    assert!(lines[0].2.contains(&("0".into(), "55".into())), "the apex, 55 mm up");
    assert_eq!(by_layer["CUT"], 2);
    assert_eq!((by_layer["VEINS_PRIMARY"], by_layer["VEINS_SECONDARY"]), (1, 2));
}

/// The closed lines of a drawing (mm on the page).
fn rings(svg: &str) -> Vec<Vec<DVec2>> {
    let closed = |line: &str| {
        let points = line.strip_prefix("<path d=\"M ")?.strip_suffix(" Z\"/>")?;
        let point = |text: &str| {
            let (x, y) = text.split_once(',').expect("two numbers");
            DVec2::new(x.parse().expect("a number"), y.parse().expect("a number"))
        };
        Some(points.split(' ').map(point).collect())
    };
    svg.lines().filter_map(closed).collect()
}

#[test]
fn one_closed_line_goes_around_blade_and_petiole() {
    // Lobes beside the petiole; holes; no lobes; a petiole that a shield hides.
    for (preset, holes) in [("oak", 0.0), ("oak", 0.1), ("beech", 0.0), ("lotus", 0.0)] {
        let document = presets::find(preset).expect("a preset").document().expect("valid");
        let mut spec = document.resolve(Seed(1)).expect("valid");
        (spec.texture.size_px, spec.damage.holes) = (256, holes);
        spec.veins.spawn_rate /= 20.0;
        (spec.output.maps, spec.output.formats) = ("none".into(), "svg,dxf".into());
        let leaf = pipeline::generate(&spec, Seed(1), &mut Silent).expect("a leaf");
        let [alone, both] = [false, true].map(|petiole| {
            spec.output.petiole = petiole;
            let output = spec.output.resolve().expect("words");
            let files = encode_leaf(&LeafFiles::of(&leaf, "", &output));
            let lines = text_of(&files, &format!("{}.dxf", spec.name)).matches("\nCUT\n").count();
            (rings(text_of(&files, &format!("{}.svg", spec.name))), lines)
        });
        assert_eq!(both.0.len(), alone.0.len(), "{preset}: no pieces and no gaps more");
        assert_eq!(both.1, alone.1, "{preset}: the same in the dxf");
        let area = |rings: &[Vec<DVec2>]| {
            rings.iter().map(|ring| polygon::signed_area(ring)).sum::<f64>().abs()
        };
        let stalk = polygon::signed_area(&leaf.textures.petiole);
        let more = area(&both.0) - area(&alone.0);
        let hidden = leaf.grown.margin.is_peltate();
        let least = if hidden { -1e-6 } else { 0.2 * stalk };
        let most = if hidden { 1e-6 } else { stalk };
        assert!(least < more && more < most, "{preset}: {more} of {stalk} mm² stand out");
        assert!(both.0.iter().all(|ring| polygon::self_crossing(ring).is_none()), "{preset}");
        let frame = &leaf.textures.frame;
        let end = leaf.textures.petiole_end;
        let end = DVec2::new(end.x - frame.min.x, frame.side_mm - (end.y - frame.min.y));
        let near = |ring: &Vec<DVec2>| ring.iter().map(|p| p.distance(end)).fold(1e9, f64::min);
        let near = both.0.iter().map(near).fold(1e9, f64::min);
        assert!(hidden || near < 0.6 * spec.petiole.width_mm, "{preset}: {near} mm from the end");
    }
}
