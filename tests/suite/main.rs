//! The library's tests, in one binary so that it links once.

/// The vein pattern: the fast path against an obvious one, and what every pattern guarantees.
mod veins;
