//! Wind and water depth that trials recorded.

use std::collections::BTreeMap;

use sistership_model::environment::DEEP_M;
use sistership_model::trial::{Channel, Trial};

/// Returns the least and greatest true or apparent wind speed (m/s) and depth (m) by channel name;
/// channels that no trial recorded are absent. If some trials have a depth, a trial without one
/// counts as deep water.
pub(crate) fn covered_environment(trials: &[&Trial]) -> BTreeMap<String, [f64; 2]> {
    let wind = [Channel::WindSpeed, Channel::ApparentWindSpeed].into_iter().filter_map(|channel| {
        let recorded = trials.iter().filter_map(|trial| trial.channel(channel));
        Some((channel.name().to_owned(), value_range(recorded.flatten().copied())?))
    });
    let depths: Vec<Option<[f64; 2]>> = trials.iter().map(|trial| depth_range(trial)).collect();
    let is_recorded = depths.iter().any(Option::is_some);
    let ends = depths.into_iter().flat_map(|depth| depth.unwrap_or([DEEP_M, DEEP_M]));
    let depth = value_range(ends).filter(|_| is_recorded);
    wind.chain(depth.map(|range| (Channel::Depth.name().to_owned(), range))).collect()
}

fn depth_range(trial: &Trial) -> Option<[f64; 2]> {
    let recorded = trial.channel(Channel::Depth).map(|depths| value_range(depths.iter().copied()));
    // A trial without recorded depths may state a constant one.
    recorded.flatten().or_else(|| trial.depth_m.map(|depth| [depth, depth]))
}

fn value_range(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    values.fold(None, |range, value| match range {
        Some([low, high]) => Some([value.min(low), value.max(high)]),
        None => Some([value, value]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_and_wind_are_those_recorded() {
        let mut windy = Trial { t_s: vec![0.0, 1.0], ..Trial::default() };
        windy.channels.insert(Channel::WindSpeed, vec![3.0, 7.0]);
        let shallow = Trial { depth_m: Some(15.0), ..windy.clone() };
        let calm = Trial { t_s: vec![0.0, 1.0], ..Trial::default() };
        assert_eq!(covered_environment(&[&calm]), BTreeMap::new());
        let covered = covered_environment(&[&calm, &windy, &shallow]);
        assert_eq!(covered["wind_speed"], [3.0, 7.0]);
        assert_eq!(covered["depth"], [15.0, DEEP_M]);
    }
}
