//! Who hears a command: its terminal, or a program that asked.
//!
//! A program that asks sets its listener for the thread that runs the command; pools that a command starts take it along.
//! Without a listener everything goes to the terminal.

use std::cell::RefCell;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// What a command says, how far it is, and whether it should stop.
#[derive(Debug, Default)]
pub struct Listener {
    data: Mutex<String>,
    talk: Mutex<Vec<String>>,
    cancel: AtomicBool,
    counted: AtomicUsize,
}

impl Listener {
    /// Set it to stop the work at its next block, where it can be stopped.
    pub fn cancel(&self) -> &AtomicBool {
        &self.cancel
    }

    /// Points (places, circles) finished by now.
    pub fn counted(&self) -> &AtomicUsize {
        &self.counted
    }

    /// Counts so many more.
    pub(crate) fn count(&self, points: usize) {
        self.counted.fetch_add(points, Ordering::Relaxed);
    }

    /// What stdout would have got, and what stderr, line by line.
    pub(crate) fn heard(&self) -> (String, Vec<String>) {
        let data = self.data.lock().unwrap_or_else(PoisonError::into_inner);
        let talk = self.talk.lock().unwrap_or_else(PoisonError::into_inner);
        (data.clone(), talk.clone())
    }

    /// Hears data, and the line end behind it.
    pub(crate) fn hear_data(&self, text: &str) {
        let mut data = self.data.lock().unwrap_or_else(PoisonError::into_inner);
        data.push_str(text);
        data.push('\n');
    }

    /// Hears talk.
    pub(crate) fn hear_talk(&self, text: &str) {
        let mut talk = self.talk.lock().unwrap_or_else(PoisonError::into_inner);
        talk.push(text.to_owned());
    }
}

thread_local! {
    static HEARS: RefCell<Option<Arc<Listener>>> = const { RefCell::new(None) };
}

/// Who hears on this thread; nobody but the terminal where there is none.
pub(crate) fn current() -> Option<Arc<Listener>> {
    HEARS.with_borrow(Clone::clone)
}

/// Does `work` with this listener on this thread. Whoever heard before hears again afterwards, also where `work` panics.
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
    use crate::terminal::{print, say};

    #[test]
    fn a_listener_hears_what_is_printed_and_said_on_its_thread_alone() {
        let (outer, inner) = (Arc::new(Listener::default()), Arc::new(Listener::default()));
        heard_by(Some(Arc::clone(&outer)), || {
            print("1").unwrap();
            heard_by(Some(Arc::clone(&inner)), || print("2").unwrap());
            say("3");
            std::thread::scope(|scope| {
                scope.spawn(|| assert!(current().is_none()));
            });
        });
        assert!(current().is_none());
        assert_eq!(outer.heard(), ("1\n".to_owned(), vec!["3".to_owned()]));
        assert_eq!(inner.heard(), ("2\n".to_owned(), Vec::new()));
    }

    #[test]
    fn whoever_heard_before_hears_again_after_a_panic() {
        let listener = Some(Arc::new(Listener::default()));
        let broken = std::panic::catch_unwind(|| heard_by(listener, || panic!("on purpose")));
        assert!(broken.is_err() && current().is_none());
    }
}
