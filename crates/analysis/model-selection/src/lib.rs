//! The search for the best model that a ship's trials allow, over sources, laws and estimators.
//!
//! Every entrant (a source, or none, and the law to be fitted) is weighed by one error on the same
//! manoeuvres left out. Entrants climb by successive halving ([`search`]). Of what is alike
//! [`chosen`] takes what single trials move least elsewhere; it is refined as if a person had named
//! its source, law and method, and where no model comes of that which sails, the next is taken.

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
