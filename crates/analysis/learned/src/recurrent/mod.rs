//! Recurrent networks, trained on sequences of states, so that their memory is of the motion
//! before.
//!
//! They are not available as learned corrections yet: a simulation evaluates a correction at an
//! instant, without the past.

mod adam;
mod blame;
mod cell;
mod head;
mod loss;
mod motion;
mod network;
mod sail;
mod scales;
mod sequence;
mod simulated;
mod training;
mod windows;

pub(crate) use adam::Adam;
pub use cell::Cell;
pub use motion::Motion;
pub use network::{Memory, Recurrent, Shape};
pub use scales::Scales;
pub use sequence::{Loss, SequenceTraining};
pub use training::{Fit, fit};
