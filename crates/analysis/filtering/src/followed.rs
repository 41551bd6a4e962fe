//! How a ship may follow an input otherwise than it was recorded: late, or within a band.

use sistership_simulation::interpolate::{lagged, within_band};

use super::thresholds::RESIDUAL;

/// An input that a parameter acts on, and how.
#[derive(Debug, Clone, Copy)]
pub(super) struct Followed {
    /// Its place among those of the law.
    pub input: usize,
    pub way: Following,
}

/// A way to follow an input by one figure, which is zero where the record is followed.
#[derive(Debug, Clone, Copy)]
pub(super) enum Following {
    /// Behind a first-order lag, by its time constant, s.
    Late,
    /// Where it leaves a band, by half of its width in the unit of the input.
    WithinBand,
}

/// The record, less what a play takes from its running mean. A play about the record itself would take
/// the noise of its readings away, and be believed for that.
fn behind_play(recorded: &[f64], half: f64) -> Vec<f64> {
    let quiet = running_mean(recorded, RESIDUAL.band_mean);
    let held = within_band(&quiet, half);
    recorded.iter().zip(quiet.iter().zip(held)).map(|(x, (mean, held))| x + (held - mean)).collect()
}

/// The mean over a window about each sample, shorter at the ends.
fn running_mean(values: &[f64], window: usize) -> Vec<f64> {
    let half = window / 2;
    let near = |k: usize| &values[k.saturating_sub(half)..(k + half + 1).min(values.len())];
    (0..values.len()).map(|k| near(k).iter().sum::<f64>() / near(k).len() as f64).collect()
}

impl Following {
    /// What the ship follows.
    pub fn of(self, t_s: &[f64], recorded: &[f64], figure: f64) -> Vec<f64> {
        match self {
            Self::Late => lagged(t_s, recorded, figure),
            Self::WithinBand => behind_play(recorded, figure),
        }
    }

    /// By how much the figure is larger for its derivative; at its absence, where a search begins.
    pub fn more(self, figure: f64, start: f64) -> f64 {
        let least = match self {
            Self::Late => RESIDUAL.lag_step_s,
            Self::WithinBand => RESIDUAL.band_step,
        };
        if figure > 0.0 { RESIDUAL.lag_share * figure + least } else { start.max(least) }
    }
}
