//! Trials with fewer samples, where instruments record more often than a simulation needs.

use sistership_model::trial::Trial;

/// Every so many samples of a trial, so that they are as far apart as a simulation may step and no
/// further; none between gaps is joined to another. The trial itself where that would leave gaps
/// out, or nothing.
pub(super) fn thinned(trial: &Trial, step_s: Option<f64>) -> Trial {
    let interval_s = trial.interval_s();
    let every = step_s
        .filter(|_| interval_s > 0.0)
        .map_or(1, |step_s| (step_s / interval_s + 1e-9).floor().max(1.0) as usize);
    let parts = trial.segments();
    let kept: Vec<usize> = parts.iter().flat_map(|part| part.clone().step_by(every)).collect();
    let of = |column: &[f64]| kept.iter().map(|&k| column[k]).collect::<Vec<f64>>();
    let channels = trial.channels.iter().map(|(channel, column)| (*channel, of(column))).collect();
    let fewer = Trial { t_s: of(&trial.t_s), channels, warnings: Vec::new(), ..trial.clone() };
    if every > 1 && fewer.segments().len() == parts.len() { fewer } else { trial.clone() }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::trial::Channel;

    fn trial(gap_s: f64) -> Trial {
        let t_s: Vec<f64> =
            (0..100).map(|k| 0.1 * f64::from(k) + if k < 51 { 0.0 } else { gap_s }).collect();
        Trial { channels: [(Channel::U, t_s.clone())].into(), t_s, ..Trial::default() }
    }

    #[test]
    fn samples_are_as_far_apart_as_a_step_may_be() {
        let fewer = thinned(&trial(30.0), Some(0.35));
        assert_eq!((fewer.len(), fewer.segments().len()), (17 + 17, 2));
        assert!((fewer.interval_s() - 0.3).abs() < 1e-9);
        assert_eq!(fewer.channel(Channel::U).unwrap(), fewer.t_s);
        assert_eq!(fewer.t_s[17], trial(30.0).t_s[51], "each part from its start");
    }

    #[test]
    fn slow_records_and_gaps_that_would_vanish_are_left_as_they_are() {
        assert_eq!(thinned(&trial(30.0), Some(0.15)), trial(30.0));
        assert_eq!(thinned(&trial(0.1), Some(0.35)), trial(0.1), "a gap of a fifth of a second");
        assert_eq!(thinned(&trial(30.0), None), trial(30.0));
    }
}
