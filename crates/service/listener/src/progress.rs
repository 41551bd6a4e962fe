//! Progress of a connection: its present wait, and the time for which the other end has made too
//! little progress.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tokio::sync::Notify;
use tokio::time::Instant;

use crate::limits::ConnectionLimits;

/// Maximum time that bytes can earn in advance.
const MOST_CREDIT: Duration = Duration::from_secs(60);

/// Remaining time of the other end for a transfer: it starts with a grace, and each byte adds some.
#[derive(Debug, Clone, Copy)]
struct TransferDeadline {
    grace: Duration,
    left: Duration,
    most: Duration,
    since: Option<Instant>,
}

impl TransferDeadline {
    fn new(grace: Duration) -> Self {
        Self { grace, left: grace, most: grace.max(MOST_CREDIT), since: None }
    }

    /// Begins to wait, unless it waits already; returns the deadline.
    fn begin_wait(&mut self, now: Instant) -> Instant {
        *self.since.get_or_insert(now) + self.left
    }

    fn add_progress(&mut self, bytes: usize, rate: usize, now: Instant) {
        self.end_wait(now);
        // At the minimum rate, the time earned equals the time that the bytes took.
        let earned = Duration::from_secs_f64(bytes as f64 / rate.max(1) as f64);
        self.left = (self.left + earned).min(self.most);
    }

    /// Ends the wait and subtracts its duration.
    fn end_wait(&mut self, now: Instant) {
        if let Some(since) = self.since.take() {
            self.left = self.left.saturating_sub(now.saturating_duration_since(since));
        }
    }

    /// Returns the duration of the present wait, including earlier waits that were interrupted by
    /// only a few bytes; none while it does not wait.
    fn waiting_time(&self, now: Instant) -> Option<Duration> {
        let waited = now.saturating_duration_since(self.since?);
        // With little earned, `left` is below the grace, and the difference is the time wasted
        // before.
        Some(waited.max((self.grace + waited).saturating_sub(self.left)))
    }
}

#[derive(Debug)]
struct ProgressState {
    /// Start of the wait for a request's head; none while a request is processed.
    head: Option<Instant>,
    body: TransferDeadline,
    answer: TransferDeadline,
    cut: bool,
}

/// Progress of one connection, shared by its stream, its bodies and the table of connections.
#[derive(Debug)]
pub(crate) struct ConnectionProgress {
    rate: usize,
    grace: Duration,
    state: Mutex<ProgressState>,
    slow: AtomicBool,
    cut: Notify,
    written: Notify,
}

impl ConnectionProgress {
    pub(super) fn new(limits: &ConnectionLimits) -> Self {
        let body = TransferDeadline::new(limits.body_grace);
        let state = ProgressState {
            head: Some(Instant::now()),
            body,
            answer: TransferDeadline::new(limits.answer_grace),
            cut: false,
        };
        Self {
            rate: limits.least_rate,
            grace: limits.body_grace,
            state: Mutex::new(state),
            slow: AtomicBool::new(false),
            cut: Notify::new(),
            written: Notify::new(),
        }
    }

    fn lock_state(&self) -> MutexGuard<'_, ProgressState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Records that a request's head has been read.
    pub(super) fn begin_request(&self) {
        let mut state = self.lock_state();
        state.head = None;
        state.body = TransferDeadline::new(self.grace);
    }

    /// Records that an answer is complete, though possibly not yet sent.
    pub(super) fn end_answer(&self) {
        let mut state = self.lock_state();
        state.head = Some(Instant::now());
        state.body.since = None;
    }

    /// Records the wait for the body; returns its deadline.
    pub(super) fn awaits_body(&self) -> Instant {
        self.lock_state().body.begin_wait(Instant::now())
    }

    /// Records the arrival of bytes of the body, or of its end.
    pub(super) fn record_received(&self, bytes: usize) {
        self.lock_state().body.add_progress(bytes, self.rate, Instant::now());
    }

    /// Records that the other end does not read the answer; returns the deadline.
    pub(super) fn awaits_reader(&self) -> Instant {
        self.lock_state().answer.begin_wait(Instant::now())
    }

    /// Records that bytes of the answer were accepted by the system.
    pub(super) fn record_sent(&self, bytes: usize) {
        self.lock_state().answer.add_progress(bytes, self.rate, Instant::now());
        self.written.notify_waiters();
    }

    /// Waits until the other end has read what was sent to it, so that answers do not accumulate.
    pub(super) async fn until_read(&self) {
        loop {
            // Created before the test, so that a notification between test and wait is not lost.
            let written = self.written.notified();
            if self.lock_state().answer.since.is_none() {
                return;
            }
            written.await;
        }
    }

    /// Returns the time for which the connection has waited for its other end; none while the
    /// server processes a request.
    pub(super) fn stuck_time(&self, now: Instant) -> Option<Duration> {
        let state = self.lock_state();
        // In this order: an unread answer counts even while the next request is awaited.
        let head = || state.head.map(|since| now.saturating_duration_since(since));
        state.answer.waiting_time(now).or_else(|| state.body.waiting_time(now)).or_else(head)
    }

    /// Closes the connection if it still waits for its other end; returns true if it does.
    pub(super) fn cut_if_stuck(&self) -> bool {
        let mut state = self.lock_state();
        let stuck =
            state.answer.since.is_some() || state.body.since.is_some() || state.head.is_some();
        state.cut |= stuck;
        if stuck {
            self.cut.notify_one();
        }
        stuck
    }

    /// Closes the connection in any state.
    pub(super) fn cut_connection(&self) {
        self.lock_state().cut = true;
        self.cut.notify_one();
    }

    pub(super) fn is_cut(&self) -> bool {
        self.lock_state().cut
    }

    /// Waits until the connection is to be closed.
    pub(super) async fn until_cut(&self) {
        self.cut.notified().await;
    }

    pub(super) fn mark_slow(&self) {
        self.slow.store(true, Ordering::Relaxed);
    }

    /// Returns true if the body of the request came too slowly.
    pub(crate) fn is_too_slow(&self) -> bool {
        self.slow.load(Ordering::Relaxed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_earn_time_and_waiting_takes_it() {
        let (start, s) = (Instant::now(), Duration::from_secs);
        let mut credit = TransferDeadline::new(s(10));
        assert_eq!((credit.waiting_time(start), credit.begin_wait(start)), (None, start + s(10)));
        assert_eq!(credit.begin_wait(start + s(3)), start + s(10), "waiting goes on");
        assert_eq!(credit.waiting_time(start + s(4)), Some(s(4)));
        credit.add_progress(200, 100, start + s(4));
        assert_eq!(
            credit.begin_wait(start + s(4)),
            start + s(12),
            "10 s - 4 s + 200 bytes of 100 bytes/s"
        );
        assert_eq!(credit.waiting_time(start + s(5)), Some(s(3)), "3 s more than was earned");
        credit.add_progress(1 << 20, 100, start + s(5));
        assert_eq!(credit.begin_wait(start + s(5)), start + s(5) + MOST_CREDIT);
        assert_eq!(credit.waiting_time(start + s(6)), Some(s(1)));
    }

    #[tokio::test]
    async fn who_waits_for_the_server_is_not_cut() {
        let pace = ConnectionProgress::new(&ConnectionLimits::default());
        pace.begin_request();
        assert_eq!(pace.stuck_time(Instant::now()), None);
        assert!(!pace.cut_if_stuck() && !pace.is_cut());
        pace.end_answer();
        assert!(pace.cut_if_stuck() && pace.is_cut());
        pace.until_cut().await;
    }
}
