//! A progress bar on stderr, if it is a terminal; it is removed when the work ends, also by an error.
//!
//! At a terminal nothing here cancels. An interrupt (Ctrl-C) ends the process by its signal, which a shell reports as
//! 130:
//! files are complete or absent, and `result.json` is written last, so that no cleanup is needed. A calling program
//! receives the count, and can cancel.
//!
//! ```text
//! ████████████████░░░░░░░░░░░░░░░░░░░░░░░░ 1026/2565 points, 12s left plate.png
//! ```

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use armill_core::watch::Watch;
use armill_formats::visible::visible;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::listener::{self, Listener};

/// Finished points, shown as a bar. Dropping it removes the bar.
pub(crate) struct Progress {
    bar: ProgressBar,
    /// Never set: the core requires a flag, and at a terminal nothing cancels the work.
    never: AtomicBool,
    listener: Option<Arc<Listener>>,
}

impl Progress {
    /// A bar for this number of points; drawn only on a terminal, at most ten times a second.
    pub(crate) fn new(points: usize) -> Progress {
        Progress::of("points", points)
    }

    /// The same for other items.
    pub(crate) fn of(things: &str, count: usize) -> Progress {
        let listener = listener::current();
        let target = match listener {
            Some(_) => ProgressDrawTarget::hidden(),
            None => ProgressDrawTarget::stderr_with_hz(10),
        };
        let bar = ProgressBar::with_draw_target(Some(count as u64), target);
        let template = format!("{{bar:40}} {{pos}}/{{len}} {things}, {{eta}} left {{msg}}");
        if let Ok(style) = ProgressStyle::with_template(&template) {
            bar.set_style(style);
        }
        Progress {
            bar,
            never: AtomicBool::new(false),
            listener,
        }
    }

    /// Runs `work` under this bar, which its threads advance together, and returns its result.
    pub(crate) fn watch<T>(&self, work: impl FnOnce(Watch<'_>) -> T) -> T {
        let listener = self.listener.as_deref();
        let finished = |points: usize| {
            self.bar.inc(points as u64);
            if let Some(listener) = listener {
                listener.count(points);
            }
        };
        work(Watch {
            finished: &finished,
            cancel: listener.map_or(&self.never, Listener::cancel),
        })
    }

    /// Shows the current step, such as the file that is being written.
    pub(crate) fn set_message(&self, what: &str) {
        self.bar.set_message(visible(what).into_owned());
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
