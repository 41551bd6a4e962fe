//! Settings of the training of a learned correction, with their defaults.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sistership_model::branch::{
    CorrectionError, CorrectionMode, CorrectionRecipe, Learner, MAX_FADE, Signal,
};
use sistership_model::coefficient::Axis;
use sistership_model::trial::Trial;
use sistership_model::{Law, Model};
use sistership_simulation::{PlantError, Ship};

use crate::train::CorrectionTraining;

/// Kind of learner, with default settings that suit small data sets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BranchKind {
    /// Random forest.
    Forest,
    /// Boosted trees.
    Boosted,
    /// Kernel ridge, the mean of a Gaussian process.
    Kernels,
    /// Multilayer perceptron.
    Perceptron,
}

/// Settings of a learned correction. Defaults follow from the foundation and the trials.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BranchSettings {
    /// Kind of learner. By default, every kind is evaluated on held-out trials, and one is used if
    /// it is better than the foundation by more than its uncertainty.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kind: Option<BranchKind>,
    /// Way in which the correction is combined with the foundation; default `parallel`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mode: Option<CorrectionMode>,
    /// All settings of the learner, in place of `kind`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub learner: Option<Learner>,
    /// Seed of the random numbers; default 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// Length of the window over which accelerations are averaged, s. Default: half of the time in
    /// which the ship travels its length at its approach speed, at least four sampling intervals.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub window_s: Option<f64>,
    /// Time from one training sample to the next, s. Default: an eighth of the window.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub hop_s: Option<f64>,
    /// Distance outside the range covered by trials at which the correction reaches zero, in half
    /// ranges; default 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(max = 3), extend("exclusiveMinimum" = 0))]
    pub fade: Option<f64>,
}

/// Window, relative to the time in which a ship travels its length (docs/evidence/branches.md,
/// RM-RF).
const WINDOW: f64 = 0.5;
/// Fewest sampling intervals in a window.
const INTERVALS: f64 = 4.0;
/// Number of training samples per window.
const HOPS: f64 = 8.0;

impl BranchKind {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::Forest, Self::Boosted, Self::Kernels, Self::Perceptron];

    /// Name of the kind in files and requests.
    pub fn name(self) -> &'static str {
        match self {
            Self::Forest => "forest",
            Self::Boosted => "boosted",
            Self::Kernels => "kernels",
            Self::Perceptron => "perceptron",
        }
    }

    /// Default settings of the learner: those that docs/evidence/branches.md was measured with.
    pub fn default_learner(self) -> Learner {
        match self {
            Self::Forest => Learner::RandomForest { trees: 50, tried: 2, leaf: 20, depth: 12 },
            Self::Boosted => {
                Learner::BoostedTrees { trees: 100, leaf: 40, depth: 4, rate: 0.05, sampled: 0.5 }
            }
            Self::Kernels => Learner::KernelRidge { centres: 200, length: 3.0, ridge: 1.0 },
            Self::Perceptron => Learner::Perceptron {
                hidden: vec![16, 16],
                epochs: 30,
                batch: 64,
                rate: 0.005,
                decay: 0.01,
            },
        }
    }
}

impl BranchSettings {
    /// Checks the numbers.
    ///
    /// # Errors
    /// Returns the name of the invalid field, and the values that it may have.
    pub fn check(&self) -> Result<(), (String, String)> {
        // The checks of a recipe apply here, too; settings that are still open get valid
        // placeholders.
        let recipe = CorrectionRecipe {
            learner: self.chosen_learner(),
            seed: self.seed_or_default(),
            window_s: self.window_s.unwrap_or(1.0),
            hop_s: self.hop_s.unwrap_or(1.0),
            trials: Vec::new(),
        };
        match recipe.check_settings() {
            Err(CorrectionError::Recipe { field, reason }) => {
                return Err((field.to_owned(), reason.to_owned()));
            }
            other => other.map_err(|error| ("recipe".to_owned(), error.to_string()))?,
        }
        if self.kind.is_some() && self.learner.is_some() {
            return Err(("learner".to_owned(), "give it in place of `kind`".to_owned()));
        }
        match self.fade {
            Some(fade) if !(fade > 0.0 && fade <= MAX_FADE) => {
                Err(("fade".to_owned(), format!("should be above 0 and at most {MAX_FADE}")))
            }
            _ => Ok(()),
        }
    }

    /// True if neither a kind nor a learner is set.
    pub fn is_open(&self) -> bool {
        self.kind.is_none() && self.learner.is_none()
    }

    /// Returns the same settings with this kind.
    pub fn with_kind(&self, kind: BranchKind) -> Self {
        Self { kind: Some(kind), ..self.clone() }
    }

    /// Learner; kernel ridge, the baseline for small data sets, by default.
    fn chosen_learner(&self) -> Learner {
        let kind = self.kind.unwrap_or(BranchKind::Kernels);
        self.learner.clone().unwrap_or_else(|| kind.default_learner())
    }

    fn seed_or_default(&self) -> u64 {
        self.seed.unwrap_or(1)
    }

    /// Completes the settings for a foundation and its trials.
    ///
    /// # Errors
    /// Returns an error if the foundation cannot be simulated.
    pub fn complete_training(
        &self,
        model: &Model,
        law: &Law,
        trials: &[&Trial],
    ) -> Result<CorrectionTraining, PlantError> {
        let ship = Ship::new(&model.without_correction(), law)?;
        let mode = self.mode.unwrap_or(CorrectionMode::Parallel);
        // The window must hold several samples of the coarsest trial.
        let coarsest_s = trials.iter().map(|trial| trial.interval_s()).fold(0.0, f64::max);
        let length_s = ship.lpp_m() / ship.approach_speed_m_s();
        let window_s =
            self.window_s.unwrap_or_else(|| (WINDOW * length_s).max(INTERVALS * coarsest_s));
        Ok(CorrectionTraining {
            mode,
            inputs: available_inputs(&ship, mode),
            learner: self.chosen_learner(),
            seed: self.seed_or_default(),
            window_s,
            hop_s: self.hop_s.unwrap_or(window_s / HOPS),
            fade: self.fade.unwrap_or(1.0),
        })
    }
}

/// All signals that a correction can use, for each of the three accelerations.
fn available_inputs(ship: &Ship, mode: CorrectionMode) -> Vec<(Axis, Vec<Signal>)> {
    let mut signals = vec![Signal::U, Signal::V, Signal::R];
    signals.extend(ship.has_rudder().then_some(Signal::Delta));
    signals.extend(ship.has_propeller().then_some(Signal::N));
    // Only a serial correction uses the law's accelerations as inputs.
    if mode == CorrectionMode::Serial {
        signals.extend([Signal::UDot, Signal::VDot, Signal::RDot]);
    }
    [Axis::X, Axis::Y, Axis::N].map(|axis| (axis, signals.clone())).to_vec()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::Zoo;

    #[test]
    fn what_is_not_asked_is_settled_by_ship_and_trials() {
        let zoo = Zoo::load_embedded().unwrap();
        let model = zoo.find_model("mariner").unwrap();
        let trial = Trial { t_s: vec![0.0, 5.0, 10.0], ..Trial::default() };
        let of = |settings: BranchSettings, trials: &[&Trial]| {
            settings.complete_training(&model, zoo.law("abkowitz").unwrap(), trials).unwrap()
        };
        let settled = of(BranchSettings::default(), &[]);
        // 160.93 m at 7.72 m/s.
        assert!((settled.window_s - 10.4).abs() < 0.1, "{settled:?}");
        assert_eq!(settled.window_s / settled.hop_s, 8.0);
        assert_eq!(settled.inputs[2].1, [Signal::U, Signal::V, Signal::R, Signal::Delta]);
        assert_eq!(of(BranchSettings::default(), &[&trial]).window_s, 20.0);
        let serial = BranchSettings { mode: Some(CorrectionMode::Serial), ..Default::default() };
        assert!(of(serial, &[]).inputs[0].1.contains(&Signal::RDot));
    }

    #[test]
    fn numbers_out_of_range_are_refused_by_field() {
        let field = |settings: BranchSettings| settings.check().unwrap_err().0;
        let default = BranchSettings::default;
        assert_eq!(field(BranchSettings { fade: Some(9.0), ..default() }), "fade");
        assert_eq!(field(BranchSettings { window_s: Some(0.0), ..default() }), "window_s");
        assert_eq!(field(BranchSettings { hop_s: Some(f64::NAN), ..default() }), "hop_s");
        let learner = Some(Learner::KernelRidge { centres: 0, length: 1.0, ridge: 1.0 });
        assert_eq!(field(BranchSettings { learner, ..default() }), "learner.centres");
        for kind in BranchKind::ALL {
            assert_eq!(default().with_kind(kind).check(), Ok(()));
        }
    }
}
