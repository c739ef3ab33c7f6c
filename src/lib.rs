//! Leaves that are grown, not painted.
//!
//! A margin bounds a simulation of auxin and veins (Runions et al. 2005, in the form of D. Foster's
//! report), Murray's law gives the veins their widths, pigments in HSV colour the blade, and out come
//! the textures of both sides, a card, outlines and the vein graph.
//!
//! # The pipeline
//!
//! ```text
//! presets/*.toml ──┐
//! file, --set      ┴─▶ Document ── draw every range ──▶ LeafSpec
//!                                                         │  margin::build
//!                                                         ▼
//!                                                       Margin
//!                                                         │  GrowingBlade::new
//!                                                         ▼
//!                                                    GrowingBlade
//!                                                         │  veins::grow   widths, orders
//!                                                         ▼
//!                                                 Margin + Venation
//!                                                         │  texture::paint
//!                                                         ▼
//!                                                     TextureSet ──▶ io: files
//! ```
//!
//! Each arrow is a function of its inputs and a [`seed::Seed`]; each type states its guarantees and
//! has a `check()` that names the first one broken. Same spec and seed, same bytes, on any number of
//! threads.
//!
//! # A first call
//!
//! ```
//! use venation::{observer::Silent, pipeline, presets, seed::Seed};
//!
//! let mut document = presets::find("beech").expect("it comes with venation").document()?;
//! document.set("texture.size_px=64", "example")?;
//! document.set("growth.type=none", "example")?;
//! let spec = document.resolve(Seed(7))?;
//! let leaf = pipeline::generate(&spec, Seed(7), &mut Silent)?;
//! assert_eq!(leaf.textures.front.base_colour.width(), 64);
//! assert!(leaf.grown.venation.graph().len() > 100);
//! # Ok::<(), venation::error::Error>(())
//! ```
//!
//! # Each stage alone
//!
//! ```
//! use venation::growth::{GrowingBlade, GrowthSpec};
//! use venation::margin::{self, MarginSpec};
//! use venation::observer::Silent;
//! use venation::seed::Seed;
//! use venation::veins::{self, VeinSpec};
//!
//! let margin = margin::build(&MarginSpec { length_mm: 40.0, ..MarginSpec::default() }, Seed(1))?;
//! let blade = GrowingBlade::new(margin, &GrowthSpec::default())?;
//! let venation = veins::grow(&VeinSpec::default(), &blade, Seed(1), &mut Silent)?;
//! let trunk = venation.radii()[0];
//! assert!(venation.radii().iter().all(|radius| *radius <= trunk));
//! # Ok::<(), venation::error::Error>(())
//! ```
//!
//! # Who may use whom
//!
//! A module uses modules of lower lines only; a test reads the source and says so.
//!
//! ```text
//! main, cli                                  the program: public interface only
//! io                                         bytes and files
//! benchmark                                  the standard workload
//! pipeline  presets                          one leaf, all its stages
//! error                                      the stage errors, gathered
//! document                                   a leaf as a person writes it: ranges, TOML
//! spec                                       the stages' settings put together
//! texture                                    what is seen
//! veins
//! growth
//! margin
//! raster                                     pixels
//! geometry                                   mathematics
//! parameter  point_list  units  seed  observer  parallel
//! ```
//!
//! # Spaces and units
//!
//! Lengths are millimetres in leaf space (base at the origin, apex on +y); see [`units`].

#![warn(clippy::print_stdout, clippy::print_stderr)]

pub mod observer;
pub mod parallel;
pub mod parameter;
pub mod point_list;
pub mod seed;
mod spelling;
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

pub mod pipeline;
pub mod presets;

pub mod benchmark;
pub mod io;

/// The README's library calls, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
