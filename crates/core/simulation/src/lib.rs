//! Forward simulation: from a model and its inputs to the motion of the ship, and to the figures by
//! which its manoeuvring is assessed.

pub mod branch;
mod branch_share;
pub mod candidates;
mod covered_environment;
pub mod ensemble;
pub mod envelope;
pub mod equations;
pub mod error;
pub mod gear;
pub mod horizons;
pub mod instruments;
pub mod integrate;
pub mod interpolate;
mod lockstep;
pub mod manoeuvre;
pub mod metrics;
mod ordered_runs;
pub mod plant;
pub mod recorded;
pub mod sensitivity;
pub mod ship;
pub mod simd;
pub mod state;
pub mod tape;
pub mod validity;

pub use ensemble::ShipEnsemble;
pub use envelope::{MotionEnvelope, SimulationStop};
pub use equations::PlantError;
pub use integrate::Method;
pub use plant::Plant;
pub use ship::{HelmOrder, RunSettings, Ship};
pub use state::{StateVector, Trajectory};
