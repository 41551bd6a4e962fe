//! Jumps of a recording: steps of a position or a heading that the velocities do not show. They are
//! no motion of the ship: a receiver changed its satellites, or a compass was disturbed, and
//! velocities that were derived from it are wrong nearby.

use std::ops::Range;

use sistership_model::Trial;
use sistership_model::trial::Channel;

use super::thresholds::RESIDUAL;

/// Ranges of samples without a gap and further than `settles_s` from any jump.
pub fn undisturbed_ranges(trial: &Trial, settles_s: f64) -> Vec<Range<usize>> {
    let jumps = jump_times(trial);
    let is_near = |k: usize| {
        // Jumps are in order, so only the neighbours on both sides can be near.
        let next = jumps.partition_point(|&jump| jump < trial.t_s[k]);
        let near =
            |jump: Option<&f64>| jump.is_some_and(|jump| (jump - trial.t_s[k]).abs() < settles_s);
        near(jumps.get(next)) || near(next.checked_sub(1).and_then(|before| jumps.get(before)))
    };
    let kept: Vec<Range<usize>> =
        trial.segments().into_iter().flat_map(|range| kept_runs(range, &|k| !is_near(k))).collect();
    let left: usize = kept.iter().map(Range::len).sum();
    if (left as f64) < (1.0 - RESIDUAL.most_lost) * trial.len() as f64 {
        trial.segments()
    } else {
        kept
    }
}

/// Runs of a range over which all samples are kept.
fn kept_runs(range: Range<usize>, keep: &dyn Fn(usize) -> bool) -> Vec<Range<usize>> {
    let (mut runs, mut start) = (Vec::new(), range.start);
    for k in range.clone() {
        if !keep(k) {
            runs.push(start..k);
            start = k + 1;
        }
    }
    runs.push(start..range.end);
    runs.retain(|run| !run.is_empty());
    runs
}

/// Times in the middle of steps that jump, in order, s.
fn jump_times(trial: &Trial) -> Vec<f64> {
    // Rates over the ground: x' = u cos(psi) - v sin(psi), and y' by the angle turned by -90 deg.
    let rates = [
        (Channel::X, ground_speed(trial, 0.0)),
        (Channel::Y, ground_speed(trial, -0.5 * std::f64::consts::PI)),
    ];
    let turn = trial.channel(Channel::R).map(<[f64]>::to_vec);
    let pairs = rates.into_iter().chain([(Channel::Psi, turn)]);
    let mut jumps: Vec<f64> =
        pairs.flat_map(|(channel, rate)| channel_jumps(trial, channel, rate.as_deref())).collect();
    jumps.sort_by(f64::total_cmp);
    jumps
}

/// Speed over the ground along the x axis turned by an angle, m/s.
fn ground_speed(trial: &Trial, turned: f64) -> Option<Vec<f64>> {
    let (u, v, psi) =
        (trial.channel(Channel::U)?, trial.channel(Channel::V)?, trial.channel(Channel::Psi)?);
    let one =
        |((u, v), psi): ((&f64, &f64), &f64)| u * (psi + turned).cos() - v * (psi + turned).sin();
    Some(u.iter().zip(v).zip(psi).map(one).collect())
}

fn channel_jumps(trial: &Trial, channel: Channel, rate: Option<&[f64]>) -> Vec<f64> {
    let (Some(values), Some(rate)) = (trial.channel(channel), rate) else { return Vec::new() };
    let step = |k: usize| trial.t_s[k] - trial.t_s[k - 1];
    let steps: Vec<usize> = trial.segments().into_iter().flat_map(|range| range.skip(1)).collect();
    // Disagreement of each step with the trapezoidal rule of its rate.
    let apart: Vec<f64> = steps
        .iter()
        .map(|&k| (values[k] - values[k - 1] - 0.5 * step(k) * (rate[k] + rate[k - 1])).abs())
        .collect();
    let fastest = steps.iter().map(|&k| (step(k) * rate[k]).abs()).fold(0.0, f64::max);
    // The second limit keeps a position that is held between fixes from being a jump.
    let limit =
        (RESIDUAL.jump * deviation_from_magnitudes(&apart)).max(RESIDUAL.least_jump * fastest);
    let jumping = steps.iter().zip(&apart).filter(|(_, apart)| **apart > limit);
    jumping.map(|(&k, _)| 0.5 * (trial.t_s[k] + trial.t_s[k - 1])).collect()
}

/// Standard deviation of a normal variable with the median of these magnitudes.
fn deviation_from_magnitudes(magnitudes: &[f64]) -> f64 {
    let (mut ordered, middle) = (magnitudes.to_vec(), magnitudes.len() / 2);
    if ordered.is_empty() {
        return 0.0;
    }
    // The median of the magnitude of a normal variable is 0.6745 of its standard deviation.
    *ordered.select_nth_unstable_by(middle, f64::total_cmp).1 / 0.6745
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A straight run of a hundred seconds with a receiver that scatters by 5 mm.
    fn run(jump_m: f64) -> Trial {
        let noise = |k: usize| 0.005 * (k as f64 * 12.9898).sin();
        let x = |k: usize| 0.2 * k as f64 * 0.1 + noise(k) + if k >= 500 { jump_m } else { 0.0 };
        let channels = [
            (Channel::U, vec![0.2; 1000]),
            (Channel::V, vec![0.0; 1000]),
            (Channel::Psi, vec![0.0; 1000]),
            (Channel::X, (0..1000).map(x).collect()),
            (Channel::Y, (0..1000).map(noise).collect()),
        ];
        Trial {
            t_s: (0..1000).map(|k| 0.1 * k as f64).collect(),
            channels: channels.into(),
            ..Trial::default()
        }
    }

    #[test]
    fn a_jump_parts_a_trial() {
        let parts = undisturbed_ranges(&run(0.5), 3.0);
        assert_eq!(parts, [0..470, 530..1000]);
    }

    #[test]
    fn scatter_does_not() {
        assert_eq!(undisturbed_ranges(&run(0.0), 3.0), vec![0..1000; 1]);
    }

    #[test]
    fn a_position_that_is_held_between_fixes_does_not() {
        let mut held = run(0.0);
        for channel in [Channel::X, Channel::Y] {
            let values = held.channels.get_mut(&channel).unwrap();
            *values = (0..1000).map(|k| values[k / 10 * 10]).collect();
        }
        assert_eq!(undisturbed_ranges(&held, 3.0), vec![0..1000; 1]);
    }
}
