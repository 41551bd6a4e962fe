//! Training rows of a learned correction: measured accelerations of trials over short windows, and
//! those of the foundation there.
//!
//! No signal is differentiated. The change of a velocity over a window is compared with the
//! integral of the foundation's rate along the recorded motion, `nu(t + T/2) - nu(t - T/2) - int f
//! dt`; divided by T that is the mean unexplained acceleration over the window, as in the weak form
//! with a window of constant weight (decision 6).

use sistership_model::trial::Trial;
use sistership_model::trial_input::MissingInput;
use sistership_simulation::Ship;
use sistership_simulation::branch::CorrectionInstant;
use sistership_simulation::recorded::instants_along;

/// Means over one window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindowRow {
    /// Inputs of a correction, with the foundation's accelerations.
    pub instant: CorrectionInstant,
    /// Measured accelerations: m/s2, m/s2, rad/s2.
    pub measured: [f64; 3],
}

/// Error of preparing trials for training.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RowsError {
    /// A channel or an input of the law is missing.
    #[error(transparent)]
    Input(#[from] MissingInput),
    /// A recorded value, or the foundation's rate there, is not a finite number.
    #[error(
        "trial `{trial}`, {t_s} s: the motion or the acceleration of the foundation is not a \
             finite number"
    )]
    NotANumber {
        /// Name of the trial.
        trial: String,
        /// Time of the sample, s.
        t_s: f64,
    },
}

/// Returns the rows of a trial: windows of about `window_s`, one every `hop_s`, none across a gap.
///
/// # Errors
/// Returns an error that names the missing channel, or the sample that is not a finite number.
pub fn window_rows(
    ship: &Ship,
    trial: &Trial,
    window_s: f64,
    hop_s: f64,
) -> Result<Vec<WindowRow>, RowsError> {
    let instants = instants_along(ship, trial)?;
    if let Some(k) = instants.iter().position(|instant| !is_finite_instant(instant)) {
        return Err(RowsError::NotANumber { trial: trial.name.clone(), t_s: trial.t_s[k] });
    }
    let interval_s = trial.interval_s();
    // Times are rounded to whole samples, at least one.
    let samples = |time_s: f64| ((time_s / interval_s).round() as usize).max(1);
    let (window, hop) = (samples(window_s), samples(hop_s));
    let instants = instants.as_slice();
    let of_segment = |segment: std::ops::Range<usize>| {
        // A window lies completely within one segment.
        let last = segment.end.saturating_sub(window);
        (segment.start..last).step_by(hop).map(move |k| window_row(trial, instants, k..=k + window))
    };
    Ok(trial.segments().into_iter().flat_map(of_segment).collect())
}

fn is_finite_instant(instant: &CorrectionInstant) -> bool {
    let numbers = instant.velocities.iter().chain(&instant.accelerations);
    numbers.chain([&instant.delta_rad, &instant.n_rps]).all(|number| number.is_finite())
}

/// Row of one window: means by the trapezoidal rule, and measured accelerations from the change of
/// velocity.
fn window_row(
    trial: &Trial,
    instants: &[CorrectionInstant],
    window: std::ops::RangeInclusive<usize>,
) -> WindowRow {
    let (start, end) = (*window.start(), *window.end());
    let lasts_s = trial.t_s[end] - trial.t_s[start];
    let mean = |of: &dyn Fn(&CorrectionInstant) -> f64| {
        // Steps need not be equal, so each is weighted by its own duration.
        let part = |k: usize| {
            let step_s = trial.t_s[k + 1] - trial.t_s[k];
            0.5 * step_s * (of(&instants[k]) + of(&instants[k + 1]))
        };
        (start..end).map(part).sum::<f64>() / lasts_s
    };
    let change = |axis: usize| instants[end].velocities[axis] - instants[start].velocities[axis];
    let instant = CorrectionInstant {
        velocities: std::array::from_fn(|axis| mean(&|i| i.velocities[axis])),
        delta_rad: mean(&|i| i.delta_rad),
        n_rps: mean(&|i| i.n_rps),
        accelerations: std::array::from_fn(|axis| mean(&|i| i.accelerations[axis])),
    };
    // The mean acceleration is the change of the velocity over the window; nothing is
    // differentiated.
    WindowRow { instant, measured: std::array::from_fn(|axis| change(axis) / lasts_s) }
}
