//! What a long run reports while it works. The library calls, the program draws.

/// How far a stage has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// What is being done, in a word or two: `"veins"`, `"painting"`.
    pub stage: &'static str,
    /// Steps done.
    pub step: u64,
    /// Steps in all; 0 when nobody can know.
    pub steps: u64,
    /// Vein nodes so far (0 outside growth).
    pub nodes: usize,
    /// Living auxin sources (0 outside growth).
    pub sources: usize,
}

/// Hears of progress. Every `FnMut(Progress)` is one; [`Silent`] ignores it.
pub trait Observer {
    /// Called now and then; it must be quick.
    fn report(&mut self, progress: Progress);
}

/// An observer that ignores everything.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Observer for Silent {
    fn report(&mut self, _: Progress) {}
}

impl<F: FnMut(Progress)> Observer for F {
    fn report(&mut self, progress: Progress) {
        self(progress);
    }
}
