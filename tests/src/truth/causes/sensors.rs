//! Errors of instruments: what they indicate of a true track.

use sistership_simulation::state::{StateVector, Trajectory, at};

/// One of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sensor {
    /// The rate gyro's zero, rad/s.
    RateBias(f64),
    /// The heading drifts away, rad/s.
    HeadingDrift(f64),
    /// Scale of a log of two axes.
    Log(f64),
    /// The receiver stands so far forward of midship and to starboard, m.
    LeverArm(f64, f64),
    /// Compass and gyro are late, s; to the next tenth of a second.
    Late(f64),
}

impl Sensor {
    /// What is indicated of a track; a rate bias from a time on.
    pub(super) fn indicated(&self, track: &mut Trajectory, since_s: f64) {
        match *self {
            Self::RateBias(bias) => each(track, |t_s, state| {
                state[at::R] += if t_s < since_s { 0.0 } else { bias };
            }),
            Self::HeadingDrift(drift) => each(track, |t_s, state| state[at::PSI] += drift * t_s),
            Self::Log(scale) => each(track, |_, state| {
                state[at::U] *= 1.0 + scale;
                state[at::V] *= 1.0 + scale;
            }),
            Self::LeverArm(forward, starboard) => each(track, |_, state| {
                let (sin, cos) = state[at::PSI].sin_cos();
                state[at::X] += forward * cos - starboard * sin;
                state[at::Y] += forward * sin + starboard * cos;
                state[at::U] -= state[at::R] * starboard;
                state[at::V] += state[at::R] * forward;
            }),
            Self::Late(delay_s) => {
                let step_s = track.t_s[1] - track.t_s[0];
                late(track, (delay_s / step_s).round() as usize);
            }
        }
    }
}

fn each(track: &mut Trajectory, change: impl Fn(f64, &mut StateVector)) {
    track.t_s.iter().zip(&mut track.states).for_each(|(t_s, state)| change(*t_s, state));
}

fn late(track: &mut Trajectory, steps: usize) {
    let truth = track.states.clone();
    for (k, state) in track.states.iter_mut().enumerate() {
        let then = &truth[k.saturating_sub(steps)];
        state[at::PSI] = then[at::PSI];
        state[at::R] = then[at::R];
    }
}
