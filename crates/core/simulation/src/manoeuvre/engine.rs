//! Order to the engine during a manoeuvre.

use crate::state::{StateVector, horizontal_speed};

/// Order that gives the revolutions of an approach, and the engine's loss at other speeds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct EngineOrder {
    /// Revolutions on the approach, 1/s.
    pub n_rps: f64,
    /// Approach speed, m/s.
    pub speed_m_s: f64,
    /// Share of the revolutions that is lost by the share of the speed that is lost.
    pub loss: f64,
}

impl EngineOrder {
    /// Revolutions in a state of motion, 1/s: `n_0 (1 - e (1 - U/U_0))`. A heavier propeller slows
    /// an engine of limited torque down; a ship that is faster than its approach does not race it.
    pub fn revolutions(&self, state: &StateVector) -> f64 {
        let lost = (1.0 - horizontal_speed(state) / self.speed_m_s).max(0.0);
        self.n_rps * (1.0 - self.loss * lost)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::straight_state;

    #[test]
    fn an_engine_loses_revolutions_with_speed() {
        let order = EngineOrder { n_rps: 2.0, speed_m_s: 8.0, loss: 0.5 };
        let at = |speed: f64| order.revolutions(&straight_state(speed));
        assert_eq!([at(8.0), at(4.0), at(10.0)], [2.0, 1.5, 2.0]);
        let governed = EngineOrder { loss: 0.0, ..order };
        assert_eq!(governed.revolutions(&straight_state(4.0)), 2.0);
    }
}
