//! The only library modules that read or write.

pub mod graph;
pub mod image;
pub mod manifest;
pub mod obj;
pub mod outline;
pub mod svg;
pub mod write;
