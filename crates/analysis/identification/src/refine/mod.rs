//! Refinement of a source model against trials.

mod across;
mod alternatives;
mod blocks;
mod candidate;
mod cma_es;
mod envelope;
mod equations;
mod errors;
mod estimator;
mod estimators;
mod evaluation;
mod family;
mod finish;
mod fold_variance;
mod longer_restarts;
mod manoeuvres;
mod measure;
mod misfit;
mod mixture;
mod mixture_position;
mod outcome;
mod parts;
mod population;
mod posterior;
mod problem;
mod progress;
mod published;
mod range_check;
mod refinement_result;
mod replayed_trials;
mod request;
mod ridge;
mod ridge_candidates;
mod rows;
mod rudder_orders;
mod selection;
mod settings;
mod settings_check;
mod simulated;
mod smoothing;
mod starting_point;
mod steps;
mod thresholds;
mod trajectory;
mod unrecorded;
mod variant;
mod weak;

pub use crate::constraints::{Bound, ConstraintError, Constraints, LimitError, StraightLine};
pub use across::SourceEnvelopes;
pub use alternatives::{AlternativeFit, alternative_fits};
pub use blocks::{RegressionBlock, RegressionBlocks};
pub use cma_es::{CmaEs, SearchReport};
pub use evaluation::{CandidateEvaluation, FoldModel, RefinementExtent};
pub use family::TermFamily;
pub use outcome::{
    CoefficientChange, HeldOut, MeasuredManoeuvre, RefineError, Refinement, RefinementManoeuvres,
    StepOption,
};
pub use population::PopulationShip;
pub use progress::{FitIterate, IterateObserver, MonotoneProgress, Progress};
pub use replayed_trials::ReplayedTrials;
pub use request::RefinementSpec;
pub use ridge::{
    CoefficientFit, FittedCoefficient, RegressionFold, RidgeChoices, fit_regressions, tune_choices,
};
pub use rows::{RegressionTable, trial_moments, trial_tables};
pub use rudder_orders::{RecordStart, RudderOrder, rudder_record, rudder_records};
pub use selection::{evaluate_candidates, fit_model, refine, refine_if_wanted, refine_watched};
pub use settings::{EstimationMethod, Prior, RefinementSettings, TRIALS_ALONE, TuningRange};
pub use settings_check::SettingFault;
pub use weak::{WindowSpacing, weak_moments, weak_tables};
