//! The figures by which a ship's manoeuvring is judged, by their ITTC and IMO names.

mod imo;
mod measured;
mod turning;
mod zigzag;

pub use imo::{Criterion, criteria};
pub use measured::{ManoeuvreMetrics, Recognised, recorded_track};
pub use turning::{TurningMetrics, initial_turning_distance};
pub use zigzag::ZigzagMetrics;
