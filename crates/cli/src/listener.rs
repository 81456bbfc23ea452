//! Receiver of the output of a command: the terminal, or a calling program.
//!
//! A calling program sets its listener for the thread that runs the command; thread pools of the command inherit it.
//! Without a listener everything goes to the terminal.

use std::cell::RefCell;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Receives the output and the progress of a command, and can cancel it.
#[derive(Debug, Default)]
pub struct Listener {
    data: Mutex<String>,
    talk: Mutex<Vec<String>>,
    cancel: AtomicBool,
    counted: AtomicUsize,
}

impl Listener {
    /// Set it to cancel the work at its next block, where it can be cancelled.
    pub fn cancel(&self) -> &AtomicBool {
        &self.cancel
    }

    /// Number of points (placements, circles) finished so far.
    pub fn counted(&self) -> &AtomicUsize {
        &self.counted
    }

    /// Adds to the number of finished points.
    pub(crate) fn count(&self, points: usize) {
        self.counted.fetch_add(points, Ordering::Relaxed);
    }

    /// The text for stdout, and the lines for stderr.
    pub(crate) fn heard(&self) -> (String, Vec<String>) {
        let data = self.data.lock().unwrap_or_else(PoisonError::into_inner);
        let talk = self.talk.lock().unwrap_or_else(PoisonError::into_inner);
        (data.clone(), talk.clone())
    }

    /// Receives data, and the line end after it.
    pub(crate) fn hear_data(&self, text: &str) {
        let mut data = self.data.lock().unwrap_or_else(PoisonError::into_inner);
        data.push_str(text);
        data.push('\n');
    }

    /// Receives a message.
    pub(crate) fn hear_talk(&self, text: &str) {
        let mut talk = self.talk.lock().unwrap_or_else(PoisonError::into_inner);
        talk.push(text.to_owned());
    }
}

thread_local! {
    static HEARS: RefCell<Option<Arc<Listener>>> = const { RefCell::new(None) };
}

/// The listener of this thread; `None` for the terminal.
pub(crate) fn current() -> Option<Arc<Listener>> {
    HEARS.with_borrow(Clone::clone)
}

/// Runs `work` with this listener on this thread. The previous listener is restored afterwards, also if `work` panics.
pub(crate) fn heard_by<T>(listener: Option<Arc<Listener>>, work: impl FnOnce() -> T) -> T {
    struct Before(Option<Arc<Listener>>);
    impl Drop for Before {
        fn drop(&mut self) {
            HEARS.set(self.0.take());
        }
    }
    let _before = Before(HEARS.replace(listener));
    work()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_previous_listener_is_restored_after_a_panic() {
        let listener = Some(Arc::new(Listener::default()));
        let broken = std::panic::catch_unwind(|| heard_by(listener, || panic!("on purpose")));
        assert!(broken.is_err() && current().is_none());
    }
}
