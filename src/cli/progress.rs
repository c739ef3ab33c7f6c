//! Progress drawn on stderr, only when a person is watching.

use std::io::IsTerminal;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use venation::observer::{Observer, Progress};

/// A bar on stderr; draws nothing when stderr is no terminal.
pub(crate) struct Bar {
    bar: ProgressBar,
    prefix: String,
    stage: &'static str,
}

impl Bar {
    /// A bar for one leaf, `prefix` before it (empty for none).
    pub(crate) fn new(quiet: bool, prefix: &str) -> Self {
        let bar = if quiet || !std::io::stderr().is_terminal() {
            ProgressBar::hidden()
        } else {
            let bar = ProgressBar::new(0);
            let template = "{prefix}{msg:10} {wide_bar} {percent:>3} %";
            bar.set_style(ProgressStyle::with_template(template).expect("the template is fixed"));
            // Quick leaves are done before a bar would help.
            bar.enable_steady_tick(Duration::from_millis(200));
            bar
        };
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
