//! Check that positive rudder turns the ship to starboard.
//!
//! Two indications are combined. The yaw rate some moments later correlates with the rudder; and in
//! Nomoto's first-order model, dr/dt = a r + b delta + c, fitted over blocks, b has the rudder's
//! sign. Either alone is wrong at times: the first when the ship swings slowly, the second when a
//! turn is so tight that the model does not fit. A trial is refused if both agree that the sign is
//! wrong.

use nalgebra::{Matrix3, Vector3};
use sistership_model::trial::Channel;

use crate::findings::Findings;
use crate::recording::Recording;
use crate::stats::{SampleBlock, iter_range, nearest_quantile, pearson_correlation, sample_blocks};

/// rad; with less rudder or less swing the ship keeps its course, and the rudder follows the yaw
/// rate.
const RUDDER: f64 = 0.05;
const SWING: f64 = 0.25;
/// Minimum number of blocks with speed ahead.
const ENOUGH: usize = 15;
/// Lags of the yaw rate behind the rudder, as fractions of the recording.
const LAGS: [f64; 4] = [0.0, 0.005, 0.01, 0.02];
/// Each correlation must be below the first limit, their sum below the second.
const EACH: f64 = 0.25;
const BOTH: f64 = -0.6;

pub(crate) fn check_rudder(recording: &Recording, findings: &mut Findings) {
    let (Some(r), Some(delta)) = (recording.channel(Channel::R), recording.channel(Channel::Delta))
    else {
        return;
    };
    let ahead = ahead_samples(recording);
    let blocks: Vec<SampleBlock> = sample_blocks(recording)
        .into_iter()
        .filter(|block| (block.first..=block.last).all(|k| ahead[k]))
        .collect();
    if blocks.len() < ENOUGH || !has_manoeuvres(recording, r, delta) {
        return;
    }
    let (lagged, fitted) =
        (lagged_correlation(r, delta, &ahead), nomoto_correlation(recording, &blocks, r, delta));
    if lagged < EACH && fitted < EACH && lagged + fitted < BOTH {
        let message = format!(
            "positive rudder turns the ship to port in this file (the yaw rate correlates with it \
             by {lagged:.2}); set `rudder_positive: port_turn` in the manifest's conventions, or \
             starboard_turn if port_turn is set"
        );
        findings.error(None, Some(recording.column_header(Channel::Delta)), message);
    }
}

/// Flags the samples with way ahead: a ship going astern responds to its rudder with the other sign
/// or not at all.
fn ahead_samples(recording: &Recording) -> Vec<bool> {
    let all = vec![true; recording.trial.len()];
    let Some(u) = recording.channel(Channel::U) else { return all };
    // Slow parts of the recording are excluded as well.
    let enough = 0.5 * nearest_quantile(u.iter().copied(), 0.95);
    let n = recording.channel(Channel::N);
    (0..u.len()).map(|k| u[k] > 0.0 && u[k] > enough && n.is_none_or(|n| n[k] > 0.0)).collect()
}

fn has_manoeuvres(recording: &Recording, r: &[f64], delta: &[f64]) -> bool {
    let mut heading = 0.0;
    let t = recording.time();
    let swing = (1..t.len()).map(|k| {
        // The heading from the yaw rate, since a trial may have no heading.
        heading += r[k] * (t[k] - t[k - 1]);
        heading
    });
    iter_range(swing) > SWING
        && nearest_quantile(delta.iter().map(|value| value.abs()), 0.95) > RUDDER
}

/// Returns the correlation that is largest in magnitude among the lags.
fn lagged_correlation(r: &[f64], delta: &[f64], ahead: &[bool]) -> f64 {
    let at = |part: &f64| {
        let lag = (part * r.len() as f64) as usize;
        let both = (0..r.len() - lag).filter(|&k| ahead[k] && ahead[k + lag]);
        pearson_correlation(both.map(|k| (delta[k], r[k + lag])))
    };
    LAGS.iter().map(at).max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0)
}

/// Returns the partial correlation of rudder and yaw acceleration: b of Nomoto's model divided by
/// its standard error, scaled to -1 to 1.
fn nomoto_correlation(
    recording: &Recording,
    blocks: &[SampleBlock],
    r: &[f64],
    delta: &[f64],
) -> f64 {
    let t = recording.time();
    let row = |block: &SampleBlock| {
        Vector3::new(
            block.time_integral(t, |k| r[k]),
            block.time_integral(t, |k| delta[k]),
            block.total_change(t),
        )
    };
    let rows: Vec<(Vector3<f64>, f64)> =
        blocks.iter().map(|block| (row(block), block.total_change(r))).collect();
    // Normal equations of the integrated model: change of r over a block on the integrals of r and
    // delta and on the duration.
    let gram: Matrix3<f64> = rows.iter().map(|(row, _)| row * row.transpose()).sum();
    let moment: Vector3<f64> = rows.iter().map(|(row, change)| row * *change).sum();
    let Some(inverse) = gram.try_inverse() else { return 0.0 };
    let found = inverse * moment;
    let squares: f64 = rows.iter().map(|(row, change)| (change - row.dot(&found)).powi(2)).sum();
    let freedom = (rows.len() - 3) as f64;
    // b^2 / (b^2 + its variance times the degrees of freedom) needs no division by a variance of
    // zero.
    let partial = found[1] / (found[1].powi(2) + squares * inverse[(1, 1)]).sqrt();
    if partial.is_finite() && freedom > 0.0 { partial } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{check_messages, test_recording, zigzag_channels, zigzag_with};

    #[test]
    fn a_rudder_of_the_other_sign_is_refused() {
        assert_eq!(check_messages(&test_recording(&zigzag_channels()), check_rudder), "");
        let text = check_messages(&zigzag_with(Channel::Delta, |delta| -delta), check_rudder);
        assert!(
            text.starts_with("error None Some(\"delta_rad\")") && text.contains("port_turn"),
            "{text}"
        );
    }

    #[test]
    fn no_rudder_or_no_swing_says_nothing() {
        assert_eq!(check_messages(&zigzag_with(Channel::Delta, |_| 0.0), check_rudder), "");
        assert_eq!(check_messages(&zigzag_with(Channel::R, |r| -1e-3 * r), check_rudder), "");
    }
}
