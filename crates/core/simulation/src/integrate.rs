//! One-step integration of the equations of motion.

use serde::{Deserialize, Serialize};

use crate::state::{LaneStates, StateVector};
use crate::tape::LaneValues;

/// An integration method.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "IntegrationMethod")]
pub enum Method {
    /// The classical Runge-Kutta method of fourth order.
    #[default]
    Rk4,
    /// The explicit Euler method.
    Euler,
}

impl Method {
    /// Returns the state one step later; `rate(fraction, state)` is the rate of change at that
    /// fraction of the step.
    pub fn advance_state(
        self,
        state: &StateVector,
        step_s: f64,
        mut rate: impl FnMut(f64, &StateVector) -> StateVector,
    ) -> StateVector {
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

impl Method {
    /// Advances ships in lockstep as [`Method::step`] does, each with its own step length; the
    /// rounding is the same.
    pub fn advance_states<const N: usize>(
        self,
        states: &LaneStates<N>,
        steps_s: &LaneValues<N>,
        mut rates: impl FnMut(StepStage, &LaneStates<N>) -> LaneStates<N>,
    ) -> LaneStates<N> {
        let first = rates(StepStage::Start, states);
        if self == Self::Euler {
            return move_states(states, &first, steps_s);
        }
        // Stages at 0, h/2, h/2 and h.
        let half = steps_s.map(|step_s| 0.5 * step_s);
        let second = rates(StepStage::Middle, &move_states(states, &first, &half));
        let third = rates(StepStage::Middle, &move_states(states, &second, &half));
        let fourth = rates(StepStage::End, &move_states(states, &third, steps_s));
        // The order of additions is that of `step`, so that both round alike.
        let mut slope = first;
        for (place, slope) in slope.iter_mut().enumerate() {
            for lane in 0..N {
                slope[lane] = slope[lane]
                    + (second[place][lane] + third[place][lane]) * 2.0
                    + fourth[place][lane];
            }
        }
        move_states(states, &slope, &steps_s.map(|step_s| step_s / 6.0))
    }
}

/// Point of a step at which a rate is evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StepStage {
    /// Start of the step.
    Start,
    /// Middle of the step.
    Middle,
    /// End of the step.
    End,
}

impl StepStage {
    /// Fraction of the step.
    pub fn fraction(self) -> f64 {
        [0.0, 0.5, 1.0][self as usize]
    }
}

#[inline]
fn move_states<const N: usize>(
    states: &LaneStates<N>,
    rates: &LaneStates<N>,
    by_s: &LaneValues<N>,
) -> LaneStates<N> {
    let mut out = *states;
    for (out, rate) in out.iter_mut().zip(rates) {
        (0..N).for_each(|lane| out[lane] += rate[lane] * by_s[lane]);
    }
    out
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
        (0..steps).for_each(|_| state = method.advance_state(&state, h, rate));
        (state[0] - 1.0).hypot(state[1])
    }

    #[test]
    fn orders_of_accuracy() {
        let order = |method| (circle_error(method, 100) / circle_error(method, 200)).log2();
        assert!((order(Method::Rk4) - 4.0).abs() < 0.1);
        assert!((order(Method::Euler) - 1.0).abs() < 0.1);
    }
}
