//! All jobs since the start: one computes, the others wait.

use std::ops::Deref;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use armill_api::{ApiError, Job, JobState, Task, execute};
use tokio::sync::Semaphore;

/// Jobs that are remembered.
const MOST_JOBS: usize = 50;
/// Jobs that wait.
const MOST_WAITING: usize = 20;
/// Answers that are kept in memory; the files of older ones stay.
const MOST_ANSWERS: usize = 10;
/// Event streams open at a time: of one job, and of all jobs together.
pub(crate) const MOST_STREAMS_OF_JOB: usize = 16;
pub(crate) const MOST_STREAMS: usize = 64;

/// A job of the server.
pub(crate) struct QueuedJob {
    job: Job,
    /// Room for event streams.
    pub streams: Arc<Semaphore>,
}

impl Deref for QueuedJob {
    type Target = Job;

    fn deref(&self) -> &Job {
        &self.job
    }
}

/// A job to run, and the name of its study in messages.
type Next = (Arc<QueuedJob>, String);

/// All jobs since the start.
pub(crate) struct Queue {
    all: Mutex<Vec<Arc<QueuedJob>>>,
    /// Room for event streams.
    pub streams: Arc<Semaphore>,
    /// To the thread that computes; it ends with the last of these.
    next: Mutex<Option<Sender<Next>>>,
    count: AtomicUsize,
    /// That thread.
    computing: JoinHandle<()>,
}

impl Queue {
    /// None yet; results go into folders of `root`.
    pub(crate) fn start(root: PathBuf) -> Queue {
        let (next, waiting) = channel();
        Queue {
            computing: std::thread::spawn(move || compute(&waiting, &root)),
            all: Mutex::default(),
            streams: Arc::new(Semaphore::new(MOST_STREAMS)),
            next: Mutex::new(Some(next)),
            count: AtomicUsize::new(0),
        }
    }

    /// Looks at all jobs.
    pub(crate) fn with<T>(&self, look: impl FnOnce(&mut Vec<Arc<QueuedJob>>) -> T) -> T {
        look(&mut self.all.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Begins a job, or puts it behind those that wait.
    pub(crate) fn begin(&self, task: Task, title: String, shown: &str) -> Result<String, ApiError> {
        let number = 1 + self.count.fetch_add(1, Ordering::Relaxed);
        let job = Arc::new(QueuedJob {
            job: Job::new(number.to_string(), task, title),
            streams: Arc::new(Semaphore::new(MOST_STREAMS_OF_JOB)),
        });
        self.with(|all| {
            let waiting = all.iter().filter(|job| job.state() == JobState::Waiting).count();
            if waiting >= MOST_WAITING {
                return Err(ApiError::conflict(format!(
                    "{waiting} jobs are waiting already: cancel some"
                )));
            }
            all.push(Arc::clone(&job));
            let mut ended = all.iter().filter(|job| job.state().is_last()).count();
            all.retain(|job| {
                let forgotten = ended > MOST_JOBS && job.state().is_last();
                ended -= usize::from(forgotten);
                !forgotten
            });
            all.iter()
                .rev()
                .skip(MOST_ANSWERS)
                .for_each(|job| job.forget_answer());
            Ok(())
        })?;
        let next = self.next.lock().unwrap_or_else(PoisonError::into_inner);
        let sent = next
            .as_ref()
            .map(|next| next.send((Arc::clone(&job), shown.to_owned())));
        match sent {
            Some(Ok(())) => Ok(job.id.clone()),
            _ => Err(ApiError::internal("the server is stopping")),
        }
    }

    /// The job of this name.
    pub(crate) fn find(&self, id: &str) -> Result<Arc<QueuedJob>, ApiError> {
        let found = self.with(|all| all.iter().find(|job| job.id == id).cloned());
        found.ok_or_else(|| ApiError::not_found("there is no such job"))
    }

    /// Waits until the job under way has ended, at most for this time.
    pub(crate) fn wait(&self, longest: Duration) {
        let begun = Instant::now();
        while !self.computing.is_finished() && begun.elapsed() < longest {
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Cancels all, and accepts no more.
    pub(crate) fn stop(&self) {
        self.next.lock().unwrap_or_else(PoisonError::into_inner).take();
        self.with(|all| all.iter().for_each(|job| job.stop()));
    }
}

/// Runs jobs one after the other, on separate threads, so that short requests do not wait for them.
fn compute(waiting: &Receiver<Next>, root: &std::path::Path) {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    for (job, shown) in waiting {
        match &pool {
            Ok(pool) => pool.install(|| execute(&job, &shown, root)),
            Err(_) => execute(&job, &shown, root),
        }
    }
}
