//! Refinement of a source model against trials.

mod across;
mod alternatives;
mod blocks;
mod candidate;
mod cma_es;
mod constraints;
mod envelope;
mod equations;
mod errors;
mod estimator;
mod estimators;
mod family;
mod finish;
mod gathered;
mod manoeuvres;
mod measure;
mod merged;
mod mixture;
mod mixture_position;
mod outcome;
mod parts;
mod posterior;
mod problem;
mod progress;
mod published;
mod replayed_trials;
mod ridge;
mod ridge_candidates;
mod rows;
mod selection;
mod settings;
mod simulated;
mod steps;
mod thresholds;
mod trajectory;
mod unrecorded;
mod variant;
mod weak;
mod weighed;

pub use across::SourceEnvelopes;
pub use alternatives::{Alternative, alternatives};
pub use blocks::{Block, Blocks};
pub use cma_es::{CmaEs, SearchReport};
pub use constraints::{Bound, ConstraintError, Constraints, LimitError, StraightLine};
pub use family::Family;
pub use outcome::{
    CoefficientChange, HeldOut, Manoeuvres, MeasuredManoeuvre, RefineError, Refinement, StepOption,
};
pub use progress::{Iterate, MonotoneProgress, Progress, Watch};
pub use ridge::{Choices, Fit, Fitted, Fold, fit, tune};
pub use rows::{Table, trial_moments, trial_tables};
pub use selection::{Request, refine, refine_wanted, refine_watched, weigh};
pub use settings::{Method, Prior, Range, Settings};
pub use weak::{Windows, weak_moments, weak_tables};
pub use weighed::{Extent, Weighed};
