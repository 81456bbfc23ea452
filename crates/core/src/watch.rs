//! Progress out, cancel in: the one thing that long work takes from outside. The core knows no clock.

use std::sync::atomic::{AtomicBool, Ordering};

/// How long work tells its progress and learns that nobody waits for it any more.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Called now and then, from any thread, with the number of points just finished.
    pub finished: &'a (dyn Fn(usize) + Sync),
    /// Set from outside to stop the work at the next block.
    pub cancel: &'a AtomicBool,
}

static NEVER: AtomicBool = AtomicBool::new(false);

impl Watch<'_> {
    /// Tells nobody and is never cancelled.
    pub const NONE: Watch<'static> = Watch {
        finished: &|_| (),
        cancel: &NEVER,
    };

    /// Whether the work should stop.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }
}

/// The work was stopped from outside; nothing of it is left.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;
