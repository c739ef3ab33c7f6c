//! Tests of the whole, in one binary.

mod sample_leaf;
/// What painting promises.
mod textures;
