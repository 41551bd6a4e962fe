//! Revolutions of trials that record none, as they are stated in a manifest.

use sistership_model::manifest::ManifestTrial;
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Vessel, Zoo};
use sistership_priors::revolutions::assume_revolutions;
use sistership_priors::transfer::trial_approach;

/// States the revolutions of each trial that records none: by those of the others at the speed of
/// its approach, or, where no trial records any, by an estimate. Returns a note on it, also if they
/// cannot be stated.
pub fn state_revolutions(
    zoo: &Zoo,
    vessel: Option<&Vessel>,
    listed: &mut [ManifestTrial],
    trials: &mut [Trial],
) -> Option<String> {
    let is_recorded =
        |trial: &Trial| Channel::SHAFTS.iter().any(|&one| trial.channel(one).is_some());
    if trials.iter().all(is_recorded) {
        return None;
    }
    if trials.iter().any(is_recorded) {
        return Some(state_by_others(listed, trials));
    }
    let refs: Vec<&Trial> = trials.iter().collect();
    let Some(held) = assume_revolutions(zoo, vessel?, &refs) else {
        return Some(
            "no revolutions are recorded, and laws with a propeller need them: give `n_rps` of \
             each trial in the manifest, or more particulars of the ship"
                .into(),
        );
    };
    // Both the manifest and the trials at hand, so that laws are listed as they will be fitted.
    for (trial, &n_rps) in trials.iter_mut().zip(&held) {
        hold_revolutions(listed, trial, n_rps);
    }
    let (least, most) =
        held.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), &n_rps| (a.min(n_rps), b.max(n_rps)));
    let range = match least < most {
        true => format!("{least} to {most}"),
        false => most.to_string(),
    };
    Some(format!(
        "no revolutions are recorded: each trial is taken to have a constant engine order, {range} \
         1/s by the thrust balance at its speed (`n_rps` in the manifest); correct them if known"
    ))
}

fn hold_revolutions(listed: &mut [ManifestTrial], trial: &mut Trial, n_rps: f64) {
    trial.channels.insert(Channel::N, vec![n_rps; trial.t_s.len()]);
    let own = listed.iter_mut().filter(|one| one.trial_label() == trial.name);
    own.for_each(|one| one.n_rps = Some(n_rps));
}

/// States the revolutions of trials without any in proportion to the speed of their approach, by
/// the trials that record one shaft.
fn state_by_others(listed: &mut [ManifestTrial], trials: &mut [Trial]) -> String {
    let recorded: Vec<&Trial> =
        trials.iter().filter(|trial| trial.channel(Channel::N).is_some()).collect();
    let known = trial_approach(&recorded);
    let ratio = known.and_then(|known| Some(known.n_rps? / known.speed_m_s));
    let mut told = Vec::new();
    for trial in trials.iter_mut() {
        if Channel::SHAFTS.iter().any(|&one| trial.channel(one).is_some()) {
            continue;
        }
        let speed_m_s = trial_approach(&[&*trial]).map(|approach| approach.speed_m_s);
        // Three digits: more would look like a reading.
        let held = ratio.zip(speed_m_s).map(|(ratio, speed)| (1e3 * ratio * speed).round() / 1e3);
        match held.filter(|n_rps| *n_rps > 0.0) {
            Some(n_rps) => {
                hold_revolutions(listed, trial, n_rps);
                told.push(format!("{} is taken to have held {n_rps} 1/s", trial.name));
            }
            None => told.push(format!("{} needs `n_rps` in the manifest", trial.name)),
        }
    }
    format!(
        "some trials record no revolutions: {}, by those of the others at the speed of its \
         approach; correct it if it is known",
        told.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(name: &str, speed_m_s: f64, recorded: Option<(Channel, f64)>) -> Trial {
        let t_s = vec![0.0, 1.0, 2.0];
        let mut trial = Trial { name: name.into(), t_s, ..Trial::default() };
        trial.channels.insert(Channel::U, vec![speed_m_s; 3]);
        trial.channels.insert(Channel::V, vec![0.0; 3]);
        trial.channels.extend(recorded.map(|(channel, n_rps)| (channel, vec![n_rps; 3])));
        trial
    }

    #[test]
    fn trials_without_revolutions_have_those_of_the_others_at_their_speed() {
        let mut trials = [
            trial("a.csv", 6.0, Some((Channel::N, 1.5))),
            trial("b.csv", 3.0, None),
            trial("c.csv", 6.0, None),
        ];
        let mut listed = trials.each_ref().map(|one| ManifestTrial::from_file_name(&*one.name));
        let note = state_by_others(&mut listed, &mut trials);
        assert_eq!(listed.each_ref().map(|one| one.n_rps), [None, Some(0.75), Some(1.5)]);
        assert_eq!(trials[1].channel(Channel::N), Some(&[0.75; 3][..]));
        assert!(note.contains("b.csv is taken to have held 0.75 1/s"), "{note}");
    }

    #[test]
    fn a_pair_of_shafts_tells_nothing_of_a_single_one() {
        let mut trials = [trial("a.csv", 6.0, Some((Channel::NS, 1.5))), trial("b.csv", 3.0, None)];
        let mut listed = trials.each_ref().map(|one| ManifestTrial::from_file_name(&*one.name));
        let note = state_by_others(&mut listed, &mut trials);
        assert!(note.contains("b.csv needs `n_rps`"), "{note}");
        assert_eq!(listed.each_ref().map(|one| one.n_rps), [None, None]);
    }
}
