//! Comparison of candidates by simulations with longer restart intervals.

use super::candidate::CandidateFit;
use super::outcome::RefineError;
use super::problem::RefinementProblem;
use super::simulated::simulate_longer;
use super::thresholds::SELECTION;

/// Simulates held-out manoeuvres at the longer restart intervals of the settings, by the source and
/// by the candidates whose error at the shortest interval is near the least; the others are
/// excluded.
///
/// # Errors
/// Returns an error if a trial lacks a channel.
pub(super) fn compare_longer(
    problem: &RefinementProblem<'_>,
    candidates: &mut [CandidateFit],
) -> Result<(), RefineError> {
    if problem.settings.longer_restarts_s.is_empty() {
        return Ok(());
    }
    let errors = candidates.iter().filter_map(|candidate| candidate.option.error);
    let least = errors.fold(f64::INFINITY, f64::min);
    for candidate in candidates {
        let Some(error) = candidate.option.error else { continue };
        let is_source = candidate.left_out.is_empty();
        // A candidate with a much larger error at the shortest interval is excluded without further
        // simulations. The source is always simulated.
        if !is_source && error > SELECTION.near_least * least {
            let times = error / least;
            let reason = format!(
                "{times:.1} times the smallest error of simulations with short \
                                  restarts"
            );
            (candidate.option.error, candidate.option.reason) = (None, Some(reason));
            continue;
        }
        let longer = match is_source {
            true => simulate_longer(problem, std::slice::from_ref(&problem.transferred), &|_| 0)?,
            false => {
                simulate_longer(problem, &candidate.left_out, &|trial| problem.fold_of(trial))?
            }
        };
        candidate.add_horizons(longer);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_model::Model;
    use sistership_model::trial::Trial;

    use super::super::candidate::UnchangedSource;
    use super::super::settings::RefinementSettings;
    use super::super::simulated::simulate_training;
    use super::*;
    use crate::testing::{mariner_model, simulated_trials, with_scaled_coefficients};

    fn candidate(problem: &RefinementProblem<'_>, model: &Model) -> CandidateFit {
        let left_out = vec![model.clone(); problem.fold_count()];
        let simulated = simulate_training(problem, &left_out, &|trial| problem.fold_of(trial));
        let step = (String::new(), None);
        let fit = CandidateFit::new(problem, step, UnchangedSource, 1, simulated.unwrap());
        CandidateFit { left_out, ..fit }
    }

    #[test]
    fn a_bias_shows_in_whole_trials_and_what_is_far_off_is_out() {
        let (model, law) = mariner_model();
        let sailed = simulated_trials(&model, &law, 0.02);
        let sailed: Vec<&Trial> = sailed.iter().collect();
        let settings = RefinementSettings {
            restart_s: Some(60.0),
            longer_restarts_s: vec![1000.0],
            ..RefinementSettings::default()
        };
        let problem = RefinementProblem::from_model(&model, &law, &sailed, settings);
        let biased = with_scaled_coefficients(&model, |name| if name == "N_0" { 1.5 } else { 1.0 });
        let far =
            with_scaled_coefficients(&model, |name| if name == "N_delta" { 1.5 } else { 1.0 });
        let mut all = [&model, &biased, &far].map(|model| candidate(&problem, model));
        compare_longer(&problem, &mut all).unwrap();
        let [own, biased, far] = all;
        let ratio = |place: usize| biased.horizons[place].mean / own.horizons[place].mean;
        let (short, whole) = (ratio(0), ratio(1));
        assert!(short < 1.5 && whole > 1.5 * short, "{short} {whole}");
        assert!(biased.option.error.unwrap() > own.option.error.unwrap());
        assert!(far.option.error.is_none() && far.option.reason.is_some());
        assert_eq!((own.horizons.len(), far.horizons.len()), (2, 1));
    }
}
