//! Runs computations on their own threads, and cancels them.
//!
//! Handlers wait on few threads; each computation runs on a separate one, and from there on all processors. Work whose
//! client has gone is cancelled. Of the requests of one tab (header `X-Tab`) one is evaluated and one waits; a newer
//! one replaces the waiting one, so that a slider that is moved does not leave a queue.

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use armill_api::ApiError;
use armill_core::watch::Watch;
use armill_formats::input::Inputs;
use armill_study::StudyError;
use axum::http::HeaderMap;
use tokio::sync::{OwnedSemaphorePermit, Semaphore, watch};

/// Requests evaluated at a time, of all tabs together.
const AT_ONCE: usize = 4;
/// Tabs that are remembered; more than a user has.
const MOST_TABS: usize = 64;
/// Letters of the name of a tab.
const MOST_NAME: usize = 64;

/// Computations under way.
pub(crate) struct Work {
    places: Arc<Semaphore>,
    tabs: Mutex<HashMap<String, Arc<Tab>>>,
}

/// The requests of one tab.
struct Tab {
    place: Arc<Semaphore>,
    /// Number of requests so far.
    requested: watch::Sender<u64>,
}

/// A computation that keeps its result itself.
type Job = Box<dyn FnOnce(Watch<'_>) + Send>;

/// Cancels the work when its client is gone.
struct CancelOnDrop(Arc<AtomicBool>);

impl Drop for CancelOnDrop {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

impl Work {
    pub(crate) fn new() -> Work {
        Work {
            places: Arc::new(Semaphore::new(AT_ONCE)),
            tabs: Mutex::default(),
        }
    }

    /// The result of `work`, from a separate thread; cancelled when the client is gone.
    ///
    /// # Errors
    /// Those of `work`; a fault of armill where it panics.
    pub(crate) async fn done<T: Send + 'static>(
        &self,
        work: impl FnOnce(Watch<'_>) -> Result<T, StudyError> + Send + 'static,
    ) -> Result<T, ApiError> {
        let answer = Arc::new(Mutex::new(None));
        let slot = Arc::clone(&answer);
        self.run(Box::new(move |watch| {
            let found = work(watch);
            *slot.lock().unwrap_or_else(PoisonError::into_inner) = Some(found);
        }))
        .await?;
        let found = answer.lock().unwrap_or_else(PoisonError::into_inner).take();
        Ok(found.ok_or_else(ended_early)??)
    }

    /// Runs `job` on a separate thread; cancelled when the client is gone. Compiled once, whatever the result.
    async fn run(&self, job: Job) -> Result<(), ApiError> {
        let place = Arc::clone(&self.places).acquire_owned().await;
        let cancel = Arc::new(AtomicBool::new(false));
        let expected = CancelOnDrop(Arc::clone(&cancel));
        let task = tokio::task::spawn_blocking(move || {
            // Kept until the work has really ended, also when the client is gone.
            let _place = place;
            Inputs::cancelled_by(Arc::clone(&cancel)).during(|| {
                job(Watch {
                    finished: &|_| (),
                    cancel: &cancel,
                });
            });
        });
        let ended = task.await;
        drop(expected);
        ended.map_err(|_| ended_early())
    }

    /// [`Work::done`] as the only work of this kind of its tab, where the request names one.
    ///
    /// # Errors
    /// Those of `done`; replaced by a newer request.
    pub(crate) async fn done_in_tab<T: Send + 'static>(
        &self,
        headers: &HeaderMap,
        kind: &'static str,
        work: impl FnOnce(Watch<'_>) -> Result<T, StudyError> + Send + 'static,
    ) -> Result<T, ApiError> {
        let name = headers.get("x-tab").and_then(|name| name.to_str().ok());
        let Some(name) = name.filter(|name| name.len() <= MOST_NAME) else {
            return self.done(work).await;
        };
        let tab = self.tab(format!("{kind}:{name}"));
        let place = turn(&tab).await?;
        self.done(move |watch| {
            let _place = place;
            work(watch)
        })
        .await
    }

    /// The tab of this name; inactive tabs are removed where there are too many.
    fn tab(&self, name: String) -> Arc<Tab> {
        let mut tabs = self.tabs.lock().unwrap_or_else(PoisonError::into_inner);
        if tabs.len() >= MOST_TABS && !tabs.contains_key(&name) {
            tabs.retain(|_, tab| Arc::strong_count(tab) > 1);
        }
        let new = || {
            Arc::new(Tab {
                place: Arc::new(Semaphore::new(1)),
                requested: watch::channel(0).0,
            })
        };
        Arc::clone(tabs.entry(name).or_insert_with(new))
    }
}

/// The answer where a computation panics.
fn ended_early() -> ApiError {
    ApiError::internal("internal error of armill: the computation ended early")
}

/// Waits until this question is the one to work on.
async fn turn(tab: &Tab) -> Result<OwnedSemaphorePermit, ApiError> {
    let mut ticket = 0;
    tab.requested.send_modify(|requested| {
        *requested += 1;
        ticket = *requested;
    });
    let mut requested = tab.requested.subscribe();
    tokio::select! {
        biased;
        _ = requested.wait_for(|requested| *requested > ticket) => Err(ApiError::superseded()),
        place = Arc::clone(&tab.place).acquire_owned() => {
            place.map_err(|_| ApiError::internal("the server is stopping"))
        }
    }
}

#[cfg(test)]
mod tests {
    use std::future::Future;
    use std::pin::pin;
    use std::sync::mpsc::channel;
    use std::task::{Context, Waker};

    use super::*;

    fn runtime() -> tokio::runtime::Runtime {
        let mut builder = tokio::runtime::Builder::new_multi_thread();
        builder.worker_threads(1).build().unwrap()
    }

    #[test]
    fn four_requests_are_calculated_at_a_time_and_one_whose_client_leaves_makes_room() {
        let runtime = runtime();
        let _entered = runtime.enter();
        let work = Work::new();
        let (begin, begun) = channel();
        // Each says that it has begun, and works until its client is gone.
        let request = |name: usize| {
            let begin = begin.clone();
            Box::pin(work.done(move |watch| {
                begin.send(name).unwrap();
                while !watch.cancel.load(Ordering::Relaxed) {
                    std::thread::yield_now();
                }
                Ok(())
            }))
        };
        let context = &mut Context::from_waker(Waker::noop());
        let mut requests: Vec<_> = (0..6).map(request).collect();
        for request in &mut requests {
            assert!(request.as_mut().poll(context).is_pending());
        }
        let mut first: Vec<usize> = (0..AT_ONCE).map(|_| begun.recv().unwrap()).collect();
        first.sort_unstable();
        assert_eq!(first, [0, 1, 2, 3]);
        assert_eq!(work.places.available_permits(), 0, "the others have no place");
        let mut last = requests.split_off(AT_ONCE);
        drop(requests);
        let mut next = Vec::new();
        while next.len() < last.len() {
            for request in &mut last {
                assert!(request.as_mut().poll(context).is_pending());
            }
            next.extend(begun.try_iter());
            std::thread::yield_now();
        }
        next.sort_unstable();
        assert_eq!(next, [4, 5]);
    }

    #[test]
    fn tabs_are_answered_at_once_and_a_later_request_replaces_the_waiting_one() {
        let runtime = runtime();
        let _entered = runtime.enter();
        let work = Work::new();
        let tab = |name: &str| HeaderMap::from_iter([("x-tab".parse().unwrap(), name.parse().unwrap())]);
        let (tab_a, tab_b) = (tab("a"), tab("b"));
        let (begin, begun) = channel();
        let (finish, finished) = channel();
        let mut first = pin!(work.done_in_tab(&tab_a, "view", move |_| {
            begin.send(()).unwrap();
            finished.recv().unwrap();
            Ok(1)
        }));
        let mut second = pin!(work.done_in_tab(&tab_a, "view", |_| Ok(2)));
        let mut third = pin!(work.done_in_tab(&tab_a, "view", |_| Ok(3)));
        let context = &mut Context::from_waker(Waker::noop());

        // The first is under way, and the second waits for it.
        assert!(first.as_mut().poll(context).is_pending());
        begun.recv().unwrap();
        assert!(second.as_mut().poll(context).is_pending());
        assert_eq!(
            runtime
                .block_on(work.done_in_tab(&tab_b, "view", |_| Ok(4)))
                .unwrap(),
            4
        );
        assert!(third.as_mut().poll(context).is_pending());
        let replaced = runtime.block_on(second).unwrap_err();
        assert_eq!(format!("{replaced:?}"), format!("{:?}", ApiError::superseded()));
        assert!(third.as_mut().poll(context).is_pending());
        finish.send(()).unwrap();
        assert_eq!(runtime.block_on(first).unwrap(), 1);
        assert_eq!(runtime.block_on(third).unwrap(), 3);
    }
}
