//! Long work on the server: it continues when the page is closed or loaded again. One job computes, the others wait.
//!
//! | path | does |
//! |---|---|
//! | `POST /api/jobs` | begins one, and returns its name |
//! | `GET /api/jobs`, `GET /api/jobs/ID` | all, newest first; one with its answer |
//! | `GET /api/jobs/ID/events` | reports its progress, ten times a second at most, until it ends |
//! | `DELETE /api/jobs/ID` | cancels it |
//!
//! At most 16 event streams of a job and 64 in all are open at a time; another one is answered 429.

use std::convert::Infallible;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use armill_study::live::outline;
use axum::Router;
use axum::extract::{Path as InPath, State as Shared};
use axum::http::StatusCode;
use axum::response::sse::{Event, KeepAlive};
use axum::response::{IntoResponse, Response, Sse};
use axum::routing::{get, post};
use futures_util::stream;
use schemars::JsonSchema;
use serde::Serialize;
use tokio::sync::Semaphore;

use crate::body::{JsonBody, check_text, json};
use crate::error::{Answered, ApiError};
use crate::job::{Job, JobAnswer, JobState};
use crate::server::State;
use crate::task::Task;

/// Jobs that are remembered.
const MOST_JOBS: usize = 50;
/// Jobs that wait.
const MOST_WAITING: usize = 20;
/// Answers that are kept in memory; the files of older ones stay.
const MOST_ANSWERS: usize = 10;
/// Event streams open at a time: of one job, and of all jobs together.
const MOST_STREAMS_OF_JOB: usize = 16;
const MOST_STREAMS: usize = 64;
/// Ten times a second.
const EVENT_TIME: Duration = Duration::from_millis(100);

/// A job to run, and the name of its study in messages.
type Next = (Arc<Job>, String);

/// All jobs since the start.
pub(crate) struct Jobs {
    all: Mutex<Vec<Arc<Job>>>,
    /// Room for event streams.
    streams: Arc<Semaphore>,
    /// To the thread that computes; it ends with the last of these.
    next: Mutex<Option<Sender<Next>>>,
    count: std::sync::atomic::AtomicUsize,
    /// That thread.
    computing: JoinHandle<()>,
}

/// All jobs, newest first.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct JobList {
    /// Without their answers.
    pub jobs: Vec<JobAnswer>,
}

/// Name of a new job.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct JobBegun {
    /// The last part of its path below `/api/jobs/`.
    pub id: String,
}

impl Jobs {
    /// None yet; results go into folders of `root`.
    pub(crate) fn start(root: PathBuf) -> Jobs {
        let (next, waiting) = channel();
        Jobs {
            computing: std::thread::spawn(move || compute(&waiting, &root)),
            all: Mutex::default(),
            streams: Arc::new(Semaphore::new(MOST_STREAMS)),
            next: Mutex::new(Some(next)),
            count: std::sync::atomic::AtomicUsize::new(0),
        }
    }

    fn with<T>(&self, look: impl FnOnce(&mut Vec<Arc<Job>>) -> T) -> T {
        look(&mut self.all.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Begins a job, or puts it behind those that wait.
    fn begin(&self, task: Task, title: String, shown: &str) -> Result<String, ApiError> {
        let number = 1 + self.count.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        let job = Arc::new(Job::new(number.to_string(), task, title, MOST_STREAMS_OF_JOB));
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

    fn find(&self, id: &str) -> Result<Arc<Job>, ApiError> {
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
            Ok(pool) => pool.install(|| job.work(&shown, root)),
            Err(_) => job.work(&shown, root),
        }
    }
}

pub(crate) fn routes() -> Router<Arc<State>> {
    Router::new()
        .route("/jobs", post(begin).get(list))
        .route("/jobs/{id}", get(one).delete(cancel))
        .route("/jobs/{id}/events", get(events))
}

async fn begin(Shared(state): Shared<Arc<State>>, JsonBody(task): JsonBody<Task>) -> Answered {
    check_text(task.text())?;
    let (shared, text) = (Arc::clone(&state), task.text().to_owned());
    // A study with problems becomes a job that fails, and reports them.
    let given = state
        .work
        .done(move |_| Ok(outline(shared.cell.text(&text))))
        .await?;
    let id = state
        .jobs
        .begin(task, given.title.unwrap_or_default(), &state.cell.shown)?;
    Ok(json(StatusCode::ACCEPTED, &JobBegun { id }))
}

async fn list(Shared(state): Shared<Arc<State>>) -> Response {
    let jobs = state
        .jobs
        .with(|all| all.iter().rev().map(|job| job.reported(false)).collect());
    json(StatusCode::OK, &JobList { jobs })
}

async fn one(Shared(state): Shared<Arc<State>>, InPath(id): InPath<String>) -> Answered {
    Ok(json(StatusCode::OK, &state.jobs.find(&id)?.reported(true)))
}

async fn cancel(Shared(state): Shared<Arc<State>>, InPath(id): InPath<String>) -> Answered {
    let job = state.jobs.find(&id)?;
    job.stop();
    Ok(json(StatusCode::OK, &job.reported(false)))
}

async fn events(Shared(state): Shared<Arc<State>>, InPath(id): InPath<String>) -> Answered {
    let job = state.jobs.find(&id)?;
    let room = |streams: &Arc<Semaphore>, most: usize, of: &str| {
        let room = Arc::clone(streams).try_acquire_owned();
        room.map_err(|_| {
            ApiError::too_many(format!(
                "{most} event streams of {of} are open already: close some"
            ))
        })
    };
    let of_job = room(&job.streams, MOST_STREAMS_OF_JOB, "this job")?;
    let of_all = room(&state.jobs.streams, MOST_STREAMS, "all jobs")?;
    let mut time = tokio::time::interval(EVENT_TIME);
    time.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
    // What was reported last, without what only time changes.
    let last: Option<(JobState, usize, usize, Option<String>)> = None;
    let given = stream::unfold(
        (job, time, last, false, (of_job, of_all)),
        |(job, mut time, mut last, ended, rooms)| async move {
            if ended {
                return None;
            }
            loop {
                time.tick().await;
                let now = job.reported(false);
                let key = Some((now.state, now.done, now.of, now.best.clone()));
                if key == last {
                    continue;
                }
                last = key;
                let data = serde_json::to_string(&now).unwrap_or_default();
                let event = Event::default().event("job").data(data);
                return Some((
                    Ok::<_, Infallible>(event),
                    (job, time, last, now.state.is_last(), rooms),
                ));
            }
        },
    );
    Ok(Sse::new(given).keep_alive(KeepAlive::default()).into_response())
}
