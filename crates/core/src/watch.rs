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

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicUsize;

    #[test]
    fn nobody_is_told_and_nothing_is_cancelled_without_a_watch() {
        (Watch::NONE.finished)(1000);
        assert!(!Watch::NONE.is_cancelled());
    }

    #[test]
    fn a_watch_counts_points_of_all_threads_and_is_cancelled_from_outside() {
        let (count, cancel) = (AtomicUsize::new(0), AtomicBool::new(false));
        let finished = |points: usize| {
            count.fetch_add(points, Ordering::Relaxed);
        };
        let watch = Watch {
            finished: &finished,
            cancel: &cancel,
        };
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| (watch.finished)(7));
            }
        });
        assert_eq!(count.load(Ordering::Relaxed), 28);
        assert!(!watch.is_cancelled());
        cancel.store(true, Ordering::Relaxed);
        assert!(watch.is_cancelled());
        assert_eq!(Cancelled.to_string(), "cancelled");
    }
}
