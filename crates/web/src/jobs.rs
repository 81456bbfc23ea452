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
use std::sync::Arc;
use std::time::Duration;

use armill_api::{ApiError, JobAnswer, JobState, Task};
use axum::extract::{Path as InPath, State as Shared};
use axum::http::StatusCode;
use axum::response::sse::{Event, KeepAlive};
use axum::response::{IntoResponse, Sse};
use futures_util::stream;
use schemars::JsonSchema;
use serde::Serialize;
use tokio::sync::Semaphore;

use crate::body::JsonBody;
use crate::error::Answered;
use crate::queue::{MOST_STREAMS, MOST_STREAMS_OF_JOB};
use crate::reply::json;
use crate::state::State;

/// Ten times a second.
const EVENT_TIME: Duration = Duration::from_millis(100);

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

pub(crate) async fn begin(Shared(state): Shared<Arc<State>>, JsonBody(task): JsonBody<Task>) -> Answered {
    let (context, text) = (Arc::clone(&state.context), task.text().to_owned());
    // A study with problems becomes a job that fails, and reports them.
    let title = state
        .work
        .done(move |_| Ok(armill_api::title(&context, &text)))
        .await??;
    let id = state.jobs.begin(task, title, &state.context.cell.shown)?;
    Ok(json(StatusCode::ACCEPTED, &JobBegun { id })?)
}

pub(crate) async fn list(Shared(state): Shared<Arc<State>>) -> Answered {
    let jobs = state
        .jobs
        .with(|all| all.iter().rev().map(|job| job.reported(false)).collect());
    Ok(json(StatusCode::OK, &JobList { jobs })?)
}

pub(crate) async fn one(Shared(state): Shared<Arc<State>>, InPath(id): InPath<String>) -> Answered {
    Ok(json(StatusCode::OK, &state.jobs.find(&id)?.reported(true))?)
}

pub(crate) async fn cancel(Shared(state): Shared<Arc<State>>, InPath(id): InPath<String>) -> Answered {
    let job = state.jobs.find(&id)?;
    job.stop();
    Ok(json(StatusCode::OK, &job.reported(false))?)
}

pub(crate) async fn events(Shared(state): Shared<Arc<State>>, InPath(id): InPath<String>) -> Answered {
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
