//! What the search has tried, with error and cost.

use serde::Serialize;

use sistership_identification::refine::Method;
use sistership_learned::BranchChoice;

/// How far an entrant was taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Rung {
    /// The source as carried over.
    CarriedOver,
    /// The weak form.
    Weak,
    /// The trajectory form.
    Trajectory,
}

impl Rung {
    /// The estimator by which the entrant is weighed there.
    pub fn method(self) -> Method {
        match self {
            Self::CarriedOver | Self::Weak => Method::Weak,
            Self::Trajectory => Method::Trajectory,
        }
    }
}

/// One entrant on one rung.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Line {
    /// The source; none where the trials alone make the model.
    pub source: Option<String>,
    /// The law.
    pub law: String,
    /// How far it was taken.
    pub rung: Rung,
    /// Coefficients fitted.
    pub coefficients: usize,
    /// Standardised mean squared error on manoeuvres left out, the geometric mean over restart
    /// intervals; none where a simulation diverged at the shortest.
    pub error: Option<f64>,
    /// Its standard error over the trials; none below two.
    pub standard_error: Option<f64>,
    /// Jackknife variance of what it simulates under rudders that no trial had, on the same scales;
    /// none where it is not known or a fold does not sail.
    pub variance: Option<f64>,
    /// Wall time until it was weighed, s; weak forms are weighed side by side.
    pub cost_s: f64,
    /// Whether it was taken.
    pub chosen: bool,
    /// Whether it is the reference: the most similar ship by correlation that is eligible, refined
    /// with the l2 prior.
    pub reference: bool,
    /// Why it is out, or why it was taken.
    pub reason: String,
}

/// Everything that was tried, in the order of the rungs.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Ladder {
    /// The lines.
    pub lines: Vec<Line>,
    /// Whether a learned branch is taken beside what was chosen; none where that was not asked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub branch: Option<BranchChoice>,
}

impl Ladder {
    /// What the reference leaves on manoeuvres left out, beside what was taken.
    pub fn reference(&self) -> String {
        let Some(line) = self.lines.iter().find(|line| line.reference) else {
            return "Reference: no ship is eligible as a source.".to_owned();
        };
        let source = line.source.as_deref().unwrap_or("none");
        let head = format!(
            "Reference: the most similar ship by correlation, refined with the l2 prior ({source}, \
             {})",
            line.law
        );
        let taken = self.lines.iter().find(|line| line.chosen).and_then(|line| line.error);
        match (line.error, taken) {
            _ if line.chosen => format!("{head}, is what was taken."),
            (Some(own), Some(taken)) => {
                format!("{head}: error {own:.3e}, {:.2} times that of what was taken.", own / taken)
            }
            _ => format!("{head}: no error is known, {}.", line.reason),
        }
    }
}
