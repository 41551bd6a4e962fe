//! Model selection: the search for the best model that a ship's trials allow, over sources, laws
//! and estimators.
//!
//! Every candidate (a source, or none, and the law to be fitted) is evaluated by one error on the
//! same held-out manoeuvres. Candidates pass the stages by successive halving. Of candidates that
//! are statistically tied, the one is preferred that depends least on single trials elsewhere; it
//! is refined by an explicit request with its source, law and method. If that gives no model that
//! completes the required manoeuvres, the next one is chosen.

mod branch;
mod choice;
mod correction;
mod entrant;
mod extremes;
mod foundation;
mod ladder;
mod population;
mod sailed;
mod scatter;
mod search;
mod start;
mod taken;
mod thresholds;
mod tried;

pub use choice::{chosen, standard_error};
pub use entrant::{Beside, Entrant, HeldBy, entrants};
pub use ladder::{Ladder, Line, Rung};
pub use population::population;
pub use search::{calibration_samples, search};
pub use start::{Asked, Start, best_start};
pub use taken::Winner;
pub use tried::Search;
