//! The speeds, revolutions and advance ratios that trials cover.

use sistership_model::Trial;
use sistership_model::trial::Channel;

use crate::thresholds::BALANCE;

/// Range in which a law alone counts, and where its weight falls to zero: none below, full from,
/// full to, none above.
pub(crate) type CoveredRange = [f64; 4];

/// An engine on the approach.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ApproachEngine {
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Revolutions, 1/s.
    pub n_rps: f64,
    /// Share of them that it loses as the ship comes to rest, at a constant order.
    pub loss: f64,
}

/// Returns the range of orders, the revolutions at rest by the engine's response, 1/s; that of the
/// approach if no revolutions were recorded.
pub(crate) fn covered_orders(trials: &[&Trial], engine: ApproachEngine) -> CoveredRange {
    let lost_by_speed = engine.loss * engine.n_rps / engine.speed_m_s;
    let order = |(n, u): (&f64, &f64)| n - lost_by_speed * u.abs();
    let of = |trial: &&Trial| {
        let (n, u) = (trial.channel(Channel::N)?, trial.channel(Channel::U)?);
        Some(n.iter().zip(u).map(order).collect::<Vec<f64>>())
    };
    let orders = trials.iter().filter_map(of).flatten().collect();
    let approach = order((&engine.n_rps, &engine.speed_m_s));
    let [least, greatest] = between_tails(orders).unwrap_or([approach; 2]);
    let width = BALANCE.revolutions * engine.n_rps;
    [least - width, least, greatest, greatest + width]
}

/// Returns the least and greatest ratio of revolutions to speed, times the speed of the approach,
/// with the revolutions of the approach where none were recorded. Samples near rest have no such
/// ratio; the width over which a law's weight falls is added on either side, so that it has full
/// weight at every sample.
pub(crate) fn covered_speed_ratios(trials: &[&Trial], [speed_m_s, n_rps]: [f64; 2]) -> [f64; 2] {
    let least = BALANCE.rest * speed_m_s;
    let of = |trial: &&Trial| {
        let u = trial.channel(Channel::U)?;
        let n = trial.channel(Channel::N).map_or_else(|| vec![n_rps; u.len()], <[f64]>::to_vec);
        let under_way = u.iter().zip(n).filter(|(u, _)| u.abs() > least);
        Some(under_way.map(|(u, n)| n / u.abs() * speed_m_s).collect::<Vec<f64>>())
    };
    let ratios = trials.iter().filter_map(of).flatten().collect();
    let [least, greatest] = between_tails(ratios).unwrap_or([n_rps; 2]);
    let width = BALANCE.revolutions * n_rps;
    [least - width, greatest + width]
}

/// Returns the greatest sway speed, m/s, and yaw rate, rad/s, at which a law is evaluated at another
/// speed; the speed of the approach and as many radians per second if none were recorded.
pub(crate) fn covered_turning(trials: &[&Trial], speed_m_s: f64) -> [f64; 2] {
    [Channel::V, Channel::R].map(|channel| {
        let range = central_range(trials, channel);
        let greatest = range.map(|[least, most]| most.max(-least));
        let recorded = greatest.filter(|greatest| *greatest > 0.0);
        recorded.map_or(speed_m_s, |greatest| BALANCE.turning * greatest)
    })
}

/// Returns the range of speeds ahead, m/s.
pub(crate) fn covered_speeds(trials: &[&Trial], approach_m_s: f64) -> CoveredRange {
    let [least, greatest] = central_range(trials, Channel::U).unwrap_or([approach_m_s; 2]);
    let near_rest = BALANCE.rest * approach_m_s;
    // Trials that reach rest cover the speeds down to it, so that their range is not widened by a
    // share of their least speed.
    let [from, none] = match least > 2.0 * near_rest {
        true => BALANCE.slow.map(|share| share * least),
        false => [least, least - near_rest],
    };
    let [to, none_above] = BALANCE.fast.map(|share| share * greatest.max(near_rest));
    [none, from, to, none_above]
}

/// Range of all but the tails of the samples; `None` if no trial has the channel.
fn central_range(trials: &[&Trial], channel: Channel) -> Option<[f64; 2]> {
    let samples = trials.iter().filter_map(|trial| trial.channel(channel)).flatten().copied();
    between_tails(samples.collect())
}

fn between_tails(mut samples: Vec<f64>) -> Option<[f64; 2]> {
    samples.retain(|sample| sample.is_finite());
    samples.sort_by(f64::total_cmp);
    // The same number of samples is cut from both ends.
    let tail = (BALANCE.tails * samples.len() as f64) as usize;
    Some([*samples.get(tail)?, *samples.get(samples.len().checked_sub(1 + tail)?)?])
}
