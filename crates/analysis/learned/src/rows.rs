//! What a branch is trained on: the accelerations of trials over short windows, and what the
//! foundation gives there.
//!
//! Nothing is differentiated. The change of a velocity over a window is compared with the integral
//! of the foundation's rate along the recorded motion, `nu(t + T/2) - nu(t - T/2) - int f dt`; by T
//! that is what the foundation lacks in the mean over the window, as the weak form has it with a
//! window of constant weight (decision 6).

use sistership_model::trial::Trial;
use sistership_simulation::Ship;
use sistership_simulation::branch::Instant;
use sistership_simulation::recorded::{MissingChannel, instants_along};

/// The mean over a window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// What a branch would see, with the foundation's accelerations.
    pub instant: Instant,
    /// Accelerations that were measured: m/s2, m/s2, rad/s2.
    pub measured: [f64; 3],
}

/// Why trials cannot be learned from.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RowsError {
    /// A channel is missing.
    #[error(transparent)]
    Channel(#[from] MissingChannel),
    /// What was recorded, or the foundation's rate there, is no number.
    #[error("trial `{trial}`, {t_s} s: the motion or the foundation's rate is no number")]
    NotANumber {
        /// The trial.
        trial: String,
        /// When, s.
        t_s: f64,
    },
}

/// The rows of a trial: windows of about `window_s`, one every `hop_s`, none across a gap.
///
/// # Errors
/// Names the channel that the trial lacks, or the sample that is no number.
pub fn rows(ship: &Ship, trial: &Trial, window_s: f64, hop_s: f64) -> Result<Vec<Row>, RowsError> {
    let instants = instants_along(ship, trial)?;
    if let Some(k) = instants.iter().position(|instant| !is_number(instant)) {
        return Err(RowsError::NotANumber { trial: trial.name.clone(), t_s: trial.t_s[k] });
    }
    let interval_s = trial.interval_s();
    let samples = |time_s: f64| ((time_s / interval_s).round() as usize).max(1);
    let (window, hop) = (samples(window_s), samples(hop_s));
    let instants = instants.as_slice();
    let of_segment = |segment: std::ops::Range<usize>| {
        let last = segment.end.saturating_sub(window);
        (segment.start..last).step_by(hop).map(move |k| row(trial, instants, k..=k + window))
    };
    Ok(trial.segments().into_iter().flat_map(of_segment).collect())
}

fn is_number(instant: &Instant) -> bool {
    let numbers = instant.velocities.iter().chain(&instant.accelerations);
    numbers.chain([&instant.delta_rad, &instant.n_rps]).all(|number| number.is_finite())
}

/// The mean over a window by the trapezoidal rule.
fn row(trial: &Trial, instants: &[Instant], window: std::ops::RangeInclusive<usize>) -> Row {
    let (start, end) = (*window.start(), *window.end());
    let lasts_s = trial.t_s[end] - trial.t_s[start];
    let mean = |of: &dyn Fn(&Instant) -> f64| {
        let part = |k: usize| {
            let step_s = trial.t_s[k + 1] - trial.t_s[k];
            0.5 * step_s * (of(&instants[k]) + of(&instants[k + 1]))
        };
        (start..end).map(part).sum::<f64>() / lasts_s
    };
    let change = |axis: usize| instants[end].velocities[axis] - instants[start].velocities[axis];
    let instant = Instant {
        velocities: std::array::from_fn(|axis| mean(&|i| i.velocities[axis])),
        delta_rad: mean(&|i| i.delta_rad),
        n_rps: mean(&|i| i.n_rps),
        accelerations: std::array::from_fn(|axis| mean(&|i| i.accelerations[axis])),
    };
    Row { instant, measured: std::array::from_fn(|axis| change(axis) / lasts_s) }
}
