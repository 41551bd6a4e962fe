//! Integration of the equations of motion by one step.

use serde::{Deserialize, Serialize};

use crate::state::StateVector;

/// An integration method.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// The classical Runge-Kutta method of fourth order.
    #[default]
    Rk4,
    /// The explicit Euler method.
    Euler,
}

impl Method {
    /// The state one step later; `rate(fraction, state)` is the rate of change at that fraction of the step.
    pub fn step(self, state: &StateVector, step_s: f64, mut rate: impl FnMut(f64, &StateVector) -> StateVector) -> StateVector {
        match self {
            Self::Euler => state + rate(0.0, state) * step_s,
            Self::Rk4 => {
                let k1 = rate(0.0, state);
                let k2 = rate(0.5, &(state + k1 * (0.5 * step_s)));
                let k3 = rate(0.5, &(state + k2 * (0.5 * step_s)));
                let k4 = rate(1.0, &(state + k3 * step_s));
                state + (k1 + (k2 + k3) * 2.0 + k4) * (step_s / 6.0)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Error of one revolution of a circle in n steps.
    fn circle_error(method: Method, steps: usize) -> f64 {
        let h = std::f64::consts::TAU / steps as f64;
        let mut state = StateVector::zeros();
        state[0] = 1.0;
        let rate = |_: f64, s: &StateVector| {
            let mut rate = StateVector::zeros();
            (rate[0], rate[1]) = (-s[1], s[0]);
            rate
        };
        (0..steps).for_each(|_| state = method.step(&state, h, rate));
        (state[0] - 1.0).hypot(state[1])
    }

    #[test]
    fn orders_of_accuracy() {
        let order = |method| (circle_error(method, 100) / circle_error(method, 200)).log2();
        assert!((order(Method::Rk4) - 4.0).abs() < 0.1);
        assert!((order(Method::Euler) - 1.0).abs() < 0.1);
    }
}
