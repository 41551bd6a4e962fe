//! Averaging of trials that were recorded more often than windows need: means of neighbouring
//! samples reduce noise before terms multiply it, as the mean over a window would do afterwards.

use sistership_model::trial::{Channel, Trial};

use super::thresholds::WEAK;

/// Returns a trial in means over as many samples as still leave a window its intervals; `None` if
/// that is one sample, or if a part between gaps would be lost.
pub(super) fn average_samples(trial: &Trial, window_s: f64) -> Option<Trial> {
    let wanted = window_s / WEAK.most_intervals / trial.interval_s();
    let every = (wanted + 1e-9).floor();
    if !(every.is_finite() && every > 1.0) {
        return None;
    }
    let parts = trial.segments();
    let every = every as usize;
    let by_group = |column: &[f64], of: fn(&[f64]) -> f64| -> Vec<f64> {
        parts.iter().flat_map(|part| column[part.clone()].chunks_exact(every).map(of)).collect()
    };
    // A direction has no mean where it passes from 180 to -180 deg: the middle sample stands for
    // it.
    let channels = trial.channels.iter().map(|(&channel, column)| {
        (channel, by_group(column, if is_direction(channel) { middle_sample } else { mean }))
    });
    let fewer = Trial {
        t_s: by_group(&trial.t_s, mean),
        channels: channels.collect(),
        warnings: Vec::new(),
        ..trial.clone()
    };
    (fewer.segments().len() == parts.len()).then_some(fewer)
}

fn mean(group: &[f64]) -> f64 {
    group.iter().sum::<f64>() / group.len() as f64
}

fn middle_sample(group: &[f64]) -> f64 {
    group[group.len() / 2]
}

/// Returns true if a channel is a direction, which may pass from 180 to -180 deg.
fn is_direction(channel: Channel) -> bool {
    matches!(channel, Channel::Psi | Channel::WindFrom | Channel::ApparentWindFrom)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn trial(gap_s: f64) -> Trial {
        let t_s: Vec<f64> =
            (0..1200).map(|k| 0.1 * f64::from(k) + if k < 600 { 0.0 } else { gap_s }).collect();
        let turning = t_s.iter().map(|t| (0.05 * t).sin().atan2((0.05 * t).cos())).collect();
        let noise = (0..1200).map(|k| if k % 3 == 0 { 0.2 } else { -0.1 });
        let u = t_s.iter().zip(noise).map(|(t, noise)| 0.01 * t + noise).collect();
        Trial {
            channels: [(Channel::U, u), (Channel::Psi, turning)].into(),
            t_s,
            ..Trial::default()
        }
    }

    #[test]
    fn noise_falls_and_a_slope_stays() {
        let (whole, fewer) = (trial(30.0), average_samples(&trial(30.0), 18.0).unwrap());
        assert_eq!((fewer.len(), fewer.segments().len()), (200 + 200, 2));
        for (t, u) in fewer.t_s.iter().zip(fewer.channel(Channel::U).unwrap()) {
            assert!((u - 0.01 * t).abs() < 1e-12);
        }
        let (psi, before) =
            (fewer.channel(Channel::Psi).unwrap(), whole.channel(Channel::Psi).unwrap());
        assert!(psi.iter().all(|angle| before.contains(angle)));
    }

    #[test]
    fn slow_records_are_left_as_they_are() {
        assert!(average_samples(&trial(30.0), 6.0).is_none());
        assert!(average_samples(&trial(0.1), 18.0).is_none(), "a gap of two samples would vanish");
    }
}
