//! What Table 5 tells of a turning circle.

use sistership_simulation::StateVector;
use sistership_simulation::state::{at, horizontal_speed};

/// The four rows of a turn, or the errors in them (%).
#[derive(Debug, Clone, Copy)]
pub struct Metrics(pub [f64; 4]);

/// Steady turning radius, maximum transfer, maximum advance, velocity loss on steady turn.
pub const NAMES: [&str; 4] = ["STR", "MT", "MA", "VLS"];
/// Place of the radius.
pub const RADIUS: usize = 0;
/// Place of the speed loss.
pub const SPEED_LOSS: usize = 3;

impl Metrics {
    /// Of a turn from the start of its prediction. Distances are counted from there but along the
    /// first course, which is what reproduces the paper's; the product's metrics, as the ITTC's,
    /// start at the execution of the rudder.
    pub fn of(states: &[StateVector]) -> Self {
        let (first, last) = (&states[0], &states[states.len() - 1]);
        let farthest = |index: usize| {
            states.iter().map(|state| (state[index] - first[index]).abs()).fold(0.0, f64::max)
        };
        let advance = states.iter().map(|state| state[at::X] - first[at::X]).fold(0.0, f64::max);
        Self([
            horizontal_speed(last) / last[at::R].abs(),
            farthest(at::Y),
            advance,
            horizontal_speed(first) - horizontal_speed(last),
        ])
    }

    /// Errors of a prediction against this truth, % (Eq. 23).
    pub fn errors(&self, predicted: &Self) -> Self {
        Self(std::array::from_fn(|i| 100.0 * ((self.0[i] - predicted.0[i]) / self.0[i]).abs()))
    }

    /// The mean over predictions (Eq. 24).
    pub fn mean(all: &[Self]) -> Self {
        Self(std::array::from_fn(|i| {
            all.iter().map(|metrics| metrics.0[i]).sum::<f64>() / all.len() as f64
        }))
    }
}
