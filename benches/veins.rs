//! Growth of open venation over the number of auxin sources, on the standard blade.

use divan::Bencher;
use venation::benchmark::{run, standard_workload};
use venation::seed::Seed;

fn main() {
    divan::main();
}

#[divan::bench(args = [1_000, 2_000, 4_000, 8_000, 16_000, 32_000, 64_000], sample_count = 5)]
fn open_venation(bencher: Bencher, sources: usize) {
    let workload = standard_workload(sources, Seed(42));
    bencher.bench_local(|| run(&workload).expect("the standard workload grows"));
}
