//! The speeds, revolutions and advance ratios that trials cover.

use sistership_model::Trial;
use sistership_model::trial::Channel;

use crate::thresholds::BALANCE;

/// Where a law alone counts, and where it no longer does: none below, full from, full to, none
/// above.
pub(crate) type Range = [f64; 4];

/// Revolutions; those of the approach where nobody recorded any.
pub(crate) fn revolutions(trials: &[&Trial], approach_rps: f64) -> Range {
    let [least, greatest] = bulk(trials, Channel::N).unwrap_or([approach_rps; 2]);
    let width = BALANCE.revolutions * approach_rps;
    [least - width, least, greatest, greatest + width]
}

/// Least and greatest revolutions by the speed, times the speed of the approach; those of the
/// approach where nobody recorded any. Samples near rest have no such ratio; what a law gives way
/// over is added on either side, so that it sees every sample as it is.
pub(crate) fn by_speed(trials: &[&Trial], [speed_m_s, n_rps]: [f64; 2]) -> [f64; 2] {
    let least = BALANCE.rest * speed_m_s;
    let of = |trial: &&Trial| {
        let (u, n) = (trial.channel(Channel::U)?, trial.channel(Channel::N)?);
        let under_way = u.iter().zip(n).filter(|(u, _)| u.abs() > least);
        Some(under_way.map(|(u, n)| n / u.abs() * speed_m_s).collect::<Vec<f64>>())
    };
    let ratios = trials.iter().filter_map(of).flatten().collect();
    let [least, greatest] = between_tails(ratios).unwrap_or([n_rps; 2]);
    let width = BALANCE.revolutions * n_rps;
    [least - width, greatest + width]
}

/// Speeds ahead.
pub(crate) fn speeds(trials: &[&Trial], approach_m_s: f64) -> Range {
    let [least, greatest] = bulk(trials, Channel::U).unwrap_or([approach_m_s; 2]);
    let near_rest = BALANCE.rest * approach_m_s;
    let [from, none] = match least > 2.0 * near_rest {
        true => BALANCE.slow.map(|share| share * least),
        false => [least, least - near_rest],
    };
    let [to, none_above] = BALANCE.fast.map(|share| share * greatest.max(near_rest));
    [none, from, to, none_above]
}

/// What all but the tails of the samples lie between; none where no trial has the channel.
fn bulk(trials: &[&Trial], channel: Channel) -> Option<[f64; 2]> {
    let samples = trials.iter().filter_map(|trial| trial.channel(channel)).flatten().copied();
    between_tails(samples.collect())
}

fn between_tails(mut samples: Vec<f64>) -> Option<[f64; 2]> {
    samples.retain(|sample| sample.is_finite());
    samples.sort_by(f64::total_cmp);
    let tail = (BALANCE.tails * samples.len() as f64) as usize;
    Some([*samples.get(tail)?, *samples.get(samples.len().checked_sub(1 + tail)?)?])
}
