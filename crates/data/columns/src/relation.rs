//! Relations between columns: how well one series explains another, as log odds.

use crate::role::Role;
use crate::signals::RecordingSignals;

/// Log odds for each factor e by which the unexplained part of a relation is smaller.
pub(crate) const PER_FOLD: f64 = 3.0;
/// Largest and smallest log odds of one relation: instruments have scale errors and offsets.
const MAX_ODDS: f64 = 30.0;
pub(crate) const MIN_ODDS: f64 = -12.0;
/// Largest log odds of a relation that a constant would explain as well: only the sizes agree.
const SIZE: f64 = 5.0;
/// Unexplained fraction at which two columns are instruments of one quantity as likely as not.
const ALIKE: f64 = 0.08;
/// Fraction of the blocks whose residuals are excluded as faults of instruments.
const FAULTY: f64 = 0.04;

/// Relation between columns, its log odds, and its figure as text.
#[derive(Debug, Clone)]
pub(crate) struct ColumnRelation {
    /// Quantities of the relation; `Other` fills unused places.
    pub roles: [Role; 3],
    /// Log odds against the columns being unrelated.
    pub odds: f64,
    pub figure: String,
}

/// Fit of one series by another.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SeriesFit {
    /// Unexplained sum of squares as a fraction of the sum of squares, and of the sum of squares
    /// about the mean.
    pub left: f64,
    pub left_of_changes: f64,
    /// Factor of the second series that explains the first best.
    pub slope: f64,
}

impl SeriesFit {
    /// Fits `factor_a * a` by `factor_b * b`; returns `None` if both are zero throughout.
    pub(crate) fn new(a: &[f64], factor_a: f64, b: &[f64], factor_b: f64) -> Option<Self> {
        let mut rows: Vec<(f64, f64, f64)> = a
            .iter()
            .zip(b)
            .map(|(a, b)| {
                let (a, b) = (factor_a * a, factor_b * b);
                ((a - b) * (a - b), a, b)
            })
            .collect();
        // Trimmed least squares: the largest residuals are excluded before the sums are formed.
        let kept = rows.len() - (FAULTY * rows.len() as f64) as usize;
        if kept < rows.len() {
            rows.select_nth_unstable_by(kept, |x, y| x.0.total_cmp(&y.0));
            rows.truncate(kept);
        }
        let (mut left, mut aa, mut ab, mut bb, mut mean) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for &(square, a, b) in &rows {
            left += square;
            aa += a * a;
            ab += a * b;
            bb += b * b;
            mean += a;
        }
        // Sum of squares about the mean.
        let changes = aa - mean * mean / rows.len().max(1) as f64;
        let all = aa.max(bb);
        (all > 0.0).then(|| Self {
            left: left / all,
            left_of_changes: left / changes.max(1e-9 * aa).max(1e-300),
            slope: ab / bb.max(1e-300),
        })
    }

    /// Returns the log odds; `floor` is the unexplained fraction that instruments leave at best.
    pub(crate) fn capped_odds(&self, floor: f64) -> f64 {
        residual_odds(self.left.max(floor))
            .min(SIZE + residual_odds(self.left_of_changes.max(floor)))
    }
}

impl SeriesFit {
    /// Returns the log odds of two instruments of one quantity: they agree in size and in changes,
    /// whereas quantities that only change together, as roll and sway do, differ.
    pub(crate) fn instrument_odds(&self, floor: f64) -> f64 {
        let unexplained = self.left.max(self.left_of_changes.min(1.0)).max(floor);
        (PER_FOLD * (ALIKE / unexplained).ln()).clamp(MIN_ODDS, MAX_ODDS)
    }
}

/// Returns the log odds of an unexplained fraction.
pub(crate) fn residual_odds(unexplained: f64) -> f64 {
    (-PER_FOLD * unexplained.max(1e-5).ln()).clamp(MIN_ODDS, MAX_ODDS)
}

/// Signals from which relations are computed, and the request to write their figures.
#[derive(Clone, Copy)]
pub(crate) struct RelationInput<'a> {
    pub signals: &'a RecordingSignals,
    /// False while thousands of assignments are compared, since text is slow.
    pub is_told: bool,
}

impl RelationInput<'_> {
    pub(crate) fn format_figure(&self, text: impl FnOnce() -> String) -> String {
        if self.is_told { text() } else { String::new() }
    }
}
