//! Selection of the kind of learned correction by held-out trials.

use serde::{Deserialize, Serialize};
use sistership_model::Model;
use sistership_simulation::recorded::ReplaySettings;

use crate::held_out::HeldOutTrials;
use crate::judge::{CorrectionEvaluation, evaluate_folds};
use crate::settings::{BranchKind, BranchSettings};
use crate::train::TrainError;

/// Evaluated kinds, and the selected one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BranchChoice {
    /// Every evaluated kind, in the order of evaluation.
    pub tried: Vec<KindEvaluation>,
    /// Kind of least error, if it is better than the foundation by more than one standard error of
    /// the difference; `None` if no correction should be used.
    pub taken: Option<BranchKind>,
    /// Further checks of that kind, up to the first that failed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub checks: Vec<BranchCheck>,
    /// Reason for the selection, as a sentence.
    pub reason: String,
}

/// Comparison that a correction must pass before it is used.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BranchCheck {
    /// Quantity that is compared.
    pub what: String,
    /// Figure of the foundation.
    pub foundation: f64,
    /// Figure of the foundation with the correction, which must not be larger.
    pub branch: f64,
    /// True if the check is passed.
    pub passed: bool,
}

/// Error of one kind on held-out trials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KindEvaluation {
    /// Kind of learner.
    pub kind: BranchKind,
    /// Standardised mean squared error of the foundation on held-out trials.
    pub foundation: f64,
    /// The same with the correction.
    pub branch: f64,
    /// Standard error of the difference of the two; absent for a single trial.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standard_error: Option<f64>,
}

impl BranchChoice {
    /// Selection without any evaluation, for a reason.
    pub fn without_evaluation(reason: String) -> Self {
        Self { tried: Vec::new(), taken: None, checks: Vec::new(), reason }
    }
}

/// Extent of the search over kinds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum KindSearch {
    /// All kinds are evaluated.
    Every,
    /// Kinds are evaluated one after another, boosted trees first, which cost least, until one is
    /// worse by more than one standard error of the difference.
    WhilePromising {
        /// Longest step of the simulations, s.
        step_s: f64,
    },
}

impl KindSearch {
    fn step_s(self) -> f64 {
        match self {
            Self::Every => ReplaySettings::default().step_s,
            Self::WhilePromising { step_s } => step_s,
        }
    }

    /// Kinds in the order of evaluation.
    fn evaluation_order(self) -> [BranchKind; 4] {
        let [forest, boosted, kernels, perceptron] = BranchKind::ALL;
        match self {
            Self::Every => BranchKind::ALL,
            Self::WhilePromising { .. } => [boosted, forest, perceptron, kernels],
        }
    }
}

/// Evaluates kinds of learned corrections on held-out trials. The callback is called before each
/// kind and returns false to stop.
///
/// # Errors
/// Returns the errors of training and simulation; `Ok(None)` if it was stopped.
pub fn select_kind(
    model: &Model,
    on: &HeldOutTrials<'_>,
    (settings, kinds): (&BranchSettings, KindSearch),
    told: &dyn Fn(BranchKind) -> bool,
) -> Result<Option<BranchChoice>, TrainError> {
    let mut tried: Vec<(BranchKind, CorrectionEvaluation)> = Vec::new();
    for kind in kinds.evaluation_order() {
        if !told(kind) {
            return Ok(None);
        }
        let training = settings.with_kind(kind).complete_training(model, on.law, on.trials)?;
        let Some(judged) = evaluate_folds(on, &training, kinds.step_s())? else {
            let reason =
                "there is only one trial, so that cross-validation is not possible".to_owned();
            // The number of trials is the same for all kinds, so the first kind decides this.
            return Ok(Some(BranchChoice::without_evaluation(reason)));
        };
        // A short search ends at the first kind that is significantly worse than the foundation.
        let over = kinds != KindSearch::Every && judged.is_worse();
        tried.push((kind, judged));
        if over {
            break;
        }
    }
    Ok(Some(select_best(tried)))
}

/// Selection of the kind with the least error.
fn select_best(judged: Vec<(BranchKind, CorrectionEvaluation)>) -> BranchChoice {
    let best = judged.iter().min_by(|(_, a), (_, b)| a.branch.total_cmp(&b.branch));
    let reason =
        best.map_or_else(String::new, |(kind, best)| reason_text(*kind, best, judged.len()));
    // The best kind is only used if it is significantly better than the foundation.
    let taken = best.filter(|(_, judged)| judged.is_better()).map(|(kind, _)| *kind);
    let tried = |(kind, judged): &(BranchKind, CorrectionEvaluation)| KindEvaluation {
        kind: *kind,
        foundation: judged.foundation,
        branch: judged.branch,
        standard_error: judged.standard_error,
    };
    BranchChoice { tried: judged.iter().map(tried).collect(), taken, checks: Vec::new(), reason }
}

/// Sentence of the reason: kind, number of held-out trials, both errors and the standard error of
/// their difference.
fn reason_text(kind: BranchKind, judged: &CorrectionEvaluation, tried: usize) -> String {
    let CorrectionEvaluation { foundation, branch, trials, .. } = judged;
    let Some(standard_error) = judged.standard_error else {
        return format!(
            "`{}` was tested on one held-out trial, error {branch:.4} with it and {foundation:.4} \
             without: the uncertainty of the difference is unknown, and no correction is used",
            kind.name()
        );
    };
    let of = if tried > 1 { "is the best kind" } else { "was compared" };
    let said = format!(
        "`{}` {of}: on {} held-out trials, error {branch:.4} with it and {foundation:.4} without, \
         standard error of the difference {standard_error:.4}",
        kind.name(),
        trials.len()
    );
    match judged.is_better() {
        true => said,
        false if tried > 1 => {
            format!("{said}: the difference is not significant, and no correction is used")
        }
        false => format!("{said}: it is significantly worse, and no correction is used"),
    }
}
