//! Margins per second on one core: with all that a margin guarantees, and the raw curves alone.
//!
//! `cargo bench --bench margin`. One item is one margin; the table says how many points they have.
//! Garg (2011) made 2500 unilobed and 200 to 400 multilobed margins a second.

use venation::margin::lobes::{self, LobeRecord};
use venation::margin::{self, MarginKind, MarginSpec, parametric};
use venation::seed::Seed;

fn main() {
    for name in ["plain", "cordate"] {
        eprintln!("{name}: {} points", points(&unilobed(name)));
    }
    for count in [3, 5, 7] {
        eprintln!("{count} lobes: {} points", points(&lobed(count)));
    }
    divan::main();
}

fn points(spec: &MarginSpec) -> usize {
    margin::build(spec, Seed(1)).expect("a margin").outline().len()
}

fn unilobed(name: &str) -> MarginSpec {
    let mut spec = MarginSpec::default();
    if name == "cordate" {
        spec.right.base_angle_deg = 130.0;
        spec.right.tail_depth = 0.12;
        spec.right.waist_x = 0.4;
        spec.left = spec.right.clone();
    }
    spec
}

fn lobed(count: u64) -> MarginSpec {
    let mut spec = MarginSpec { kind: MarginKind::Lobed, ..MarginSpec::default() };
    spec.lobing.count = count;
    spec
}

fn records(spec: &MarginSpec) -> Vec<LobeRecord> {
    spec.lobing.records().expect("lobes")
}

#[divan::bench(args = ["plain", "cordate"])]
fn unilobed_margin(bencher: divan::Bencher<'_, '_>, name: &str) {
    let spec = unilobed(name);
    bencher.counter(divan::counter::ItemsCount::new(1_u32)).bench(|| margin::build(&spec, Seed(1)));
}

#[divan::bench(args = ["plain", "cordate"])]
fn unilobed_curve(bencher: divan::Bencher<'_, '_>, name: &str) {
    let spec = unilobed(name);
    bencher.counter(divan::counter::ItemsCount::new(1_u32)).bench(|| parametric::outline(&spec));
}

#[divan::bench(args = [3, 5, 7])]
fn lobed_margin(bencher: divan::Bencher<'_, '_>, count: u64) {
    let mut spec = lobed(count);
    spec.lobe = records(&spec);
    bencher.counter(divan::counter::ItemsCount::new(1_u32)).bench(|| margin::build(&spec, Seed(1)));
}

#[divan::bench(args = [3, 5, 7])]
fn lobed_curve(bencher: divan::Bencher<'_, '_>, count: u64) {
    let records = records(&lobed(count));
    bencher.counter(divan::counter::ItemsCount::new(1_u32)).bench(|| lobes::outline(&records));
}
