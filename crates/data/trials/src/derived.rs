//! Derivation of surge, sway and yaw rate from positions and heading, where they were not measured.

use std::ops::Range;

use sistership_model::trial::Channel;

use crate::declarations::Derivable;
use crate::derived_channel::DerivedChannel;
use crate::findings::Findings;
use crate::recording::Recording;
use crate::smoother::{NoiseLevels, SmoothedState, estimate_noise, rts_smooth};
use crate::stats::nearest_quantile;
use crate::water::is_water_only;

/// Minimum number of samples of a segment without gaps for its rates to be derived.
const FEWEST: usize = 8;

/// Derives the yaw rate from the heading if it is declared and was not measured.
pub(crate) fn derive_yaw_rate(
    recording: &mut Recording,
    wanted: &[Derivable],
    findings: &mut Findings,
) {
    if !wanted.contains(&Derivable::R) || warn_if_measured(recording, Channel::R, findings) {
        return;
    }
    let Some(segments) = gapless_segments(recording, &[Channel::Psi], findings) else { return };
    let Some((noise, smoothed)) = smooth_channels(recording, &[Channel::Psi], &segments, findings)
    else {
        return;
    };
    let rates = smoothed[0].iter().map(|smoothed| (smoothed.rate, smoothed.rate_variance));
    insert_derived(recording, Channel::R, rates.unzip(), noise, findings);
}

/// Derives `u` and `v` from the track, rotated by the heading, if declared and not measured.
pub(crate) fn derive_velocities(
    recording: &mut Recording,
    wanted: &[Derivable],
    findings: &mut Findings,
) {
    let pairs = [(Derivable::U, Channel::U), (Derivable::V, Channel::V)];
    let open: Vec<Channel> = pairs
        .into_iter()
        .filter(|&(name, channel)| {
            let is_wanted = wanted.contains(&name)
                // One velocity over the ground and one through the water do not describe one
                // motion, so that both are derived.
                || (is_water_only(recording, channel) && derives_velocity(wanted));
            is_wanted && !warn_if_measured(recording, channel, findings)
        })
        .map(|(_, channel)| channel)
        .collect();
    if open.is_empty() {
        return;
    }
    let needed = [Channel::X, Channel::Y, Channel::Psi];
    let Some(segments) = gapless_segments(recording, &needed, findings) else { return };
    let Some((noise, track)) = smooth_channels(recording, &needed[..2], &segments, findings) else {
        return;
    };
    let Some((_, heading)) = smooth_channels(recording, &needed[2..], &segments, findings) else {
        return;
    };
    for channel in open {
        let along = channel == Channel::U;
        let samples = (0..heading[0].len())
            .map(|k| velocity_component(along, track[0][k], track[1][k], heading[0][k]));
        let samples = samples.unzip();
        insert_derived(recording, channel, samples, noise, findings);
    }
}

fn derives_velocity(wanted: &[Derivable]) -> bool {
    wanted.iter().any(|name| matches!(name, Derivable::U | Derivable::V))
}

/// Returns a velocity along the heading or across it, and its variance from the rates of the track
/// and from the heading.
fn velocity_component(
    along: bool,
    x: SmoothedState,
    y: SmoothedState,
    psi: SmoothedState,
) -> (f64, f64) {
    let (sin, cos) = psi.value.sin_cos();
    let (ahead, starboard) = (x.rate * cos + y.rate * sin, y.rate * cos - x.rate * sin);
    let (value, other, north, east) =
        if along { (ahead, starboard, cos, sin) } else { (starboard, ahead, sin, cos) };
    // First-order propagation of variances; the derivative of one component with respect to psi is,
    // up to its sign, the other component.
    let track = north * north * x.rate_variance + east * east * y.rate_variance;
    (value, track + other * other * psi.value_variance)
}

fn warn_if_measured(recording: &Recording, channel: Channel, findings: &mut Findings) -> bool {
    let is_measured = recording.channel(channel).is_some();
    if is_measured {
        let header = recording.column_header(channel).to_owned();
        findings.warning(None, Some(&header), format!("{channel} was measured and is not derived"));
    }
    is_measured
}

/// Returns the ranges without gaps that are long enough; samples outside are excluded from the
/// recording.
fn gapless_segments(
    recording: &mut Recording,
    needed: &[Channel],
    findings: &mut Findings,
) -> Option<Vec<Range<usize>>> {
    let missing: Vec<&str> = needed
        .iter()
        .filter(|&&channel| recording.channel(channel).is_none())
        .map(|channel| channel.name())
        .collect();
    if !missing.is_empty() {
        let message =
            format!("nothing can be derived without {}; map its column", missing.join(", "));
        findings.error(None, None, message);
        return None;
    }
    // Time that does not increase is reported by its own check.
    if recording.time().windows(2).any(|pair| pair[0] >= pair[1]) {
        return None;
    }
    // Samples of short segments are removed, unless nothing would remain.
    let short = |range: &Range<usize>| range.len() < FEWEST;
    let segments = recording.trial.segments();
    let lost: usize =
        segments.iter().filter(|range| short(range)).map(ExactSizeIterator::len).sum();
    if lost > 0 && lost < recording.trial.len() {
        recording.leave_out(&segments.into_iter().filter(short).collect::<Vec<_>>());
        let message = format!(
            "{lost} samples skipped: segments between gaps with fewer than {FEWEST} samples give \
             no rate"
        );
        findings.warning(None, None, message);
    }
    Some(recording.trial.segments().into_iter().filter(|range| !short(range)).collect())
}

fn smooth_channels(
    recording: &Recording,
    channels: &[Channel],
    segments: &[Range<usize>],
    findings: &mut Findings,
) -> Option<(NoiseLevels, Vec<Vec<SmoothedState>>)> {
    let t = recording.time();
    let values: Vec<&[f64]> =
        channels.iter().filter_map(|&channel| recording.channel(channel)).collect();
    let Some(noise) = estimate_noise(t, &values, segments) else {
        let message =
            format!("no segment without a gap has {FEWEST} samples; nothing can be derived");
        findings.error(None, None, message);
        return None;
    };
    let whole = |values: &&[f64]| {
        let parts = segments.iter().map(|range| (&t[range.clone()], &values[range.clone()]));
        parts.flat_map(|(t, values)| rts_smooth(t, values, noise)).collect()
    };
    Some((noise, values.iter().map(whole).collect()))
}

fn insert_derived(
    recording: &mut Recording,
    channel: Channel,
    (values, variance): (Vec<f64>, Vec<f64>),
    noise: NoiseLevels,
    findings: &mut Findings,
) {
    if !values.iter().chain(&variance).all(|value| value.is_finite()) {
        let message = "cannot be derived: rows are too close in time, or values too large";
        return findings.error(None, Some(channel.name()), message);
    }
    let (reading_sd, process_noise) = (noise.reading.sqrt(), noise.ratio * noise.reading);
    let (of, unit) = match channel {
        Channel::R => ("the heading", "rad"),
        _ => ("positions and heading", "m"),
    };
    // Typical and largest standard deviation over the samples.
    let sd = |share| nearest_quantile(variance.iter().map(|variance| variance.sqrt()), share);
    let message = format!(
        "derived from {of}, not measured: Rauch-Tung-Striebel smoother with white noise of \
         {process_noise:.3e} {unit}2/s5 on the third derivative and a measurement noise of \
         {reading_sd:.3e} {unit} (maximum likelihood); its standard deviation is {:.2e} {} \
         typically, {:.2e} at most",
        sd(0.5),
        recording.canonical_unit(channel),
        sd(1.0),
    );
    findings.warning(None, Some(channel.name()), message);
    recording.trial.channels.insert(channel, values);
    recording.derived.push(DerivedChannel { channel, variance, process_noise, reading_sd });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{finding_messages, test_recording, zigzag_channels};

    const ALL: [Derivable; 3] = [Derivable::U, Derivable::V, Derivable::R];

    fn without(channels: &[Channel]) -> Recording {
        let mut kept = zigzag_channels();
        kept.retain(|(channel, _)| !channels.contains(channel));
        test_recording(&kept)
    }

    fn derive(recording: &mut Recording) -> String {
        let mut findings = Findings::default();
        derive_yaw_rate(recording, &ALL, &mut findings);
        derive_velocities(recording, &ALL, &mut findings);
        finding_messages(findings)
    }

    #[test]
    fn velocities_of_a_zigzag_come_back() {
        let mut ship = without(&[Channel::U, Channel::V, Channel::R]);
        let text = derive(&mut ship);
        assert!(text.contains("Some(\"v\") derived from positions and heading"), "{text}");
        for (channel, truth) in zigzag_channels() {
            if [Channel::U, Channel::V, Channel::R].contains(&channel) {
                let found = &ship.trial.channels[&channel];
                let errors = found.iter().zip(&truth).map(|(a, b)| (a - b).abs());
                let most = errors.fold(0.0, f64::max);
                let limit = if channel == Channel::R { 1e-3 } else { 0.05 };
                assert!(most < limit, "{channel} {most}");
            }
        }
        let variance = &ship.derived[1].variance;
        assert!(variance.len() == ship.trial.len() && variance.iter().all(|value| *value >= 0.0));
    }

    #[test]
    fn what_was_measured_stays_and_what_is_missing_is_told() {
        let mut ship = without(&[Channel::V]);
        assert!(derive(&mut ship).contains("r was measured and is not derived"));
        assert_eq!(ship.derived.len(), 1);
        let mut ship = without(&[Channel::V, Channel::X, Channel::Psi]);
        assert!(derive(&mut ship).contains("without x, psi"));
    }

    #[test]
    fn a_log_through_the_water_is_no_velocity_over_the_ground() {
        let mut ship = without(&[Channel::U, Channel::V]);
        ship.trial.channels.insert(Channel::UWater, vec![9.0; ship.trial.len()]);
        derive_velocities(&mut ship, &[Derivable::V], &mut Findings::default());
        let derived: Vec<Channel> = ship.derived.iter().map(|derived| derived.channel).collect();
        assert_eq!(derived, [Channel::U, Channel::V]);
        assert!(ship.trial.channels[&Channel::U][0] < 8.9);
    }

    #[test]
    fn short_stretches_between_gaps_are_left_out() {
        let mut ship = without(&[Channel::R]);
        ship.trial.t_s.iter_mut().skip(300).for_each(|t| *t += 10.0);
        ship.trial.t_s.iter_mut().skip(303).for_each(|t| *t += 10.0);
        let text = derive(&mut ship);
        assert!(text.contains("3 samples skipped"), "{text}");
        assert_eq!((ship.trial.len(), ship.rows.len()), (597, 597));
        assert!(ship.trial.channels.values().all(|values| values.len() == 597));
        assert_eq!(ship.resumed, [ship.rows[300]]);
    }
}
