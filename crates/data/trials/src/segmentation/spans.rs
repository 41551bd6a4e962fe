//! Times from and to.

use serde::Serialize;

/// A part of a log.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Span {
    /// Its first time, s.
    pub from_s: f64,
    /// Its last, s.
    pub to_s: f64,
}

impl Span {
    /// How long it is, s.
    pub fn duration_s(&self) -> f64 {
        self.to_s - self.from_s
    }

    /// What is left of a whole between spans in order, where it is so long.
    pub(crate) fn between(whole: Self, spans: &[Self], least_s: f64) -> Vec<Self> {
        let starts = std::iter::once(whole.from_s).chain(spans.iter().map(|span| span.to_s));
        let ends = spans.iter().map(|span| span.from_s).chain([whole.to_s]);
        let left = starts.zip(ends).map(|(from_s, to_s)| Self { from_s, to_s });
        left.filter(|span| span.duration_s() >= least_s).collect()
    }
}
