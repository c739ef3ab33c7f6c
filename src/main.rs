//! x
use clap::Parser;
mod cli {
    pub(crate) mod bench;
}
#[derive(Parser)]
struct A {
    #[command(flatten)]
    b: cli::bench::Args,
}
fn main() {
    if let Err(e) = cli::bench::run(&A::parse().b, &mut std::io::stdout()) {
        eprintln!("{e}");
    }
}
