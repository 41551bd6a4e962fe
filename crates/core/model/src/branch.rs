//! A learned branch: what a model has learned beside its law of motion, in the modes of Kanazawa
//! 2023, Sec. 2.1. The document names its weights by hash; `sistership-learned` has the weights,
//! trains them and evaluates them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::coefficient::Axis;
use crate::learned::Attached;
use crate::validity::{RangeError, Region};

/// A learned branch of a model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Branch {
    /// How it is joined to the law of motion, its foundation.
    pub mode: BranchMode,
    /// The accelerations that it changes, each once.
    pub outputs: Vec<BranchOutput>,
    /// The SHA-256 of its weights.
    pub weights_sha256: String,
    /// The motion that its training covered.
    pub domain: Region,
    /// How far beyond the domain its share has faded to nothing, by half the range covered.
    pub fade: f64,
    /// How it was trained.
    pub recipe: BranchRecipe,
    /// Its weights, where they have been attached; not part of the document.
    #[serde(skip)]
    #[schemars(skip)]
    pub learned: Attached,
}

/// How a branch is joined to its foundation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BranchMode {
    /// It gives the accelerations, and knows nothing of the foundation: Eq. 2.5.
    Convert,
    /// It gives the accelerations, and takes the foundation's among its inputs: Eq. 2.6.
    Serial,
    /// It gives what is to be added to the foundation's accelerations: Eq. 2.8.
    Parallel,
}

/// An acceleration that a branch changes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BranchOutput {
    /// The axis: X, Y or N.
    pub axis: Axis,
    /// What it is told from, in the order of the weights.
    pub inputs: Vec<BranchInput>,
    /// What one of the weights' answer stands for, m/s2 (rad/s2).
    pub scale: f64,
    /// Least and greatest value that its training held, m/s2 (rad/s2): it never gives another.
    pub range: [f64; 2],
}

/// An input of a branch: `(value - centre) / scale` is what the weights take.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BranchInput {
    /// What it is.
    pub signal: Signal,
    /// Its mean over the training, SI and radians.
    pub centre: f64,
    /// Its deviation over the training, SI and radians.
    pub scale: f64,
}

/// What a branch can be told from.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum Signal {
    /// Surge velocity, m/s.
    U,
    /// Sway velocity, m/s.
    V,
    /// Yaw rate, rad/s.
    R,
    /// Rudder angle, rad.
    Delta,
    /// Propeller revolutions, 1/s.
    N,
    /// Drift angle `atan2(-v, u)`, rad.
    Beta,
    /// The foundation's surge acceleration, m/s2.
    UDot,
    /// The foundation's sway acceleration, m/s2.
    VDot,
    /// The foundation's yaw acceleration, rad/s2.
    RDot,
}

impl Signal {
    /// Whether it is of the foundation.
    pub fn is_of_foundation(self) -> bool {
        matches!(self, Self::UDot | Self::VDot | Self::RDot)
    }
}

/// How a branch was trained: with the foundation and the trials' samples, everything that its bytes
/// depend on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BranchRecipe {
    /// What learns, with its settings.
    pub learner: Learner,
    /// Of every random number drawn.
    pub seed: u64,
    /// Time over which accelerations are taken, s.
    pub window_s: f64,
    /// From one sample of the training to the next, s.
    pub hop_s: f64,
    /// Names of the trials.
    pub trials: Vec<String>,
}

/// What learns.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Learner {
    /// The mean of trees grown on bootstrapped samples (Breiman 2001; Mei 2019, Table 1).
    RandomForest {
        /// How many trees.
        trees: usize,
        /// How many inputs are tried at each split.
        tried: usize,
        /// Fewest samples in a leaf.
        leaf: usize,
        /// Most splits from root to leaf.
        depth: usize,
    },
    /// The sum of small trees, each grown on what those before it leave (Friedman 2002).
    BoostedTrees {
        /// How many trees.
        trees: usize,
        /// Fewest samples in a leaf.
        leaf: usize,
        /// Most splits from root to leaf.
        depth: usize,
        /// What a tree counts for.
        rate: f64,
        /// Share of the samples, drawn without replacement, on which a tree grows.
        sampled: f64,
    },
    /// Ridge regression on rational quadratic kernels about some of the samples: the mean of a
    /// Gaussian process by a subset of regressors (Rasmussen and Williams 2006, Eqs. 4.19, 8.14).
    KernelRidge {
        /// How many samples.
        centres: usize,
        /// Length scale, in deviations of the inputs.
        length: f64,
        /// Variance of the noise by that of the process.
        ridge: f64,
    },
    /// A multilayer perceptron, trained by Adam (Kingma and Ba 2015) on squared errors.
    Perceptron {
        /// Neurons of each hidden layer.
        hidden: Vec<usize>,
        /// How often every sample is seen.
        epochs: usize,
        /// Samples to a step.
        batch: usize,
        /// Length of the first steps; it falls linearly to nothing.
        rate: f64,
        /// Decay of the weights.
        decay: f64,
    },
}

impl Learner {
    /// What it is called.
    pub fn name(&self) -> &'static str {
        match self {
            Self::RandomForest { .. } => "random forest",
            Self::BoostedTrees { .. } => "boosted trees",
            Self::KernelRidge { .. } => "kernel ridge",
            Self::Perceptron { .. } => "perceptron",
        }
    }
}

impl BranchMode {
    /// Every mode.
    pub const ALL: [Self; 3] = [Self::Convert, Self::Serial, Self::Parallel];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Convert => "convert",
            Self::Serial => "serial",
            Self::Parallel => "parallel",
        }
    }
}

impl Branch {
    /// What it is, in words: `random forest, parallel`.
    pub fn words(&self) -> String {
        format!("{}, {}", self.recipe.learner.name(), self.mode.name())
    }
}

/// Why a branch cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BranchError {
    /// The outputs are not one to three different axes among X, Y and N.
    #[error("outputs: give each of the axes X, Y and N at most once, and one at least")]
    Outputs,
    /// An input cannot be used so.
    #[error("outputs.{axis}.inputs: {reason}")]
    Input {
        /// The output's axis.
        axis: Axis,
        /// What is wrong.
        reason: &'static str,
    },
    /// A scale or range is not what it should be.
    #[error("outputs.{0}: scale should be above 0, and range from a number to one not less")]
    Scale(Axis),
    /// The hash is none.
    #[error("weights_sha256: should be 64 hexadecimal digits")]
    Hash,
    /// It does not fade.
    #[error("fade: {0} should be above 0 and at most {MOST_FADE}")]
    Fade(f64),
    /// The domain bounds too little.
    #[error("domain: should have ranges of u, v and r")]
    Domain,
    /// The domain's bounds are not in order.
    #[error("domain.{0}")]
    Range(#[from] RangeError),
    /// A setting of the training.
    #[error("recipe.{field}: {reason}")]
    Recipe {
        /// The setting.
        field: &'static str,
        /// What it should be.
        reason: &'static str,
    },
}

/// Most half ranges over which a branch may fade; what bounds it in a simulation is that the faded
/// region lies in the physical range (`sistership-learned`).
pub const MOST_FADE: f64 = 3.0;

impl Branch {
    /// Checks that its parts go together.
    ///
    /// # Errors
    /// Names the field at fault.
    pub fn check(&self) -> Result<(), BranchError> {
        let axes = [Axis::X, Axis::Y, Axis::N];
        let of = |axis: Axis| self.outputs.iter().filter(|output| output.axis == axis).count();
        let known: usize = axes.iter().map(|axis| of(*axis)).sum();
        if self.outputs.is_empty()
            || known != self.outputs.len()
            || axes.iter().any(|axis| of(*axis) > 1)
        {
            return Err(BranchError::Outputs);
        }
        self.outputs.iter().try_for_each(|output| output.check(self.mode))?;
        let is_hex = self.weights_sha256.bytes().all(|byte| byte.is_ascii_hexdigit());
        if self.weights_sha256.len() != 64 || !is_hex {
            return Err(BranchError::Hash);
        }
        if !(self.fade > 0.0 && self.fade <= MOST_FADE) {
            return Err(BranchError::Fade(self.fade));
        }
        if ["u", "v", "r"].iter().any(|name| !self.domain.ranges.contains_key(*name)) {
            return Err(BranchError::Domain);
        }
        self.domain.check()?;
        self.recipe.check()
    }
}

impl BranchOutput {
    fn check(&self, mode: BranchMode) -> Result<(), BranchError> {
        let refuse = |reason| Err(BranchError::Input { axis: self.axis, reason });
        if self.inputs.is_empty() {
            return refuse("give one at least");
        }
        let positive = |x: f64| x > 0.0 && x.is_finite();
        if self.inputs.iter().any(|input| !input.centre.is_finite() || !positive(input.scale)) {
            return refuse("centre should be a number and scale above 0");
        }
        let of_foundation = |input: &BranchInput| input.signal.is_of_foundation();
        if mode == BranchMode::Convert && self.inputs.iter().any(of_foundation) {
            return refuse("in mode `convert` none may be of the foundation");
        }
        if mode == BranchMode::Serial && !self.inputs.iter().any(of_foundation) {
            return refuse("in mode `serial` one should be of the foundation");
        }
        let [low, high] = self.range;
        if !(positive(self.scale) && low.is_finite() && high.is_finite() && low <= high) {
            return Err(BranchError::Scale(self.axis));
        }
        Ok(())
    }
}

impl BranchRecipe {
    /// Checks the settings.
    ///
    /// # Errors
    /// Names the first that is out of range.
    pub fn check(&self) -> Result<(), BranchError> {
        let refuse = |field, reason| Err(BranchError::Recipe { field, reason });
        if !(self.window_s > 0.0 && self.window_s.is_finite()) {
            return refuse("window_s", "should be above 0 s");
        }
        if !(self.hop_s > 0.0 && self.hop_s.is_finite()) {
            return refuse("hop_s", "should be above 0 s");
        }
        self.learner.check().map_or(Ok(()), |(field, reason)| refuse(field, reason))
    }
}

impl Learner {
    /// The setting that is out of range, and what it should be.
    fn check(&self) -> Option<(&'static str, &'static str)> {
        let few = |n: usize, most: usize| (1..=most).contains(&n);
        let share = |x: f64| x > 0.0 && x <= 1.0;
        let wrong = match self {
            Self::RandomForest { trees, tried, leaf, depth } => [
                (few(*trees, 1000), "learner.trees", "should be from 1 to 1000"),
                (few(*leaf, 1 << 20), "learner.leaf", "should be at least 1"),
                (few(*depth, 30), "learner.depth", "should be from 1 to 30"),
                (few(*tried, 16), "learner.tried", "should be from 1 to 16"),
            ],
            Self::BoostedTrees { trees, leaf, depth, rate, sampled } => [
                (few(*trees, 1000), "learner.trees", "should be from 1 to 1000"),
                (few(*leaf, 1 << 20), "learner.leaf", "should be at least 1"),
                (few(*depth, 30), "learner.depth", "should be from 1 to 30"),
                (share(*rate) && share(*sampled), "learner.rate", "rate, sampled: up to 1"),
            ],
            Self::KernelRidge { centres, length, ridge } => [
                (few(*centres, 2000), "learner.centres", "should be from 1 to 2000"),
                (*length > 0.0 && length.is_finite(), "learner.length", "should be above 0"),
                (*ridge > 0.0 && ridge.is_finite(), "learner.ridge", "should be above 0"),
                (true, "", ""),
            ],
            Self::Perceptron { hidden, epochs, batch, rate, decay } => [
                (
                    few(hidden.len(), 4) && hidden.iter().all(|width| few(*width, 256)),
                    "learner.hidden",
                    "give one to four layers of 1 to 256 neurons",
                ),
                (few(*epochs, 10_000), "learner.epochs", "should be from 1 to 10000"),
                (few(*batch, 1 << 16), "learner.batch", "should be from 1 to 65536"),
                (share(*rate) && (0.0..=1.0).contains(decay), "learner.rate", "up to 1"),
            ],
        };
        wrong.into_iter().find(|(holds, ..)| !holds).map(|(_, field, reason)| (field, reason))
    }
}
