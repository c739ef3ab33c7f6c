//! Growth of venation over the number of auxin sources, on the standard blade.

use divan::Bencher;
use venation::benchmark::{Workload, run, standard_workload};
use venation::seed::Seed;
use venation::veins::Algorithm;

fn main() {
    // Alone, as the numbers of the README are.
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("no threads yet");
    divan::main();
}

fn grow(bencher: Bencher, sources: usize, change: impl FnOnce(&mut Workload)) {
    let mut workload = standard_workload(sources, Seed(42));
    change(&mut workload);
    bencher.bench_local(|| run(&workload).expect("the standard workload grows"));
}

#[divan::bench(args = [1_000, 2_000, 4_000, 8_000, 16_000, 32_000, 64_000], sample_count = 5)]
fn open_venation(bencher: Bencher, sources: usize) {
    grow(bencher, sources, |_| ());
}

#[divan::bench(args = [1_000, 4_000, 16_000, 64_000], sample_count = 5)]
fn closed_venation(bencher: Bencher, sources: usize) {
    grow(bencher, sources, |workload| workload.veins.algorithm = Algorithm::AuxinClosed);
}

#[divan::bench(args = [1_000, 4_000, 16_000], sample_count = 5)]
fn unlimited_attraction(bencher: Bencher, sources: usize) {
    grow(bencher, sources, |workload| workload.veins.attraction_distance_mm = 0.0);
}
