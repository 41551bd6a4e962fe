//! Bodies of requests with a deadline by progress, and bodies of answers that report their end.

use std::pin::Pin;
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll, ready};
use std::time::Duration;

use axum::BoxError;
use axum::body::Body;
use bytes::Bytes;
use http_body_util::BodyExt as _;
use hyper::body::{Body as HttpBody, Frame, Incoming, SizeHint};
use tokio::time::{Instant, Sleep, sleep_until};

use crate::progress::ConnectionProgress;

/// Maximum size, and maximum time, for discarding the rest of a body that is refused before its
/// end. Otherwise a client that still sends would find the connection reset instead of the answer:
/// RFC 9112, section 9.6. The size is four times the largest document; beyond either bound the
/// connection is closed all the same.
const REST_BYTES: usize = 16 << 20;
const REST_TIME: Duration = Duration::from_secs(2);

/// The body of a request.
pub(super) struct RequestBody {
    body: Option<Incoming>,
    pace: Arc<ConnectionProgress>,
    deadline: Pin<Box<Sleep>>,
    rest: UnreadBody,
}

/// The unread rest of a request's body after the handler has dropped it.
#[derive(Clone, Default)]
pub(super) struct UnreadBody(Arc<Mutex<Option<Incoming>>>);

impl UnreadBody {
    fn lock_body(&self) -> std::sync::MutexGuard<'_, Option<Incoming>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Discards the rest as it arrives, within the bounds of size and time.
    pub(super) async fn discard(&self) {
        let Some(mut body) = self.lock_body().take() else { return };
        let mut left = REST_BYTES;
        let discarded = async {
            while let Some(Ok(frame)) = body.frame().await {
                let bytes = frame.data_ref().map_or(0, Bytes::len);
                left = match left.checked_sub(bytes) {
                    Some(left) => left,
                    None => break,
                };
            }
        };
        let _ = tokio::time::timeout(REST_TIME, discarded).await;
    }
}

/// The body of an answer.
pub(super) struct ResponseBody {
    body: Body,
    pace: Arc<ConnectionProgress>,
}

impl RequestBody {
    pub(super) fn new(body: Incoming, pace: Arc<ConnectionProgress>, rest: UnreadBody) -> Self {
        Self { body: Some(body), pace, deadline: Box::pin(sleep_until(Instant::now())), rest }
    }
}

impl HttpBody for RequestBody {
    type Data = Bytes;
    type Error = BoxError;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, BoxError>>> {
        let Some(body) = &mut self.body else { return Poll::Ready(None) };
        if let Poll::Ready(frame) = Pin::new(body).poll_frame(context) {
            // Each byte extends the deadline of the transfer.
            let bytes = frame.iter().flatten().filter_map(Frame::data_ref).map(Bytes::len).sum();
            self.pace.record_received(bytes);
            return Poll::Ready(frame.map(|frame| frame.map_err(BoxError::from)));
        }
        let until = self.pace.awaits_body();
        // Resetting a timer is costly, so that it is only done if the deadline has moved.
        if self.deadline.deadline() != until {
            self.deadline.as_mut().reset(until);
        }
        ready!(self.deadline.as_mut().poll(context));
        // The deadline has passed: the handler gets an error instead of the rest of the body.
        self.pace.mark_slow();
        self.pace.record_received(0);
        Poll::Ready(Some(Err("the body arrived too slowly".into())))
    }

    fn is_end_stream(&self) -> bool {
        self.body.as_ref().is_none_or(HttpBody::is_end_stream)
    }

    fn size_hint(&self) -> SizeHint {
        self.body.as_ref().map_or_else(SizeHint::new, HttpBody::size_hint)
    }
}

impl Drop for RequestBody {
    /// Ends the wait for the body and keeps its unread rest, to be discarded after the answer is
    /// made.
    fn drop(&mut self) {
        self.pace.record_received(0);
        *self.rest.lock_body() = self.body.take().filter(|body| !body.is_end_stream());
    }
}

impl ResponseBody {
    pub(super) fn new(body: Body, pace: Arc<ConnectionProgress>) -> Self {
        Self { body, pace }
    }
}

impl HttpBody for ResponseBody {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        Pin::new(&mut self.body).poll_frame(context)
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

impl Drop for ResponseBody {
    fn drop(&mut self) {
        self.pace.end_answer();
    }
}
