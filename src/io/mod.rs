//! The only library modules that read or write.

pub mod graph;
pub mod image;
pub mod manifest;
pub mod obj;
pub mod outline;
pub mod svg;
pub mod write;

/// The program and its version, as every file names its maker.
pub const GENERATOR: &str = concat!("venation ", env!("CARGO_PKG_VERSION"));
