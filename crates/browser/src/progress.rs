//! Progress of a job, as lines on stdout: one JSON object each, ten times a second at most.

use std::cell::Cell;
use std::io::Write;
use std::time::{Duration, Instant};

use armill_api::Job;

/// Ten times a second.
const LINE_TIME: Duration = Duration::from_millis(100);

thread_local! {
    /// When the last line was written.
    static LAST: Cell<Option<Instant>> = const { Cell::new(None) };
}

/// Writes the state of a job, unless that was done a moment ago.
pub(crate) fn show(job: &Job) {
    let now = Instant::now();
    if LAST.get().is_some_and(|last| now - last < LINE_TIME) {
        return;
    }
    LAST.set(Some(now));
    // Without a page that listens the job goes on.
    if let Ok(mut line) = serde_json::to_vec(&job.reported(false)) {
        line.push(b'\n');
        let mut out = std::io::stdout().lock();
        let _ = out.write_all(&line).and_then(|()| out.flush());
    }
}
