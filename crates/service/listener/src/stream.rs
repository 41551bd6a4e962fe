//! Socket of a connection, with a deadline by progress for data that the other end does not read.

use std::io;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, ready};

use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::TcpStream;
use tokio::time::{Instant, Sleep, sleep_until};

use crate::progress::ConnectionProgress;

/// A socket that reports the progress of its other end, and fails if there is none.
pub(super) struct WatchedStream {
    socket: TcpStream,
    pace: Arc<ConnectionProgress>,
    deadline: Pin<Box<Sleep>>,
}

impl WatchedStream {
    pub(super) fn new(socket: TcpStream, pace: Arc<ConnectionProgress>) -> Self {
        Self { socket, pace, deadline: Box::pin(sleep_until(Instant::now())) }
    }

    /// Records the result of a write; returns an error if the other end has not read for too long.
    fn record_write(
        &mut self,
        context: &mut Context<'_>,
        written: Poll<io::Result<usize>>,
    ) -> Poll<io::Result<usize>> {
        match written {
            // Bytes that the system accepts count as read, within the size of its send buffer.
            Poll::Ready(Ok(bytes)) => self.pace.record_sent(bytes),
            Poll::Ready(Err(_)) => {}
            Poll::Pending => {
                let until = self.pace.awaits_reader();
                // Resetting a timer is costly, so that it is only done if the deadline has moved.
                if self.deadline.deadline() != until {
                    self.deadline.as_mut().reset(until);
                }
                ready!(self.deadline.as_mut().poll(context));
                self.pace.cut_connection();
                return Poll::Ready(Err(io::Error::new(
                    io::ErrorKind::TimedOut,
                    "the client did not read the response",
                )));
            }
        }
        written
    }
}

impl AsyncRead for WatchedStream {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        into: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        Pin::new(&mut self.socket).poll_read(context, into)
    }
}

impl AsyncWrite for WatchedStream {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        let written = Pin::new(&mut self.socket).poll_write(context, bytes);
        self.record_write(context, written)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        slices: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        let written = Pin::new(&mut self.socket).poll_write_vectored(context, slices);
        self.record_write(context, written)
    }

    fn is_write_vectored(&self) -> bool {
        self.socket.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.socket).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.socket).poll_shutdown(context)
    }
}

impl Drop for WatchedStream {
    /// Discards unread data of a closed connection: the system would keep it for minutes.
    fn drop(&mut self) {
        if self.pace.is_cut() {
            drop(self.socket.set_zero_linger());
        }
    }
}
