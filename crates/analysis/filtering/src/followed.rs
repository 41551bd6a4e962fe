//! Inputs that the ship follows otherwise than recorded: with a lag, or within a dead band.

use sistership_simulation::interpolate::{apply_dead_band, apply_lag};

use super::thresholds::RESIDUAL;

/// An input on which a parameter acts, and the kind of action.
#[derive(Debug, Clone, Copy)]
pub(super) struct FollowedInput {
    /// Index among the inputs of the law.
    pub input: usize,
    pub way: InputResponse,
}

/// Kind of deviation from a recorded input, with one figure that is zero where the record is
/// followed.
#[derive(Debug, Clone, Copy)]
pub(super) enum InputResponse {
    /// First-order lag, by its time constant, s.
    Late,
    /// Dead band that the input has to leave, by half of its width in the unit of the input.
    WithinBand,
}

/// Record with a play in its running mean. A play about the record itself would remove the noise of
/// its readings, and would seem likely for that reason.
fn apply_play(recorded: &[f64], half: f64) -> Vec<f64> {
    let quiet = running_mean(recorded, RESIDUAL.band_mean);
    let held = apply_dead_band(&quiet, half);
    recorded.iter().zip(quiet.iter().zip(held)).map(|(x, (mean, held))| x + (held - mean)).collect()
}

/// Mean over a window about each sample, shorter at the ends.
fn running_mean(values: &[f64], window: usize) -> Vec<f64> {
    let half = window / 2;
    let near = |k: usize| &values[k.saturating_sub(half)..(k + half + 1).min(values.len())];
    (0..values.len()).map(|k| near(k).iter().sum::<f64>() / near(k).len() as f64).collect()
}

impl InputResponse {
    /// Input that the ship follows, with a value of the figure.
    pub fn followed_input(self, t_s: &[f64], recorded: &[f64], figure: f64) -> Vec<f64> {
        // A play is applied to the running mean, a lag to the record itself.
        match self {
            Self::Late => apply_lag(t_s, recorded, figure),
            Self::WithinBand => apply_play(recorded, figure),
        }
    }

    /// Increment of the figure for its derivative; where the figure is zero, at least the start of
    /// the search.
    pub fn derivative_step(self, figure: f64, start: f64) -> f64 {
        let least = match self {
            Self::Late => RESIDUAL.lag_step_s,
            Self::WithinBand => RESIDUAL.band_step,
        };
        if figure > 0.0 { RESIDUAL.lag_share * figure + least } else { start.max(least) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_running_mean_is_shorter_at_the_ends() {
        let mean = running_mean(&[3.0, 9.0, 0.0, 6.0, 30.0], 3);
        assert_eq!(mean, [6.0, 4.0, 5.0, 12.0, 18.0]);
    }

    /// A play moves the mean of the record and keeps its noise.
    #[test]
    fn a_play_keeps_what_the_mean_has_not() {
        let recorded: Vec<f64> = (0..60).map(|k| (f64::from(k) * 0.2).sin()).collect();
        let mean = running_mean(&recorded, RESIDUAL.band_mean);
        let held = apply_dead_band(&mean, 0.3);
        for (k, followed) in apply_play(&recorded, 0.3).into_iter().enumerate() {
            assert!((followed - held[k] - (recorded[k] - mean[k])).abs() < 1e-15, "{k}");
        }
        assert_eq!(apply_play(&recorded, 0.0), recorded);
    }

    /// A lag steps by a share of itself beside the least step; at zero by that of the search.
    #[test]
    fn steps_grow_with_the_figure() {
        for (way, least) in [
            (InputResponse::Late, RESIDUAL.lag_step_s),
            (InputResponse::WithinBand, RESIDUAL.band_step),
        ] {
            assert_eq!(way.derivative_step(2.0, 0.5), 2.0 * RESIDUAL.lag_share + least);
            assert_eq!(way.derivative_step(0.0, 10.0 * least), 10.0 * least);
            assert_eq!(way.derivative_step(0.0, 0.1 * least), least);
        }
    }
}
