//! Ship's axes at the instant of a prediction: Kanazawa 2023, Eq. 4.1.

use sistership_simulation::state::{StateVector, at};

/// Axes ahead and to starboard, with origin at the ship.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShipAxes {
    origin: [f64; 2],
    psi_rad: f64,
}

impl ShipAxes {
    /// Creates the axes of a ship at a state.
    pub fn from_state(state: &StateVector) -> Self {
        Self { origin: [state[at::X], state[at::Y]], psi_rad: state[at::PSI] }
    }

    /// Position in the axes, ahead and to starboard, m.
    pub fn to_ship_axes(&self, north_m: f64, east_m: f64) -> [f64; 2] {
        let (sin, cos) = self.psi_rad.sin_cos();
        let (north, east) = (north_m - self.origin[0], east_m - self.origin[1]);
        [cos * north + sin * east, cos * east - sin * north]
    }

    /// Position north and east, m, of a position in the axes.
    pub fn to_north_east(&self, [ahead, aside]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.psi_rad.sin_cos();
        [self.origin[0] + cos * ahead - sin * aside, self.origin[1] + sin * ahead + cos * aside]
    }

    /// Heading relative to the ship's own, rad.
    pub fn relative_heading(&self, psi_rad: f64) -> f64 {
        psi_rad - self.psi_rad
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ship_heading_east_sees_east_ahead_and_south_to_starboard() {
        let mut state = StateVector::zeros();
        (state[at::X], state[at::Y]) = (10.0, -5.0);
        state[at::PSI] = std::f64::consts::FRAC_PI_2;
        let axes = ShipAxes::from_state(&state);
        let [ahead, aside] = axes.to_ship_axes(7.0, -1.0);
        assert!((ahead - 4.0).abs() < 1e-12 && (aside - 3.0).abs() < 1e-12, "{ahead} {aside}");
        let [north, east] = axes.to_north_east([ahead, aside]);
        assert!((north - 7.0).abs() < 1e-12 && (east + 1.0).abs() < 1e-12, "{north} {east}");
    }
}
