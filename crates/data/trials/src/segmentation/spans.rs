//! Spans of time.

use serde::Serialize;

/// Span of time of a log.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TimeSpan {
    /// First time, s.
    pub from_s: f64,
    /// Last time, s.
    pub to_s: f64,
}

impl TimeSpan {
    /// Returns the duration, s.
    pub fn duration_s(&self) -> f64 {
        self.to_s - self.from_s
    }

    /// Returns the parts of a whole between spans in ascending order, if they are at least
    /// `least_s` long.
    pub(crate) fn gaps_between(whole: Self, spans: &[Self], least_s: f64) -> Vec<Self> {
        let starts = std::iter::once(whole.from_s).chain(spans.iter().map(|span| span.to_s));
        let ends = spans.iter().map(|span| span.from_s).chain([whole.to_s]);
        let left = starts.zip(ends).map(|(from_s, to_s)| Self { from_s, to_s });
        left.filter(|span| span.duration_s() >= least_s).collect()
    }
}
