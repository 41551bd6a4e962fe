//! Trials divided into parts, where whole ones cannot be held out.
//!
//! A source of the plane (3-DOF) gives no information on roll, and a single zigzag may be all that
//! excites it. If that zigzag is held out whole, the strength of the prior is chosen by models
//! without information on roll; if it is held out part by part, the other parts inform them.

use std::ops::Range;

use sistership_model::law::Law;
use sistership_model::trial::Trial;

use super::equations::EquationForm;
use super::settings::RefinementSettings;

/// Returns the training trials divided into parts of the length of the settings, at least two of
/// each trial. Empty if the trials stay whole: parts are used where the settings request them, or
/// where a law has roll and there are fewer trials than folds.
pub(super) fn trial_parts(
    training: &[&Trial],
    law: &Law,
    equations: EquationForm,
    settings: &RefinementSettings,
) -> Vec<Trial> {
    let Some(part_s) = settings.part_s.or(settings.restart_s) else { return Vec::new() };
    let few_that_roll = law.has_roll() && training.len() < settings.folds;
    if !settings.hold_out_parts && (equations.are_differences() || !few_that_roll) {
        return Vec::new();
    }
    training.iter().flat_map(|trial| divide_trial(trial, part_s)).collect()
}

/// Divides a trial into equal parts that neither overlap nor share a sample.
fn divide_trial(trial: &Trial, part_s: f64) -> Vec<Trial> {
    let count = ((trial.duration_s() / part_s).round() as usize).max(2);
    let size = trial.len().div_ceil(count).max(1);
    (0..trial.len())
        .step_by(size)
        .map(|from| trial_slice(trial, from..(from + size).min(trial.len())))
        .collect()
}

/// Returns a range of samples of a trial as a trial, with its conditions and without its warnings.
pub(super) fn trial_slice(trial: &Trial, samples: Range<usize>) -> Trial {
    let of = |column: &[f64]| column[samples.clone()].to_vec();
    Trial {
        name: trial.name.clone(),
        t_s: of(&trial.t_s),
        channels: trial.channels.iter().map(|(channel, column)| (*channel, of(column))).collect(),
        manoeuvre: trial.manoeuvre.clone(),
        depth_m: trial.depth_m,
        velocity: trial.velocity,
        warnings: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::weak::WindowSpacing;
    use super::*;
    use sistership_model::Zoo;
    use sistership_model::trial::Channel;

    fn trial(samples: usize) -> Trial {
        let t_s: Vec<f64> = (0..samples).map(|k| 0.5 * k as f64).collect();
        Trial { channels: [(Channel::U, t_s.clone())].into(), t_s, ..Trial::default() }
    }

    #[test]
    fn parts_hold_every_sample_once() {
        let whole = trial(1161);
        for (part_s, count) in [(200.0, 3), (1000.0, 2)] {
            let parts = divide_trial(&whole, part_s);
            assert_eq!(parts.len(), count);
            let together: Vec<f64> =
                parts.iter().flat_map(|part| part.channel(Channel::U).unwrap().to_vec()).collect();
            assert_eq!(together, whole.t_s);
        }
    }

    #[test]
    fn only_few_trials_of_ships_that_roll_are_cut() {
        let zoo = Zoo::load_embedded().unwrap();
        let one = trial(1000);
        let settings =
            RefinementSettings { restart_s: Some(100.0), ..RefinementSettings::default() };
        let windows = EquationForm::Windows(WindowSpacing { length_s: 20.0, hop_s: 2.0 });
        let count = |law: &str, trials: usize, equations| {
            trial_parts(&vec![&one; trials], zoo.law(law).unwrap(), equations, &settings).len()
        };
        assert_eq!(count("abkowitz-roll", 3, windows), 15);
        assert_eq!(count("abkowitz-roll", 8, windows), 0);
        assert_eq!(count("abkowitz", 3, windows), 0);
        assert_eq!(count("abkowitz-roll", 3, EquationForm::Differences(None)), 0);
        let asked = RefinementSettings { hold_out_parts: true, ..settings.clone() };
        assert_eq!(trial_parts(&[&one], zoo.law("abkowitz").unwrap(), windows, &asked).len(), 5);
    }
}
