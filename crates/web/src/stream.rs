//! The bytes of one connection, which ends when its client does not read or has left.
//!
//! | what the client does | what happens |
//! |---|---|
//! | takes none of the bytes that wait for it for [`WRITE_TIME`] | the connection is closed, whatever the answer is |
//! | closes its side while it waits for an answer | the connection is closed, also where bytes that it sent are not read yet |

use std::io;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, ready};
use std::time::Duration;

use futures_util::FutureExt;
use tokio::io::{AsyncRead, AsyncWrite, Interest, ReadBuf};
use tokio::net::TcpStream;
use tokio::net::tcp::{OwnedReadHalf, OwnedWriteHalf};
use tokio::time::Sleep;

/// How long a client may take no byte of an answer.
const WRITE_TIME: Duration = Duration::from_secs(10);
/// How often is checked whether a client has left.
const CHECK_TIME: Duration = Duration::from_secs(1);

/// A connection with a time limit for writing.
pub(crate) struct Stream {
    reading: Arc<OwnedReadHalf>,
    writing: OwnedWriteHalf,
    /// Runs while the client takes nothing.
    stalled: Option<Pin<Box<Sleep>>>,
}

impl Stream {
    /// The connection through this socket.
    pub(crate) fn new(socket: TcpStream) -> Stream {
        let (reading, writing) = socket.into_split();
        Stream {
            reading: Arc::new(reading),
            writing,
            stalled: None,
        }
    }

    /// Waits until the client has closed its side.
    ///
    /// hyper sees that only when it reads, and it does not read while it buffers bytes behind the request that it
    /// answers.
    pub(crate) fn left(&self) -> impl Future<Output = ()> + Send + use<> {
        let reading = Arc::clone(&self.reading);
        async move {
            loop {
                tokio::time::sleep(CHECK_TIME).await;
                let ready = reading.ready(Interest::READABLE).now_or_never();
                if matches!(ready, Some(Ok(ready)) if ready.is_read_closed()) {
                    return;
                }
            }
        }
    }

    /// What was written, or an error where nothing could be written for too long.
    fn in_time(
        &mut self,
        context: &mut Context<'_>,
        written: Poll<io::Result<usize>>,
    ) -> Poll<io::Result<usize>> {
        if written.is_ready() {
            self.stalled = None;
            return written;
        }
        let stalled = self
            .stalled
            .get_or_insert_with(|| Box::pin(tokio::time::sleep(WRITE_TIME)));
        ready!(stalled.as_mut().poll(context));
        Poll::Ready(Err(io::ErrorKind::TimedOut.into()))
    }
}

impl AsyncRead for Stream {
    fn poll_read(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let socket: &TcpStream = (*self.reading).as_ref();
        loop {
            ready!(socket.poll_read_ready(context))?;
            match socket.try_read_buf(buffer) {
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => (),
                read => return Poll::Ready(read.map(|_| ())),
            }
        }
    }
}

impl AsyncWrite for Stream {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        let written = Pin::new(&mut self.writing).poll_write(context, bytes);
        self.in_time(context, written)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        pieces: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        let written = Pin::new(&mut self.writing).poll_write_vectored(context, pieces);
        self.in_time(context, written)
    }

    fn is_write_vectored(&self) -> bool {
        self.writing.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.writing).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.writing).poll_shutdown(context)
    }
}
