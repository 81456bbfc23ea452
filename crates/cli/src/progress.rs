//! A progress bar on stderr, where there is a terminal to show it; it goes when the work ends, however it ends.
//!
//! At a terminal nothing here cancels. An interrupt (Ctrl-C) ends the process by its signal, which a shell tells as 130: files
//! are whole or not there, and `result.json` comes last, so that nothing needs to be cleared away. A program that asks hears
//! the count, and may cancel.
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

/// Points finished, on a bar. Dropping it takes the bar off the terminal.
pub(crate) struct Progress {
    bar: ProgressBar,
    /// Never set: the core asks for a flag, and at a terminal nothing stops work half-way.
    never: AtomicBool,
    listener: Option<Arc<Listener>>,
}

impl Progress {
    /// A bar for this many points; drawn only on a terminal, at most ten times a second.
    pub(crate) fn new(points: usize) -> Progress {
        Progress::of("points", points)
    }

    /// The same of things with another name.
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

    /// Runs `work` under this bar, which its threads move on together, and gives what it gives.
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

    /// Shows what is being done besides counting, such as the file that is being written.
    pub(crate) fn tell(&self, what: &str) {
        self.bar.set_message(visible(what).into_owned());
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
