//! A ship whose rudder stalls: what no smooth law of the angle says.

use sistership_simulation::state::{StateVector, at};

use super::dimensions::Dimensions;
use super::motion::{Inertia, Truth};

/// Angle at which the flow leaves the blade, rad; chosen among the 15 to 25 deg of profiles of
/// common thickness.
const STALL_RAD: f64 = 17.0 * std::f64::consts::PI / 180.0;
/// Range over which it does, rad.
const RANGE_RAD: f64 = 3.0 * std::f64::consts::PI / 180.0;
/// Share of the angle that acts then; chosen.
const LEFT: f64 = 0.5;

/// A ship with such a rudder.
pub struct Stalled<T>(pub T);

/// The angle at which a rudder without stall would do as much.
fn acting(angle_rad: f64) -> f64 {
    let beyond = ((angle_rad.abs() - STALL_RAD) / RANGE_RAD).clamp(0.0, 1.0);
    angle_rad * (1.0 - (1.0 - LEFT) * beyond)
}

impl<T: Truth> Truth for Stalled<T> {
    fn dimensions(&self) -> &Dimensions {
        self.0.dimensions()
    }

    fn accelerations(&self, state: &StateVector, n_rps: f64) -> [f64; 4] {
        let mut acted = *state;
        acted[at::DELTA] = acting(state[at::DELTA]);
        self.0.accelerations(&acted, n_rps)
    }

    fn inertia(&self) -> &Inertia {
        self.0.inertia()
    }

    fn revolutions_rps(&self) -> f64 {
        self.0.revolutions_rps()
    }

    fn rudder_rate_rad_s(&self) -> f64 {
        self.0.rudder_rate_rad_s()
    }
}
