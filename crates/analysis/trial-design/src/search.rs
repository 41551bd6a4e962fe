//! Search among designs: the candidate with the largest gain per minute is added, then candidates
//! are exchanged (Fedorov 1972, Theory of optimal experiments, chapter 3) under the same budget.

use rayon::prelude::*;

use crate::design::TrialDesign;
use crate::thresholds::THRESHOLDS;

/// Best set that was found under a budget (s), most informative per minute first.
pub(crate) fn best_design(design: &TrialDesign, budget_s: f64) -> Vec<usize> {
    let mut chosen = fill_budget(design, budget_s, Vec::new());
    for _ in 0..THRESHOLDS.rounds {
        if !exchange_candidates(design, budget_s, &mut chosen) {
            break;
        }
        // An exchange for a shorter trial may leave time for a further one.
        chosen = fill_budget(design, budget_s, chosen);
    }
    order_by_gain(design, chosen)
}

/// Adds the candidate with the largest gain per minute until none fits.
fn fill_budget(design: &TrialDesign, budget_s: f64, mut chosen: Vec<usize>) -> Vec<usize> {
    let all: Vec<usize> = (0..design.takes_s.len()).collect();
    while chosen.len() < THRESHOLDS.most_trials {
        let left_s = budget_s - design.lasts_s(&chosen);
        let Some(next) = best_next(design, &chosen, &all, left_s) else { break };
        chosen.push(all[next]);
    }
    chosen
}

/// Index, among some candidates, of the one with the largest gain per minute in addition to those
/// selected.
fn best_next(
    design: &TrialDesign,
    chosen: &[usize],
    among: &[usize],
    left_s: f64,
) -> Option<usize> {
    let now = design.information_with(chosen);
    let score = design.log_mean_deviation(now.clone());
    let rate = |(place, &candidate): (usize, &usize)| {
        let takes_s = design.takes_s[candidate];
        let gain = score - design.log_mean_deviation(&now + &design.information[candidate]);
        (takes_s <= left_s && gain > 0.0).then_some((gain / takes_s, place))
    };
    // Collected in order: ties are resolved in the same way on any number of threads.
    let rates: Vec<(f64, usize)> = among.par_iter().enumerate().filter_map(rate).collect();
    rates.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, place)| place)
}

/// Exchanges each selected candidate for the best that fits in its place; returns true if any was
/// exchanged.
fn exchange_candidates(design: &TrialDesign, budget_s: f64, chosen: &mut [usize]) -> bool {
    let mut any = false;
    for place in 0..chosen.len() {
        let others: Vec<usize> =
            (0..chosen.len()).filter(|other| *other != place).map(|other| chosen[other]).collect();
        // The time of the replaced trial is available again.
        let (beside, left_s) =
            (design.information_with(&others), budget_s - design.lasts_s(&others));
        let score = |candidate: usize| {
            let fits = design.takes_s[candidate] <= left_s;
            let score = || design.log_mean_deviation(&beside + &design.information[candidate]);
            fits.then(|| (score(), candidate))
        };
        let scores: Vec<(f64, usize)> =
            (0..design.takes_s.len()).into_par_iter().filter_map(score).collect();
        let now = design.log_mean_deviation(&beside + &design.information[chosen[place]]);
        let best = scores.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, candidate)) = best.filter(|best| best.0 < now - THRESHOLDS.least_gain) {
            chosen[place] = candidate;
            any = true;
        }
    }
    any
}

/// Orders trials by information per minute, the most informative first.
fn order_by_gain(design: &TrialDesign, mut rest: Vec<usize>) -> Vec<usize> {
    let mut order = Vec::new();
    while let Some(place) = best_next(design, &order, &rest, f64::INFINITY) {
        order.push(rest.swap_remove(place));
    }
    // Trials without a further gain stay at the end.
    order.extend(rest);
    order
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use nalgebra::{DMatrix, DVector};

    use super::*;

    /// Candidates that each tell one direction so well, and the time that each takes.
    fn design(told: &[(&[f64], f64, f64)], gradients: DMatrix<f64>) -> TrialDesign {
        let one = |(direction, information, _): &(&[f64], f64, f64)| {
            let direction = DVector::from_column_slice(direction);
            &direction * direction.transpose() * *information
        };
        let size = gradients.ncols();
        TrialDesign {
            information: told.iter().map(one).collect(),
            takes_s: told.iter().map(|(.., takes_s)| *takes_s).collect(),
            gradients,
            before: DMatrix::identity(size, size),
        }
    }

    /// The best score of all sets that fit, a candidate at most twice.
    fn exhaustive(
        design: &TrialDesign,
        budget_s: f64,
        chosen: &mut Vec<usize>,
        from: usize,
    ) -> f64 {
        let mut best = design.log_mean_deviation(design.information_with(chosen));
        for place in from..design.takes_s.len() {
            if design.lasts_s(chosen) + design.takes_s[place] <= budget_s {
                chosen.push(place);
                best = best.min(exhaustive(design, budget_s, chosen, place));
                chosen.pop();
            }
        }
        best
    }

    #[test]
    fn deviations_are_those_of_the_posterior() {
        let told: [(&[f64], f64, f64); 1] = [(&[1.0, 0.0], 3.0, 60.0)];
        let design = design(&told, DMatrix::from_row_slice(2, 2, &[2.0, 0.0, 2.0, 1.0]));
        // The first deviation is halved: 2/2, and sqrt(1 + 1) of sqrt(4 + 1).
        let after = design.target_deviations(design.information_with(&[0])).unwrap();
        assert!((after[0] - 1.0).abs() < 1e-12 && (after[1] - 2.0_f64.sqrt()).abs() < 1e-12);
        let mean = 0.5 * (0.5_f64.ln() + (2.0_f64 / 5.0).ln() / 2.0);
        assert!((1.0 - design.relative_narrowing(&[0]) - mean.exp()).abs() < 1e-12);
    }

    #[test]
    fn an_exchange_finds_what_a_rate_alone_does_not() {
        // The first gains most a minute, and leaves no time for the other two together.
        let told: [(&[f64], f64, f64); 3] =
            [(&[1.0, 0.2], 6.0, 40.0), (&[1.0, 0.0], 7.0, 50.0), (&[0.0, 1.0], 7.0, 50.0)];
        let design = design(&told, DMatrix::identity(2, 2));
        assert_eq!(best_next(&design, &[], &[0, 1, 2], 100.0), Some(0));
        let mut chosen = best_design(&design, 100.0);
        chosen.sort_unstable();
        assert_eq!(chosen, [1, 2]);
    }

    #[test]
    fn the_search_is_as_good_as_all_sets_tried() {
        let angle = |k: usize| 0.7 * k as f64;
        let directions: Vec<[f64; 3]> =
            (0..6).map(|k| [angle(k).cos(), angle(k).sin(), (2.0 * angle(k)).sin()]).collect();
        let told: Vec<(&[f64], f64, f64)> = directions
            .iter()
            .enumerate()
            .map(|(k, d)| (d.as_slice(), 3.0 + k as f64, 10.0 + 7.0 * (k % 3) as f64))
            .collect();
        let design = design(&told, DMatrix::identity(3, 3));
        for budget_s in [20.0, 45.0, 70.0] {
            let found =
                design.log_mean_deviation(design.information_with(&best_design(&design, budget_s)));
            let least = exhaustive(&design, budget_s, &mut Vec::new(), 0);
            assert!(found < least + 0.01, "{budget_s}: {found} above {least}");
        }
    }
}
