//! The library's tests, in one binary so that it links once.

/// Open venation the slow, obvious way.
mod reference;
/// The vein pattern: the fast path against an obvious one, and what every pattern guarantees.
mod veins;
