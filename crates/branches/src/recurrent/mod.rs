//! Recurrent networks, trained on sequences of states: what they remember is of the motion before.
//!
//! They are no kind of branch yet: a simulation asks a branch of an instant, not of its past.

mod adam;
mod cell;
mod head;
mod motion;
mod network;
mod training;

pub use cell::Cell;
pub use motion::Motion;
pub use network::{Memory, Recurrent, Shape};
pub use training::{Fit, Loss, Scales, SequenceTraining, fit};
