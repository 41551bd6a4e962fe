//! Refinement of a source model against trials.

mod alternatives;
mod blocks;
mod constraints;
mod family;
mod finish;
mod outcome;
mod parts;
mod posterior;
mod published;
mod rows;
mod selection;
mod settings;
mod trajectory;
mod variant;
mod weak;

pub(crate) use alternatives::{Alternative, alternatives};
pub use blocks::{Block, Blocks};
pub use constraints::{Bound, Constraints, StraightLine};
pub use family::Family;
pub use outcome::{CoefficientChange, HeldOut, Manoeuvres, MeasuredManoeuvre, RefineError, Refinement, StepOption};
pub use published::{Choices, Fit, Fitted, Fold, fit, tune};
pub use rows::{Table, trial_moments, trial_tables};
pub use selection::{Progress, Request, refine};
pub use settings::{Method, Range, Settings};
pub use weak::{Windows, weak_moments, weak_tables};
