//! Leaves that are grown, not painted. (front page to be written)

#![warn(clippy::print_stdout, clippy::print_stderr)]

pub mod observer;
pub mod parameter;
pub mod seed;
pub mod units;

pub mod geometry;
pub mod raster;

pub mod growth;
pub mod margin;
pub mod texture;
pub mod veins;

pub mod spec;

pub mod document;
pub mod error;

pub mod benchmark;
pub mod pipeline;
pub mod presets;

pub mod io;
