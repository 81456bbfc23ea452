//! Where work runs: on the threads that were asked for, without the lock of Python, and stopped by Ctrl-C.
//!
//! Pools are kept, one for each number of threads, and belong to the process that made them: a child of a fork has no
//! threads of its parent and makes its own. The thread that called waits, hears signals, and tells progress.

use std::any::Any;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::Duration;

use armill_core::watch::Watch;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::errors::{Cancelled, Fault, refused};

/// So many points take less time than waking a thread, where each is quick.
const FEW: usize = 64;
/// More threads than any machine has processors.
const MOST_THREADS: usize = 1024;
/// How often signals are heard and progress is told.
const BEAT: Duration = Duration::from_millis(30);

/// How much there is to do.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Effort {
    /// So many points, none of which takes long.
    Points(usize),
    /// Work that may take long.
    Long,
}

/// Told between two beats: how much is finished by now.
pub(crate) type Progress<'p> = Option<&'p dyn Fn(usize) -> PyResult<()>>;

/// Runs `job` on so many threads (all processors where none are told), and gives what it gives.
///
/// # Errors
/// No such number of threads; interrupted; what `progress` raises; a panic, which is a fault of armill.
pub(crate) fn work<T: Send>(
    py: Python<'_>,
    threads: Option<usize>,
    effort: Effort,
    job: impl FnOnce(Watch<'_>) -> T + Send,
) -> PyResult<T> {
    if matches!(effort, Effort::Points(count) if count <= FEW) {
        check(py, threads)?;
        return py.detach(|| caught(|| job(Watch::NONE))).map_err(fault);
    }
    let (cancel, counted) = (AtomicBool::new(false), AtomicUsize::new(0));
    let finished = |points: usize| {
        counted.fetch_add(points, Ordering::Relaxed);
    };
    let watch = Watch {
        finished: &finished,
        cancel: &cancel,
    };
    let beats = Beats {
        cancel: &cancel,
        counted: &counted,
    };
    watched(py, threads, (beats, None), || job(watch))
}

/// What work that takes long and the thread that waits for it tell each other.
#[derive(Clone, Copy)]
pub(crate) struct Beats<'b> {
    /// Set to stop the work.
    pub cancel: &'b AtomicBool,
    /// How much is finished.
    pub counted: &'b AtomicUsize,
}

/// [`work`] that may take long and tells its progress.
///
/// # Errors
/// As [`work`].
pub(crate) fn watched<T: Send>(
    py: Python<'_>,
    threads: Option<usize>,
    (beats, progress): (Beats<'_>, Progress<'_>),
    job: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    check(py, threads)?;
    let pool = py.detach(|| pool(threads)).map_err(|why| {
        refused(
            py,
            format!("cannot start {} threads: {why}", threads.unwrap_or(0)),
            "try fewer",
        )
    })?;
    let (found, ready) = (Mutex::new(None), Condvar::new());
    let mut stopped: Option<PyErr> = None;
    pool.in_place_scope(|scope| {
        scope.spawn(|_| {
            let outcome = caught(job);
            *found.lock().unwrap_or_else(PoisonError::into_inner) = Some(outcome);
            ready.notify_all();
        });
        let is_ready = || {
            let found = found.lock().unwrap_or_else(PoisonError::into_inner);
            let (found, _) = ready
                .wait_timeout_while(found, BEAT, |found| found.is_none())
                .unwrap_or_else(PoisonError::into_inner);
            found.is_some()
        };
        while !py.detach(is_ready) {
            let given = || progress.map_or(Ok(()), |tell| tell(beats.counted.load(Ordering::Relaxed)));
            if stopped.is_none()
                && let Err(why) = py.check_signals().and_then(|()| given())
            {
                beats.cancel.store(true, Ordering::Relaxed);
                stopped = Some(why);
            }
        }
    });
    if let Some(why) = stopped {
        return Err(as_cancelled(py, why));
    }
    let found = found.into_inner().unwrap_or_else(PoisonError::into_inner);
    match found {
        Some(outcome) => outcome.map_err(fault),
        None => Err(Fault::new_err("the work ended without an answer")),
    }
}

/// What Ctrl-C raises becomes ours; what a handler of the user raises stays.
fn as_cancelled(py: Python<'_>, why: PyErr) -> PyErr {
    if !why.get_type(py).is(py.get_type::<PyKeyboardInterrupt>()) {
        return why;
    }
    Cancelled::new_err("cancelled: nothing of this answer was written")
}

/// Refuses numbers of threads that cannot be.
fn check(py: Python<'_>, threads: Option<usize>) -> PyResult<()> {
    match threads {
        Some(count) if !(1..=MOST_THREADS).contains(&count) => Err(refused(
            py,
            format!("threads: {count} is not a number from 1 to {MOST_THREADS}"),
            "leave it out for all processors",
        )),
        _ => Ok(()),
    }
}

/// A panic becomes a value, so that whoever waits hears of it.
fn caught<T>(job: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(job)).map_err(|why| words(&*why))
}

fn words(why: &(dyn Any + Send)) -> String {
    let text = why.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| why.downcast_ref::<&str>().copied());
    text.unwrap_or("no words").to_owned()
}

fn fault(why: String) -> PyErr {
    Fault::new_err(format!("a fault of armill, please report it: {why}"))
}

/// A pool for each process and number of threads.
static POOLS: Mutex<BTreeMap<(u32, usize), Arc<ThreadPool>>> = Mutex::new(BTreeMap::new());

/// The pool of so many threads of this process; all processors where none are told.
fn pool(threads: Option<usize>) -> Result<Arc<ThreadPool>, String> {
    // To rayon zero means as many as there are processors.
    let key = (std::process::id(), threads.unwrap_or(0));
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(pool) = pools.get(&key) {
        return Ok(Arc::clone(pool));
    }
    let made = ThreadPoolBuilder::new().num_threads(key.1).build();
    let made = Arc::new(made.map_err(|error| error.to_string())?);
    pools.insert(key, Arc::clone(&made));
    Ok(made)
}
