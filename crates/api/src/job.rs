//! One piece of long work: its progress and its result.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Instant, SystemTime, UNIX_EPOCH};

use armill_core::watch::Watch;
use armill_plan::Measure;
use armill_study::{ErrorKind, StudyError};
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::{ApiError, ErrorDetail};
use crate::task::Task;

/// The state of a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum JobState {
    /// Another one is computing.
    Waiting,
    /// It is computing.
    Running,
    /// Its results are available.
    Done,
    /// It ended with an error.
    Failed,
    /// The user stopped it.
    Cancelled,
}

impl JobState {
    /// Whether it is final.
    pub fn is_last(self) -> bool {
        !matches!(self, JobState::Waiting | JobState::Running)
    }
}

/// A job.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct JobAnswer {
    /// Its name.
    pub id: String,
    /// `run`, `posture`, `place`, `advise`, `compensate` or `identify`.
    pub kind: &'static str,
    /// The analysis that it was requested for; `null` if for no particular one.
    pub analysis: Option<String>,
    /// Title of the study.
    pub title: String,
    /// Its state.
    pub state: JobState,
    /// Finished items, of `of`.
    pub done: usize,
    /// Items in total; 0 while that is not known.
    pub of: usize,
    /// The best so far, or the current step.
    pub best: Option<String>,
    /// When it was requested, since 1970: identifies it over restarts of the server.
    pub requested_at_ms: u64,
    /// Time since it was requested.
    pub started_s_ago: f64,
    /// Time of computing.
    pub seconds: f64,
    /// Why it failed.
    pub error: Option<ErrorDetail>,
    /// The text of its study; only where one job is requested.
    pub text: Option<String>,
    /// Its answer, as the command's JSON; only where one job is requested.
    #[schemars(with = "Option<serde_json::Value>")]
    pub answer: Option<Box<serde_json::value::RawValue>>,
    /// What it recommends to change, each by itself; empty where all jobs are requested.
    pub measures: Vec<Measure>,
    /// Files that it wrote, in the folder.
    pub files: Vec<String>,
}

/// What a job has done.
pub(crate) struct Done<F> {
    /// Its answer as JSON.
    pub answer: String,
    /// What it recommends to change.
    pub measures: Vec<Measure>,
    /// The files that it wrote.
    pub files: Vec<F>,
}

/// A job.
pub struct Job {
    /// Its name.
    pub id: String,
    task: Task,
    title: String,
    requested: Instant,
    requested_at_ms: u64,
    cancel: AtomicBool,
    finished: AtomicUsize,
    all: AtomicUsize,
    inner: Mutex<Inner>,
    /// Called after each change of its progress.
    progressed: fn(&Job),
}

/// What changes of a job.
struct Inner {
    state: JobState,
    best: Option<String>,
    begun: Option<Instant>,
    ended: Option<Instant>,
    error: Option<ErrorDetail>,
    answer: Option<Box<serde_json::value::RawValue>>,
    measures: Vec<Measure>,
    files: Vec<String>,
}

impl Job {
    /// One that waits, for a study with this title.
    pub fn new(id: String, task: Task, title: String) -> Job {
        Job {
            id,
            task,
            title,
            requested: Instant::now(),
            requested_at_ms: SystemTime::now()
                .duration_since(UNIX_EPOCH)
                .map_or(0, |since| u64::try_from(since.as_millis()).unwrap_or(0)),
            cancel: AtomicBool::new(false),
            finished: AtomicUsize::new(0),
            all: AtomicUsize::new(0),
            inner: Mutex::new(Inner {
                state: JobState::Waiting,
                best: None,
                begun: None,
                ended: None,
                error: None,
                answer: None,
                measures: Vec::new(),
                files: Vec::new(),
            }),
            progressed: |_| (),
        }
    }

    /// With a function that is called after each change of its progress.
    #[must_use]
    pub fn reporting_to(mut self, progressed: fn(&Job)) -> Job {
        self.progressed = progressed;
        self
    }

    /// Its task.
    pub(crate) fn task(&self) -> &Task {
        &self.task
    }

    fn change<T>(&self, change: impl FnOnce(&mut Inner) -> T) -> T {
        change(&mut self.inner.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Its state.
    pub fn state(&self) -> JobState {
        self.change(|inner| inner.state)
    }

    /// Stops it: at once where it waits, at the next block of points where it computes.
    pub fn stop(&self) {
        self.cancel.store(true, Ordering::Relaxed);
        self.change(|inner| {
            if inner.state == JobState::Waiting {
                inner.state = JobState::Cancelled;
            }
        });
    }

    /// Drops the answer, which its files still contain.
    pub fn forget_answer(&self) {
        self.change(|inner| inner.answer = None);
    }

    /// The job as an answer.
    pub fn reported(&self, with_answer: bool) -> JobAnswer {
        let text = with_answer.then(|| self.task.text().to_owned());
        self.change(|inner| {
            let end = inner.ended.unwrap_or_else(Instant::now);
            JobAnswer {
                id: self.id.clone(),
                kind: self.task.kind(),
                analysis: self.task.analysis().map(str::to_owned),
                title: self.title.clone(),
                state: inner.state,
                done: self.finished.load(Ordering::Relaxed),
                of: self.all.load(Ordering::Relaxed),
                best: inner.best.clone(),
                requested_at_ms: self.requested_at_ms,
                started_s_ago: self.requested.elapsed().as_secs_f64(),
                seconds: inner.begun.map_or(0.0, |begun| (end - begun).as_secs_f64()),
                error: inner.error.clone(),
                text,
                answer: inner.answer.clone().filter(|_| with_answer),
                measures: if with_answer {
                    inner.measures.clone()
                } else {
                    Vec::new()
                },
                files: inner.files.clone(),
            }
        })
    }

    /// Marks it as running; `false` where it was stopped before.
    pub(crate) fn begin(&self) -> bool {
        self.change(|inner| {
            let waits = inner.state == JobState::Waiting;
            if waits {
                (inner.state, inner.begun) = (JobState::Running, Some(Instant::now()));
            }
            waits
        })
    }

    /// Keeps its outcome, with the names of its files in the folder, or why there is none.
    pub(crate) fn end(&self, outcome: Result<Done<String>, StudyError>) {
        self.change(|inner| {
            inner.ended = Some(Instant::now());
            inner.best = inner
                .best
                .take()
                .filter(|_| matches!(self.task, Task::Place { .. }));
            match outcome {
                Ok(done) => {
                    inner.files = done.files;
                    inner.measures = done.measures;
                    inner.answer = serde_json::value::RawValue::from_string(done.answer).ok();
                    inner.state = JobState::Done;
                }
                Err(error) if error.kind() == ErrorKind::Cancelled => inner.state = JobState::Cancelled,
                Err(error) => {
                    inner.error = Some(ApiError::from(error).into_detail());
                    inner.state = JobState::Failed;
                }
            }
        });
    }

    /// Runs `work` under a watch that counts up to `all`.
    pub(crate) fn counted<T>(&self, all: usize, work: impl FnOnce(Watch<'_>) -> T) -> T {
        self.finished.store(0, Ordering::Relaxed);
        self.all.store(all, Ordering::Relaxed);
        work(Watch {
            finished: &|points| {
                self.finished.fetch_add(points, Ordering::Relaxed);
                (self.progressed)(self);
            },
            cancel: &self.cancel,
        })
    }

    /// Reports the best so far, or the current step.
    pub(crate) fn report(&self, what: &str) {
        self.change(|inner| inner.best = Some(what.to_owned()));
        (self.progressed)(self);
    }
}
