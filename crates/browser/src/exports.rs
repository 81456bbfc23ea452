//! The functions that the page calls. Requests and replies pass through memory that both sides see:
//!
//! 0. `armill_threads(count)` sets the number of threads, once.
//! 1. `armill_input(bytes)` makes room, and returns its address; the page writes method, path and body there.
//! 2. `armill_answer(method_bytes, path_bytes)` answers, and returns the status.
//! 3. `armill_output()` and `armill_output_bytes()` are address and length of the reply: its type, a line break, the bytes.

use std::cell::RefCell;
use std::path::Path;

use crate::session::{FOLDER, Session};

/// What is kept between two calls.
struct Page {
    session: Session,
    input: Vec<u8>,
    output: Vec<u8>,
}

thread_local! {
    static PAGE: RefCell<Option<Page>> = const { RefCell::new(None) };
}

fn with<T>(work: impl FnOnce(&mut Page) -> T) -> T {
    PAGE.with_borrow_mut(|page| {
        work(page.get_or_insert_with(|| Page {
            session: Session::of_folder(Path::new(FOLDER)),
            input: Vec::new(),
            output: Vec::new(),
        }))
    })
}

/// Computes with so many threads, of which the page has started the workers; 1: in the calling worker. Called once, first.
///
/// 0: it does; 1: they do not start.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn armill_threads(count: usize) -> u32 {
    let mut pool = rayon::ThreadPoolBuilder::new().num_threads(count);
    if count == 1 {
        pool = pool.use_current_thread();
    }
    u32::from(pool.build_global().is_err())
}

/// Room for a request of so many bytes: its address.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn armill_input(bytes: usize) -> usize {
    with(|page| {
        page.input = vec![0; bytes];
        page.input.as_ptr().addr()
    })
}

/// Answers the request in this room, whose first bytes are its method and its path; the status of the reply.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn armill_answer(method_bytes: usize, path_bytes: usize) -> u32 {
    with(|page| {
        let input = std::mem::take(&mut page.input);
        // The reply before is dropped first: memory of a browser never shrinks.
        page.output = Vec::new();
        let (method, rest) = input.split_at(method_bytes.min(input.len()));
        let (path, body) = rest.split_at(path_bytes.min(rest.len()));
        let reply = page.session.answer(
            &String::from_utf8_lossy(method),
            &String::from_utf8_lossy(path),
            body,
        );
        page.output
            .reserve_exact(reply.kind.len() + 1 + reply.bytes.len());
        page.output.extend_from_slice(reply.kind.as_bytes());
        page.output.push(b'\n');
        page.output.extend_from_slice(&reply.bytes);
        u32::from(reply.status)
    })
}

/// Address of the reply.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn armill_output() -> usize {
    with(|page| page.output.as_ptr().addr())
}

/// Length of the reply.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn armill_output_bytes() -> usize {
    with(|page| page.output.len())
}
