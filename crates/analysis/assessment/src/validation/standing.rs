//! What a model is worth, computed.

use serde::Serialize;
use sistership_model::vessel::Status;

use crate::validation::comparison::Comparison;

/// What a model is worth, by where its figures come from and by the published trials of its ship.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Standing {
    /// Every published free-running figure of its ship is met within [`crate::validation::limits`].
    Validated,
    /// From measurement or computation, and no free-running figure of its ship is known.
    Published,
    /// Some published free-running figure of its ship is missed.
    Disputed,
    /// By formulas or judgement, and no free-running figure of its ship is known.
    Estimated,
}

impl Standing {
    /// Follows from the origin of the figures and the comparisons.
    pub fn of(origin: Status, comparisons: &[Comparison]) -> Self {
        match (comparisons.is_empty(), comparisons.iter().all(Comparison::is_within)) {
            (false, true) => Self::Validated,
            (false, false) => Self::Disputed,
            (true, _) if matches!(origin, Status::Estimated | Status::Transferred) => {
                Self::Estimated
            }
            (true, _) => Self::Published,
        }
    }

    /// The word for people.
    pub fn word(self) -> &'static str {
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

    fn figure(sailed: f64) -> Comparison {
        Comparison {
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
        assert_eq!(Standing::of(Status::Published, &[]), Standing::Published);
        assert_eq!(Standing::of(Status::Estimated, &[]), Standing::Estimated);
        assert_eq!(Standing::of(Status::Estimated, &[figure(3.3)]), Standing::Validated);
        let mixed = [figure(3.3), figure(3.5)];
        assert_eq!(Standing::of(Status::Published, &mixed), Standing::Disputed);
        let unsailed = [Comparison { sailed: None, ..figure(3.0) }];
        assert_eq!(Standing::of(Status::Published, &unsailed), Standing::Disputed);
    }
}
