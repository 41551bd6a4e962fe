//! Revolutions of trials that record none, as they are stated in a manifest.

use sistership_model::manifest::ManifestTrial;
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Vessel, Zoo};
use sistership_priors::revolutions::assume_revolutions;

/// States the revolutions of each trial where none were recorded; returns a note on it, also if
/// they cannot be estimated.
pub fn state_revolutions(
    zoo: &Zoo,
    vessel: Option<&Vessel>,
    listed: &mut [ManifestTrial],
    trials: &mut [Trial],
) -> Option<String> {
    let is_recorded =
        |trial: &Trial| Channel::SHAFTS.iter().any(|&one| trial.channel(one).is_some());
    if trials.is_empty() || trials.iter().any(is_recorded) {
        return None;
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
        trial.channels.insert(Channel::N, vec![n_rps; trial.t_s.len()]);
        let own = listed.iter_mut().filter(|one| one.trial_label() == trial.name);
        own.for_each(|one| one.n_rps = Some(n_rps));
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
