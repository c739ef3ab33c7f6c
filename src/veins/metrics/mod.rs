//! Measures of a vein pattern.
//!
//! [`VeinMetrics`] tells growth types apart. [`Measures`] compares a pattern, grown or real, with
//! published and measured leaves: a pattern becomes a [`Network`] of segments between junctions,
//! from a [`VeinGraph`](super::VeinGraph) or from a picture ([`picture::network`]), and everything
//! is taken of that. Definitions follow Blonder's `venation_programs` and Fricker's LeafVeinCNN.
//!
//! ```text
//! VeinGraph, picture ─▶ Network ─┬─▶ areoles ──▶ nesting
//!                                ├─▶ topology, junctions, strahler
//!                                └─▶ lines on a grid ─▶ distances, hull
//! ```

pub mod areoles;
pub mod bins;
pub mod courses;
pub mod distances;
pub mod hierarchy;
pub mod hull;
pub mod junctions;
mod lines;
pub mod measures;
pub mod nesting;
pub mod network;
mod pattern;
pub mod picture;
pub mod rows;
mod statistics;
pub mod strahler;
#[cfg(test)]
mod tests;
pub mod topology;

pub use measures::Measures;
pub use network::{Network, Segment};
pub use pattern::{APEX_REACH, VeinMetrics};
pub use rows::{Architecture, Measure, Row};
