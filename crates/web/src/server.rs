//! Starts, listens on loopback, and stops.
//!
//! | bound | value |
//! |---|---|
//! | connections at a time | 512; those without the token are closed first: see `connections` |
//! | head of a request | 10 s, 65536 bytes exactly |
//! | an answer of which the client takes nothing | 10 s: see `stream` |
//! | answers under way when it stops, time for a job to stop | 5 s each |
//!
//! A job under way is cancelled when it stops; its files are complete or not there.

use std::net::{Ipv4Addr, SocketAddr};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use armill_api::{Cell, Context};
use armill_study::StudyError;
use axum::Router;
use axum::routing::get;
use hyper::Request;
use hyper::body::Incoming;
use hyper::server::conn::http1;
use hyper::service::{Service, service_fn};
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::server::graceful::GracefulShutdown;
use hyper_util::service::TowerToHyperService;
use tokio::net::TcpListener;
use tokio::runtime::Runtime;
use tokio::sync::watch;
use tokio::task::JoinHandle;

use crate::connections::Connections;
use crate::guard::{Guard, Token};
use crate::opening::{Opening, PAGE_TIME};
use crate::queue::Queue;
use crate::state::State;
use crate::stream::Stream;
use crate::tickets::Tickets;
use crate::work::Work;
use crate::{api, error, files, guard, page};

/// Connections at a time: half of the files that most systems let a process open.
const MOST_CONNECTIONS: usize = 512;
/// How long the head of a request may take.
const HEAD_TIME: Duration = Duration::from_secs(10);
/// Bytes of the head of a request.
const MOST_HEAD: usize = 64 * 1024;
/// Time for answers under way when it stops, and then for a job to stop.
const LAST_ANSWERS: Duration = Duration::from_secs(5);
/// Time for a computation to notice that it is cancelled.
const LAST_WORK: Duration = Duration::from_secs(2);

/// What to serve.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Folder with a study, the file itself, or the name of an example; without, the current folder if it contains one,
    /// else the example mh12-groove.
    pub study: Option<PathBuf>,
    /// Port on 127.0.0.1; 0: one that depends only on the study, or, if that is taken, one chosen by the system.
    pub port: u16,
    /// Whether [`Server::run`] shows the page in the user's browser.
    pub opens_browser: bool,
}

/// A server that listens.
pub struct Server {
    runtime: Runtime,
    url: String,
    opens_browser: bool,
    stop: watch::Sender<bool>,
    listening: JoinHandle<()>,
    state: Arc<State>,
}

impl Server {
    /// Listens; the study is not evaluated yet, so that an invalid one can be corrected on the page.
    ///
    /// # Errors
    /// No study there; a port that is taken; no randomness for the token.
    pub fn start(options: &Options) -> Result<Server, StudyError> {
        let cell = Cell::find(options.study.as_deref())?;
        let token = Token::random()?;
        let refused = |error: std::io::Error| {
            let message = format!("cannot listen on 127.0.0.1:{}: {error}", options.port);
            StudyError::value(
                message,
                "choose another --port, or none: the system then chooses one",
            )
        };
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(2)
            .max_blocking_threads(64)
            .enable_all()
            .build()
            .map_err(refused)?;
        let bind = |port| runtime.block_on(TcpListener::bind(SocketAddr::from((Ipv4Addr::LOCALHOST, port))));
        let listener = match options.port {
            0 => bind(cell.preferred_port()).or_else(|_| bind(0)),
            port => bind(port),
        };
        let listener = listener.map_err(refused)?;
        let port = listener.local_addr().map_err(refused)?.port();
        let url = format!("http://127.0.0.1:{port}/?token={}", token.shown());
        let state = Arc::new(State {
            jobs: Queue::start(cell.root.clone()),
            context: Arc::new(Context::new(cell)),
            work: Work::new(),
            opening: Opening::default(),
            tickets: Tickets::default(),
        });
        let (stop, stopped) = watch::channel(false);
        let app = router(&state, Guard::new(port, token));
        let listening = runtime.spawn(listen(listener, app, stopped));
        Ok(Server {
            runtime,
            url,
            opens_browser: options.opens_browser,
            stop,
            listening,
            state,
        })
    }

    /// Where the page is, with the token that it needs.
    pub fn url(&self) -> &str {
        &self.url
    }

    /// Serves until the user interrupts (Ctrl-C) or the system requests it to end, then stops.
    pub fn run(self) {
        self.runtime.block_on(async {
            // Before there is a file that an interrupt would leave.
            let interrupted = interrupted();
            if self.opens_browser {
                self.open_browser();
            }
            interrupted.await;
        });
        self.stop();
    }

    /// Shows the page in the user's browser; that there is none is not an error.
    fn open_browser(&self) {
        let Ok(page) = self.state.opening.write(&self.url) else {
            return;
        };
        // It waits for the program that opens the browser.
        self.runtime.spawn_blocking(move || open::that_detached(page));
        let state = Arc::clone(&self.state);
        self.runtime.spawn(async move {
            tokio::time::sleep(PAGE_TIME).await;
            state.opening.remove();
        });
    }

    /// Takes no more connections, lets answers under way end, and cancels jobs.
    pub fn stop(self) {
        let Server {
            runtime,
            stop,
            listening,
            state,
            ..
        } = self;
        state.jobs.stop();
        // The other end goes with the task that listens.
        let _ = stop.send(true);
        let _ = runtime.block_on(listening);
        state.jobs.wait(LAST_ANSWERS);
        state.opening.remove();
        runtime.shutdown_timeout(LAST_WORK);
    }
}

/// All paths.
fn router(state: &Arc<State>, guard: Guard) -> Router {
    Router::new()
        .nest("/api", api::router())
        .route("/open/{ticket}/{name}", get(files::open))
        .route("/", get(page::file))
        .route("/{*path}", get(page::file))
        .method_not_allowed_fallback(error::wrong_method)
        .layer(axum::middleware::from_fn_with_state(
            Arc::new(guard),
            guard::check,
        ))
        .with_state(Arc::clone(state))
}

/// Takes connections until it is stopped, then waits for answers under way.
async fn listen(listener: TcpListener, app: Router, mut stopped: watch::Receiver<bool>) {
    let connections = Connections::new(MOST_CONNECTIONS);
    let graceful = GracefulShutdown::new();
    loop {
        let next = async {
            let (socket, _) = listener.accept().await.ok()?;
            Some((socket, connections.place().await?))
        };
        let is_stopped = async {
            let _ = stopped.wait_for(|stopped| *stopped).await;
        };
        let accepted = tokio::select! {
            accepted = next => accepted,
            () = is_stopped => break,
        };
        let Some((socket, mut place)) = accepted else {
            // Too many open files, say: others will close.
            tokio::time::sleep(Duration::from_millis(100)).await;
            continue;
        };
        let _ = socket.set_nodelay(true);
        let stream = Stream::new(socket);
        let left = stream.left();
        let (client, app) = (place.client.clone(), TowerToHyperService::new(app.clone()));
        let service = service_fn(move |mut request: Request<Incoming>| {
            request.extensions_mut().insert(client.clone());
            app.call(request)
        });
        let connection = http1::Builder::new()
            .timer(TokioTimer::new())
            .header_read_timeout(HEAD_TIME)
            .max_header_size(MOST_HEAD)
            .max_buf_size(MOST_HEAD)
            .serve_connection(TokioIo::new(stream), service);
        let connection = graceful.watch(connection);
        tokio::spawn(async move {
            // A client that went away, or sent no HTTP, is not a fault of the server.
            tokio::select! {
                _ = connection => (),
                () = left => (),
                () = place.is_revoked() => (),
            }
        });
    }
    drop(listener);
    let _ = tokio::time::timeout(LAST_ANSWERS, graceful.shutdown()).await;
}

/// Ctrl-C, or the signal by which systems end programs; they are waited for from this call on.
#[cfg(unix)]
fn interrupted() -> impl Future<Output = ()> {
    use tokio::signal::unix::{SignalKind, signal};
    let (interrupt, terminate) = (signal(SignalKind::interrupt()), signal(SignalKind::terminate()));
    async move {
        match (interrupt, terminate) {
            (Ok(mut interrupt), Ok(mut terminate)) => {
                tokio::select! {
                    _ = interrupt.recv() => (),
                    _ = terminate.recv() => (),
                }
            }
            (Ok(mut one), Err(_)) | (Err(_), Ok(mut one)) => {
                one.recv().await;
            }
            // The system ends the program without a signal.
            (Err(_), Err(_)) => std::future::pending().await,
        }
    }
}

/// Ctrl-C.
#[cfg(not(unix))]
async fn interrupted() {
    let _ = tokio::signal::ctrl_c().await;
}
