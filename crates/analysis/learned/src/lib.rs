//! Learned corrections: regressors trained on trials that add to the accelerations of a law of
//! motion.
//!
//! Training gives a correction and its weights; [`attach`] joins them to a model, which is then
//! simulated with its correction. The same foundation, trials, recipe and seed give the same bytes
//! (decision 20).

mod answer;
mod boosted;
mod choice;
mod dependence;
mod domain;
mod draws;
mod expressions;
mod forest;
mod formula;
mod gradient;
mod held_out;
pub mod horizon;
mod importance;
mod joined;
mod judge;
mod kernels;
mod learned;
mod perceptron;
pub mod recurrent;
mod regressor;
mod rows;
mod sample;
pub mod seakeeping;
mod settings;
mod train;
mod tree;
mod version;
mod weights;

pub use choice::{BranchCheck, BranchChoice, Kinds, TriedKind, choose};
pub use dependence::{InputDependence, LearnedDependence, dependence};
pub use domain::FadedDomain;
pub use held_out::{HeldOutFold, HeldOutTrials, corrected};
pub use importance::{Importance, importance};
pub use joined::{JoinError, attach, ship};
pub use judge::{JudgedTrial, Judgement, TrialError, judge, judge_folds};
pub use learned::Learned;
pub use regressor::Regressor;
pub use rows::{Row, RowsError, rows};
pub use sample::Sample;
pub use settings::{BranchKind, BranchSettings};
pub use train::{TrainError, Training, retrain, train};
pub use version::with_branch;
pub use weights::{Weights, WeightsError};
