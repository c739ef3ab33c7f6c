//! Progress drawn on stderr, only when a person is watching; or told to a render manager.

use std::io::{IsTerminal, Write as _};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use venation::observer::{Observer, Progress};

/// What tells of progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum ProgressWord {
    /// A bar on stderr, where a person is watching.
    Auto,
    /// Nothing.
    None,
    /// Lines on stdout for Open Job Description: openjd_progress: 50.0
    Openjd,
}

/// A bar on stderr; draws nothing when stderr is no terminal.
pub(crate) struct Bar {
    bar: ProgressBar,
    prefix: String,
    stage: &'static str,
}

/// A bar for a person, hidden when nobody is watching.
fn bar(quiet: bool, length: u64, template: &str) -> ProgressBar {
    if quiet || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(length);
    bar.set_style(ProgressStyle::with_template(template).expect("the template is fixed"));
    // Quick leaves are done before a bar would help.
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

impl Bar {
    /// A bar for one leaf, `prefix` before it (empty for none).
    pub(crate) fn new(quiet: bool, prefix: &str) -> Self {
        let bar = bar(quiet, 0, "{prefix}{msg:10} {wide_bar} {percent:>3} %");
        Self { bar, prefix: prefix.to_owned(), stage: "" }
    }
}

impl Observer for Bar {
    fn report(&mut self, progress: Progress) {
        if self.bar.is_hidden() {
            return;
        }
        if progress.stage != self.stage {
            self.stage = progress.stage;
            self.bar.set_prefix(self.prefix.clone());
            self.bar.set_message(progress.stage);
            self.bar.reset();
        }
        self.bar.set_length(progress.steps);
        self.bar.set_position(progress.step);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// Counts the leaves of a batch as they are done, from any thread.
pub(crate) struct Counter {
    bar: ProgressBar,
    openjd: bool,
    all: usize,
    done: AtomicUsize,
}

impl Counter {
    pub(crate) fn new(how: ProgressWord, quiet: bool, all: usize) -> Self {
        // One leaf has a bar of its own.
        let hidden = quiet || how != ProgressWord::Auto || all < 2;
        let bar = bar(hidden, all as u64, "{pos} of {len} leaves {wide_bar} {eta:>4} left");
        Self { bar, openjd: how == ProgressWord::Openjd, all, done: AtomicUsize::new(0) }
    }

    pub(crate) fn one_more(&self) {
        self.bar.inc(1);
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        if self.openjd {
            let percent = 100.0 * done as f64 / self.all.max(1) as f64;
            // One write, so that lines of several threads do not mix; whoever listened may be gone.
            let line = format!("openjd_progress: {percent:.1}\n");
            let mut stdout = std::io::stdout();
            let _ = stdout.write_all(line.as_bytes()).and_then(|()| stdout.flush());
        }
    }
}

impl Drop for Counter {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
