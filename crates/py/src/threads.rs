//! Runs work on the requested number of threads, without the lock of Python; Ctrl-C stops it.
//!
//! Thread pools are kept, one for each number of threads, and belong to the process that made them: a forked process has
//! no threads of its parent and makes its own. The calling thread waits, checks signals and reports progress.

use std::any::Any;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::Duration;

use armill_core::watch::Watch;
use pyo3::exceptions::{PyKeyboardInterrupt, PyOverflowError};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::errors::{Cancelled, Fault, refused, wrong_type};

/// Up to this number of quick points take less time than waking a thread.
const FEW: usize = 64;
/// Largest number of threads: more than any machine has processors.
const MOST_THREADS: usize = 1024;
/// Interval at which signals are checked and progress is reported.
const BEAT: Duration = Duration::from_millis(30);

/// A number of threads, from 1 to [`MOST_THREADS`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct ThreadCount(usize);

impl<'a, 'py> FromPyObject<'a, 'py> for ThreadCount {
    type Error = PyErr;

    fn extract(value: Borrowed<'a, 'py, PyAny>) -> PyResult<ThreadCount> {
        let py = value.py();
        let count = match value.extract::<i64>() {
            Ok(count) => usize::try_from(count).unwrap_or(0),
            // An integer beyond 64 bits.
            Err(error) if error.is_instance_of::<PyOverflowError>(py) => 0,
            Err(_) => {
                let kind = value.get_type().name()?;
                return Err(wrong_type(format!("expected an integer, given {kind}")));
            }
        };
        if !(1..=MOST_THREADS).contains(&count) {
            let message = format!(
                "threads: {} is not a number from 1 to {MOST_THREADS}",
                value.str()?
            );
            return Err(refused(py, message, "leave it out to use all processors"));
        }
        Ok(ThreadCount(count))
    }
}

impl ThreadCount {
    /// One thread.
    pub(crate) const ONE: ThreadCount = ThreadCount(1);
}

/// Amount of work.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Effort {
    /// A number of quick points.
    Points(usize),
    /// Work that may take long.
    Long,
}

/// Called at intervals with the number of points finished.
pub(crate) type Progress<'p> = Option<&'p dyn Fn(usize) -> PyResult<()>>;

/// Runs `job` on a number of threads (`None`: all processors) and returns its result.
///
/// # Errors
/// An interrupt; a panic, which is a fault of armill.
pub(crate) fn work<T: Send>(
    py: Python<'_>,
    threads: Option<ThreadCount>,
    effort: Effort,
    job: impl FnOnce(Watch<'_>) -> T + Send,
) -> PyResult<T> {
    if matches!(effort, Effort::Points(count) if count <= FEW) {
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
    watched(py, threads, beats, None, || job(watch))
}

/// Communication between long work and the thread that waits for it.
#[derive(Clone, Copy)]
pub(crate) struct Beats<'b> {
    /// Set to stop the work.
    pub cancel: &'b AtomicBool,
    /// Number of points finished.
    pub counted: &'b AtomicUsize,
}

/// [`work`] that may take long and reports its progress.
///
/// # Errors
/// As [`work`]; what `progress` raises.
pub(crate) fn watched<T: Send>(
    py: Python<'_>,
    threads: Option<ThreadCount>,
    beats: Beats<'_>,
    progress: Progress<'_>,
    job: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    let pool = py.detach(|| pool(threads)).map_err(|why| {
        refused(
            py,
            format!(
                "cannot start {} threads: {why}",
                threads.map_or(0, |count| count.0)
            ),
            "use fewer threads",
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
            let report = || progress.map_or(Ok(()), |report| report(beats.counted.load(Ordering::Relaxed)));
            if stopped.is_none()
                && let Err(why) = py.check_signals().and_then(|()| report())
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
        None => Err(Fault::new_err("the work ended without a result")),
    }
}

/// A `KeyboardInterrupt` becomes `Cancelled`; what a signal handler of the user raises is kept.
fn as_cancelled(py: Python<'_>, why: PyErr) -> PyErr {
    if !why.get_type(py).is(py.get_type::<PyKeyboardInterrupt>()) {
        return why;
    }
    Cancelled::new_err("cancelled: no result was written")
}

/// A panic as a value, so that the waiting thread receives it.
fn caught<T>(job: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(job)).map_err(|why| words(&*why))
}

fn words(why: &(dyn Any + Send)) -> String {
    let text = why.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| why.downcast_ref::<&str>().copied());
    text.unwrap_or("no message").to_owned()
}

fn fault(why: String) -> PyErr {
    Fault::new_err(format!("a fault of armill, please report it: {why}"))
}

/// A pool for each process and number of threads.
static POOLS: Mutex<BTreeMap<(u32, usize), Arc<ThreadPool>>> = Mutex::new(BTreeMap::new());

/// The pool of this process with a number of threads (`None`: all processors).
fn pool(threads: Option<ThreadCount>) -> Result<Arc<ThreadPool>, String> {
    // To rayon zero means as many as there are processors.
    let key = (std::process::id(), threads.map_or(0, |count| count.0));
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(pool) = pools.get(&key) {
        return Ok(Arc::clone(pool));
    }
    let made = ThreadPoolBuilder::new().num_threads(key.1).build();
    let made = Arc::new(made.map_err(|error| error.to_string())?);
    pools.insert(key, Arc::clone(&made));
    Ok(made)
}
