//! Refinement of a source model against trials.

mod across;
mod alternatives;
mod blocks;
mod cma_es;
mod constraints;
mod envelope;
mod family;
mod finish;
mod measure;
mod outcome;
mod parts;
mod posterior;
mod published;
mod rows;
mod selection;
mod settings;
mod simulated;
mod thinned;
mod trajectory;
mod variant;
mod weak;

pub(crate) use alternatives::{Alternative, alternatives};
pub use blocks::{Block, Blocks};
pub use cma_es::{CmaEs, SearchReport};
pub use constraints::{Bound, Constraints, StraightLine};
pub use family::Family;
pub use outcome::{CoefficientChange, HeldOut, Manoeuvres, MeasuredManoeuvre, RefineError, Refinement, StepOption};
pub use published::{Choices, Fit, Fitted, Fold, fit, tune};
pub use rows::{Table, trial_moments, trial_tables};
pub use selection::{Glimpse, Progress, Request, Watch, refine, refine_watched};
pub use settings::{Method, Range, Settings};
pub use weak::{Windows, weak_moments, weak_tables};
