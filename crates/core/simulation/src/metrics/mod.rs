//! Figures of a ship's manoeuvring, by their ITTC and IMO names.

mod imo;
mod measured;
mod pull_out;
mod spiral;
mod stopping;
mod turning;
mod zigzag;

pub use imo::{ImoCriterion, imo_criteria};
pub use measured::{ManoeuvreMetrics, ManoeuvreRecognition, recorded_track};
pub use pull_out::{PullOutMetrics, is_straight_line_stable};
pub use spiral::{SpiralMetrics, SpiralPoint, width_limit};
pub use stopping::{StoppingMetrics, TRACK_REACH_ALLOWED};
pub use turning::{TurningMetrics, initial_turning_distance};
pub use zigzag::ZigzagMetrics;
