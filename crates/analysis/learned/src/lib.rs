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
mod setting_error;
mod settings;
mod train;
mod tree;
mod version;
mod weights;

pub use choice::{BranchCheck, BranchChoice, KindEvaluation, KindSearch, select_kind};
pub use dependence::{InputDependence, LearnedDependence, learn_dependence};
pub use domain::FadedDomain;
pub use held_out::{HeldOutFold, HeldOutTrials, train_corrected_model};
pub use importance::{InputImportance, permutation_importance};
pub use joined::{JoinError, attach, corrected_ship};
pub use judge::{
    CorrectionEvaluation, TrialError, TrialEvaluation, evaluate_folds, evaluate_training,
};
pub use learned::LearnedCorrection;
pub use regressor::OutputRegressor;
pub use rows::{RowsError, WindowRow, window_rows};
pub use sample::TrainingSample;
pub use setting_error::SettingError;
pub use settings::{BranchKind, BranchSettings};
pub use train::{CorrectionTraining, TrainError, retrain_correction, train_correction};
pub use version::with_branch;
pub use weights::{CorrectionWeights, WeightsError};
