//! Large answers: they hold their share of the memory budget until their last byte is sent, since a
//! client may read slowly or not at all.

use std::pin::Pin;
use std::task::{Context, Poll, ready};

use axum::body::{Body, HttpBody};
use axum::response::{IntoResponse as _, Response};
use bytes::Bytes;
use hyper::body::{Frame, SizeHint};

use crate::problem::Problem;
use sistership_jobs::budget::{self, MemoryShare};

/// Maximum size of an answer that is not counted, bytes; larger ones are sent in pieces of it, so
/// that at most one piece is outside of the count.
const PIECE: usize = 64 << 10;

/// A body with its share of the memory budget.
struct LargeBody {
    body: Body,
    /// Rest of a frame that is not sent yet.
    rest: Bytes,
    _share: Option<MemoryShare>,
}

/// Takes a share of the memory budget for a large answer; replaces the answer by a refusal if there
/// is none.
pub async fn count_large(response: Response) -> Response {
    let size = response.body().size_hint().exact().unwrap_or_default();
    if size <= PIECE as u64 {
        return response;
    }
    match budget::reserve_share(size).await {
        Ok(share) => {
            response.map(|body| Body::new(LargeBody { body, rest: Bytes::new(), _share: share }))
        }
        // The answer is dropped here: its memory is free again before the refusal is sent.
        Err(shortage) => Problem::from(shortage).into_response(),
    }
}

impl HttpBody for LargeBody {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        if self.rest.is_empty() {
            // Data frames are cut into pieces below; trailers pass unchanged.
            match ready!(Pin::new(&mut self.body).poll_frame(context))
                .map(|frame| frame.map(Frame::into_data))
            {
                Some(Ok(Ok(data))) => self.rest = data,
                Some(Ok(Err(trailers))) => return Poll::Ready(Some(Ok(trailers))),
                Some(Err(error)) => return Poll::Ready(Some(Err(error))),
                None => return Poll::Ready(None),
            }
        }
        let piece = PIECE.min(self.rest.len());
        Poll::Ready(Some(Ok(Frame::data(self.rest.split_to(piece)))))
    }

    fn is_end_stream(&self) -> bool {
        self.rest.is_empty() && self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        let (inner, rest) = (self.body.size_hint(), self.rest.len() as u64);
        let mut hint = SizeHint::new();
        hint.set_lower(inner.lower() + rest);
        inner.upper().into_iter().for_each(|upper| hint.set_upper(upper + rest));
        hint
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::time::Duration;

    use futures::StreamExt as _;

    use super::*;
    use sistership_jobs::budget::{MemoryBudget, RequestMemory};

    #[tokio::test]
    async fn a_large_answer_has_its_share_until_it_is_handed_out() {
        let budget = MemoryBudget::new(1 << 20, "x");
        let answer = |size: usize| {
            RequestMemory::new(budget.clone(), Duration::ZERO)
                .run_async(count_large(vec![7; size].into_response()))
        };
        assert_eq!(answer(2 << 20).await.status(), 413);
        let response = answer(600 << 10).await;
        assert_eq!(response.body().size_hint().exact(), Some(600 << 10));
        assert_eq!(answer(600 << 10).await.status(), 429);
        assert_eq!(answer(60 << 10).await.status(), 200);
        let pieces: Vec<_> =
            response.into_body().into_data_stream().map(Result::unwrap).collect().await;
        assert!(pieces.len() == 10 && pieces.iter().all(|piece| piece.len() <= PIECE));
        assert_eq!(budget.free_bytes(), 1 << 20);
    }
}
