//! Progress and cancellation of long computations. The core has no clock.

use std::sync::atomic::{AtomicBool, Ordering};

/// Reports progress of a long computation, and cancels it.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Called now and then, from any thread, with the number of points just finished.
    pub finished: &'a (dyn Fn(usize) + Sync),
    /// Set from outside to stop the work at the next block.
    pub cancel: &'a AtomicBool,
}

static NEVER: AtomicBool = AtomicBool::new(false);

impl Watch<'_> {
    /// Without progress reports, never cancelled.
    pub const NONE: Watch<'static> = Watch {
        finished: &|_| (),
        cancel: &NEVER,
    };

    /// Whether the work should stop.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }
}

/// The computation was cancelled; there is no result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicUsize;

    #[test]
    fn without_a_watch_nothing_is_reported_or_cancelled() {
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
