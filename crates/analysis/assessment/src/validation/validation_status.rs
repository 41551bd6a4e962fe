//! The validation status of a model, computed.

use serde::Serialize;
use sistership_model::vessel::Status;

use crate::validation::comparison::FigureComparison;

/// Validation status of a model, by the origin of its figures and the published trials of its ship.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ValidationStatus {
    /// Every published free-running figure of the ship is within [`crate::validation::limits`].
    Validated,
    /// The coefficients are measured or computed, and no free-running figure of the ship is known.
    Published,
    /// Some published free-running figure of the ship is outside the limits.
    Disputed,
    /// The coefficients are from formulas or judgement, and no free-running figure of the ship is
    /// known.
    Estimated,
}

impl ValidationStatus {
    /// Returns the status for an origin of the figures and the comparisons.
    pub fn from_comparisons(origin: Status, comparisons: &[FigureComparison]) -> Self {
        match (comparisons.is_empty(), comparisons.iter().all(FigureComparison::is_within)) {
            (false, true) => Self::Validated,
            (false, false) => Self::Disputed,
            (true, _) if matches!(origin, Status::Estimated | Status::Transferred) => {
                Self::Estimated
            }
            (true, _) => Self::Published,
        }
    }

    /// Returns the word for reports.
    pub fn as_word(self) -> &'static str {
        match self {
            Self::Validated => "validated",
            Self::Published => "published",
            Self::Disputed => "disputed",
            Self::Estimated => "estimated",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(sailed: f64) -> FigureComparison {
        FigureComparison {
            figure: "turn 35 deg: advance".into(),
            unit: "L",
            source: "a".into(),
            published: 3.0,
            uncertainty: 0.1,
            sailed: Some(sailed),
            limit: 0.4,
        }
    }

    #[test]
    fn a_standing_follows_from_origin_and_trials() {
        assert_eq!(
            ValidationStatus::from_comparisons(Status::Published, &[]),
            ValidationStatus::Published
        );
        assert_eq!(
            ValidationStatus::from_comparisons(Status::Estimated, &[]),
            ValidationStatus::Estimated
        );
        assert_eq!(
            ValidationStatus::from_comparisons(Status::Estimated, &[figure(3.3)]),
            ValidationStatus::Validated
        );
        let mixed = [figure(3.3), figure(3.5)];
        assert_eq!(
            ValidationStatus::from_comparisons(Status::Published, &mixed),
            ValidationStatus::Disputed
        );
        let unsailed = [FigureComparison { sailed: None, ..figure(3.0) }];
        assert_eq!(
            ValidationStatus::from_comparisons(Status::Published, &unsailed),
            ValidationStatus::Disputed
        );
    }
}
