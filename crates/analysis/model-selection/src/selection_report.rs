//! The selection report: evaluated candidates with error and cost.

use serde::Serialize;

use sistership_identification::refine::EstimationMethod;
use sistership_learned::BranchChoice;

/// Stage of the selection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SelectionStage {
    /// The transferred source.
    CarriedOver,
    /// The weak form.
    Weak,
    /// The trajectory form.
    Trajectory,
}

impl SelectionStage {
    /// Returns the estimator by which candidates are evaluated at the stage.
    pub fn method(self) -> EstimationMethod {
        match self {
            Self::CarriedOver | Self::Weak => EstimationMethod::Weak,
            Self::Trajectory => EstimationMethod::Trajectory,
        }
    }
}

/// One candidate at one stage.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReportLine {
    /// Source; none if only the trials determine the model.
    pub source: Option<String>,
    /// The law.
    pub law: String,
    /// Stage.
    pub rung: SelectionStage,
    /// Coefficients and parameters fitted.
    pub coefficients: usize,
    /// Effective number of these that the trials determine; none if it is not known.
    pub effective: Option<f64>,
    /// Standardised mean squared error on held-out manoeuvres, the geometric mean over restart
    /// intervals; none if a simulation diverged at the shortest.
    pub error: Option<f64>,
    /// Standard error of `error` over the trials; none for fewer than two.
    pub standard_error: Option<f64>,
    /// Jackknife variance of the states that are simulated under rudder orders that no trial had,
    /// on the same scales; none if it is not known or a fold's model cannot be simulated to the
    /// end.
    pub variance: Option<f64>,
    /// Elapsed time of its evaluation, s; weak forms are evaluated in parallel.
    pub cost_s: f64,
    /// True if it was chosen.
    pub chosen: bool,
    /// True for the reference: the most similar eligible ship by correlation, refined with the l2
    /// prior.
    pub reference: bool,
    /// Reason why it was excluded, or why it was chosen.
    pub reason: String,
}

/// All evaluated candidates, in the order of the stages.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct SelectionReport {
    /// Evaluated candidates.
    pub lines: Vec<ReportLine>,
    /// Choice of a learned correction for the chosen model; none if it was not requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub branch: Option<BranchChoice>,
}

impl SelectionReport {
    /// Returns a sentence that compares the reference's error with that of the chosen candidate.
    pub fn reference_summary(&self) -> String {
        let Some(line) = self.lines.iter().find(|line| line.reference) else {
            return "Reference: no ship is eligible as a source.".to_owned();
        };
        let source = line.source.as_deref().unwrap_or("none");
        let head = format!(
            "Reference: the most similar ship by correlation, refined with the l2 prior ({source}, \
             {})",
            line.law
        );
        // Error of the chosen candidate.
        let taken = self.lines.iter().find(|line| line.chosen).and_then(|line| line.error);
        match (line.error, taken) {
            _ if line.chosen => format!("{head}, was selected."),
            (Some(own), Some(taken)) => {
                format!(
                    "{head}: error {own:.3e}, {:.2} times that of the selected model.",
                    own / taken
                )
            }
            _ => format!("{head}: error unknown, {}.", line.reason),
        }
    }
}
