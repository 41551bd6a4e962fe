//! Comparison of candidates by simulations with longer restart intervals.

use super::candidate::CandidateFit;
use super::outcome::RefineError;
use super::problem::Problem;
use super::simulated::simulate_longer;
use super::thresholds::SELECTION;

/// Simulates manoeuvres left out at the longer restart intervals of the settings, by the source and
/// by the candidates whose error at the shortest is near the least; the others are out.
///
/// # Errors
/// A trial lacks a channel.
pub(super) fn compare_longer(
    problem: &Problem<'_>,
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
        if !is_source && error > SELECTION.near_least * least {
            let times = error / least;
            let reason = format!("{times:.1} times the least error of short simulations");
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
