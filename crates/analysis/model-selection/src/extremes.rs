//! Trials with extreme rudder angles or speeds.

use sistership_model::trial::{Channel, Trial};

/// Share of the largest value from which on a trial is among the largest, and by its reciprocal
/// among the smallest. Chosen: readings of the same order differ by a few hundredths, the next
/// usual order (20 after 25 deg, 30 after 35) by a seventh or more.
const NEAR: f64 = 0.9;

/// Returns sets of trials that are held out together: those of the largest rudder angles, of the
/// smallest, of the highest approach speeds and of the lowest. A set that would leave less than
/// half of the trials is omitted: these trials are then of one kind.
pub(super) fn extreme_trials(trials: &[&Trial]) -> Vec<Vec<usize>> {
    // Both lists have a value for every trial, or the quantity is not compared at all.
    let rudder: Option<Vec<f64>> = trials.iter().map(|trial| largest_rudder(trial)).collect();
    let speed: Option<Vec<f64>> = trials.iter().map(|trial| approach_speed(trial)).collect();
    let sets = [rudder, speed].into_iter().flatten().flat_map(|values| {
        let most = values.iter().copied().fold(0.0, f64::max);
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        [
            extreme_places(&values, |value| value > NEAR * most),
            extreme_places(&values, |value| value * NEAR < least),
        ]
    });
    // At least half of the trials remain for the fit.
    sets.filter(|set| !set.is_empty() && 2 * set.len() <= trials.len()).collect()
}

/// Places of the values that are extreme.
fn extreme_places(values: &[f64], is_extreme: impl Fn(f64) -> bool) -> Vec<usize> {
    (0..values.len()).filter(|place| is_extreme(values[*place])).collect()
}

/// Largest rudder angle of a trial to either side, rad.
fn largest_rudder(trial: &Trial) -> Option<f64> {
    let angles = trial.channel(Channel::Delta)?;
    Some(angles.iter().fold(0.0, |most: f64, angle| most.max(angle.abs())))
}

/// Speed at the beginning of a trial, m/s.
fn approach_speed(trial: &Trial) -> Option<f64> {
    trial.channel(Channel::U)?.first().map(|speed| speed.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(rudder: f64, speed: f64) -> Trial {
        let channels = [(Channel::Delta, vec![0.0, -rudder]), (Channel::U, vec![speed, 1.0])];
        Trial { t_s: vec![0.0, 1.0], channels: channels.into(), ..Trial::default() }
    }

    #[test]
    fn the_largest_and_least_are_held_out_together() {
        let all: Vec<Trial> =
            [(10.0, 5.0), (20.0, 5.1), (20.0, 4.9), (35.0, 5.0), (33.0, 5.0), (20.0, 8.0)]
                .map(|(rudder, speed)| trial(rudder, speed))
                .into();
        let all: Vec<&Trial> = all.iter().collect();
        let expected: [&[usize]; 3] = [&[3, 4], &[0], &[5]];
        assert_eq!(extreme_trials(&all), expected, "most trials have the lowest speed");
        assert_eq!(extreme_trials(&all[1..3]), Vec::<Vec<usize>>::new());
    }
}
