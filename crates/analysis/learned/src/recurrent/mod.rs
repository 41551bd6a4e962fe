//! Recurrent networks, trained on sequences of states, so that their memory is of the motion
//! before.
//!
//! They are not available as learned corrections yet: a simulation evaluates a correction at an
//! instant, without the past.

mod adam;
mod cell;
mod error;
mod head;
mod loss;
mod loss_gradient;
mod motion;
mod network;
mod scales;
mod sequence;
mod simulate;
mod simulated_motion;
mod training;
mod windows;

pub(crate) use adam::AdamOptimizer;
pub use cell::RecurrentCell;
pub use error::SequenceError;
pub use motion::RecordedMotion;
pub use network::{NetworkMemory, NetworkShape, RecurrentNetwork};
pub use scales::MotionScales;
pub use sequence::{LossKind, SequenceTraining};
pub use training::{TrainedNetwork, train_network};
