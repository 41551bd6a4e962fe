//! A relation between columns: how well one series explains another, and what that is worth.

use crate::role::Role;
use crate::signals::Signals;

/// Log odds for each e-fold by which a relation leaves less unexplained.
pub(crate) const PER_FOLD: f64 = 3.0;
/// Log odds that one relation can give or take: instruments have scales and offsets of their own.
const MOST: f64 = 30.0;
pub(crate) const LEAST: f64 = -12.0;
/// Log odds of a relation that a constant would explain as well: the sizes match, no more.
const SIZE: f64 = 5.0;
/// Part of the blocks whose residuals are left out: faults of instruments.
const FAULTY: f64 = 0.04;

/// A relation, what it gives, and its figure for a reader.
#[derive(Debug, Clone)]
pub(crate) struct Relation {
    /// Quantities that take part; `Other` fills up.
    pub roles: [Role; 3],
    /// Log odds against the columns being unrelated.
    pub odds: f64,
    pub figure: String,
}

/// How well one series explains another.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fit {
    /// Squares that are left, of all; and of those about the mean.
    pub left: f64,
    pub left_of_changes: f64,
    /// The factor that would explain most.
    pub slope: f64,
}

impl Fit {
    /// Explains `a` by `factor * b`; nothing where both stand still.
    pub(crate) fn new(a: &[f64], factor_a: f64, b: &[f64], factor_b: f64) -> Option<Self> {
        let mut rows: Vec<(f64, f64, f64)> = a
            .iter()
            .zip(b)
            .map(|(a, b)| {
                let (a, b) = (factor_a * a, factor_b * b);
                ((a - b) * (a - b), a, b)
            })
            .collect();
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
        let changes = aa - mean * mean / rows.len().max(1) as f64;
        let all = aa.max(bb);
        (all > 0.0).then(|| Self {
            left: left / all,
            left_of_changes: left / changes.max(1e-9 * aa).max(1e-300),
            slope: ab / bb.max(1e-300),
        })
    }

    /// Its log odds; `floor` is the part that instruments leave at best.
    pub(crate) fn odds(&self, floor: f64) -> f64 {
        odds_of(self.left.max(floor)).min(SIZE + odds_of(self.left_of_changes.max(floor)))
    }
}

/// Log odds of a part that is left unexplained.
pub(crate) fn odds_of(unexplained: f64) -> f64 {
    (-PER_FOLD * unexplained.max(1e-5).ln()).clamp(LEAST, MOST)
}

/// What relations are read from, and whether their figures are written out.
#[derive(Clone, Copy)]
pub(crate) struct Observed<'a> {
    pub signals: &'a Signals,
    /// Not while thousands of assignments are compared.
    pub is_told: bool,
}

impl Observed<'_> {
    pub(crate) fn figure(&self, text: impl FnOnce() -> String) -> String {
        if self.is_told { text() } else { String::new() }
    }
}
