//! The search for the best model that a ship's trials allow, over sources, laws and estimators.
//!
//! Every entrant (a source, or none, and the law to be fitted) is weighed by one error on the same
//! manoeuvres left out. Entrants climb by successive halving ([`search`]); [`chosen`] takes the
//! simplest from which none is told apart. The winner is refined as if a person had named its
//! source, law and method.

mod choice;
mod entrant;
mod ladder;
mod search;
mod start;
mod thresholds;

pub use choice::{chosen, standard_error};
pub use entrant::{Entrant, entrants};
pub use ladder::{Ladder, Line, Rung};
pub use search::{Search, Winner, search};
pub use start::{Asked, Start, best_start};
