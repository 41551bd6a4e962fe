//! Which kind of branch, if any: each is tried, and trials left out of its training decide.

use serde::{Deserialize, Serialize};
use sistership_model::Model;
use sistership_simulation::recorded::ReplaySettings;

use crate::held_out::HeldOutTrials;
use crate::judge::{Judgement, judge_folds};
use crate::settings::{BranchKind, BranchSettings};
use crate::train::TrainError;

/// What was tried, and what is taken.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BranchChoice {
    /// Every kind, in its order.
    pub tried: Vec<TriedKind>,
    /// The kind of least error, where that is better than the foundation's by more than one
    /// standard error of the difference; none where no branch should be taken.
    pub taken: Option<BranchKind>,
    /// What else was asked of that kind, until one thing was not met.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub checks: Vec<BranchCheck>,
    /// Why, in words.
    pub reason: String,
}

/// A comparison that a branch must pass before it is taken.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BranchCheck {
    /// What is compared.
    pub what: String,
    /// The foundation's figure.
    pub foundation: f64,
    /// That of the foundation with the branch, which may not be larger.
    pub branch: f64,
    /// Whether it is passed.
    pub passed: bool,
}

/// A kind that was tried.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TriedKind {
    /// The kind.
    pub kind: BranchKind,
    /// Standardised mean squared error of the foundation on trials left out.
    pub foundation: f64,
    /// The same with the branch.
    pub branch: f64,
    /// Standard error of the difference.
    pub standard_error: f64,
}

impl BranchChoice {
    /// Nothing was tried, for a reason.
    pub fn untried(reason: String) -> Self {
        Self { tried: Vec::new(), taken: None, checks: Vec::new(), reason }
    }
}

/// Which kinds are tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kinds {
    /// Every kind.
    Every,
    /// One after another, boosted trees first, which cost least, until one loses by more than one
    /// standard error of the difference.
    WhilePromising {
        /// Longest step of the simulations, s.
        step_s: f64,
    },
}

impl Kinds {
    fn step_s(self) -> f64 {
        match self {
            Self::Every => ReplaySettings::default().step_s,
            Self::WhilePromising { step_s } => step_s,
        }
    }

    fn in_order(self) -> [BranchKind; 4] {
        let [forest, boosted, kernels, perceptron] = BranchKind::ALL;
        match self {
            Self::Every => BranchKind::ALL,
            Self::WhilePromising { .. } => [boosted, forest, perceptron, kernels],
        }
    }
}

/// Tries kinds; `told` is asked before each whether to go on.
///
/// # Errors
/// As [`judge`](crate::judge()); none where it was stopped.
pub fn choose(
    model: &Model,
    on: &HeldOutTrials<'_>,
    (settings, kinds): (&BranchSettings, Kinds),
    told: &dyn Fn(BranchKind) -> bool,
) -> Result<Option<BranchChoice>, TrainError> {
    let mut tried: Vec<(BranchKind, Judgement)> = Vec::new();
    for kind in kinds.in_order() {
        if !told(kind) {
            return Ok(None);
        }
        let training = settings.of(kind).training(model, on.law, on.trials)?;
        let Some(judged) = judge_folds(on, &training, kinds.step_s())? else {
            let reason = "there is one trial only, and none is left to judge on".to_owned();
            return Ok(Some(BranchChoice::untried(reason)));
        };
        let over = kinds != Kinds::Every && judged.loses();
        tried.push((kind, judged));
        if over {
            break;
        }
    }
    Ok(Some(decided(tried)))
}

fn decided(judged: Vec<(BranchKind, Judgement)>) -> BranchChoice {
    let best = judged.iter().min_by(|(_, a), (_, b)| a.branch.total_cmp(&b.branch));
    let reason = best.map_or_else(String::new, |(kind, best)| because(*kind, best, judged.len()));
    let taken = best.filter(|(_, judged)| judged.wins()).map(|(kind, _)| *kind);
    let tried = |(kind, judged): &(BranchKind, Judgement)| TriedKind {
        kind: *kind,
        foundation: judged.foundation,
        branch: judged.branch,
        standard_error: judged.standard_error,
    };
    BranchChoice { tried: judged.iter().map(tried).collect(), taken, checks: Vec::new(), reason }
}

/// `kernels` leaves 0.21 of 0.24 on trials left out, with a standard error of 0.05: no win
fn because(kind: BranchKind, judged: &Judgement, tried: usize) -> String {
    let Judgement { foundation, branch, standard_error, trials, .. } = judged;
    let of = if tried > 1 { "is the best of the kinds" } else { "was tried" };
    let said = format!(
        "`{}` {of}: on {} trials left out, error {branch:.4} with it and \
         {foundation:.4} without, the difference sure to {standard_error:.4}",
        kind.name(),
        trials.len()
    );
    match judged.wins() {
        true => said,
        false if tried > 1 => {
            format!("{said}: it does not win by more than that, and no branch is taken")
        }
        false => format!("{said}: it loses by more than that, and no branch is taken"),
    }
}
