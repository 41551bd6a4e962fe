use super::*;

fn search(population: usize, largest_population: usize) -> CmaEsSearch {
    let budget = SearchBudget { evaluations: 100, wall_s: None, cpu_s: None };
    CmaEsSearch {
        widths: vec![0.5, 20.0],
        sigma: 0.5,
        population,
        largest_population,
        seed: 7,
        budget,
    }
}

#[test]
fn a_restart_is_anywhere_in_the_box_with_twice_the_population() {
    let starts: Vec<EvolutionStrategy> =
        (1..40).map(|restart| search(8, 64).restart_strategy(restart, 8)).collect();
    let reach = |axis: usize, sign: f64| {
        starts.iter().map(|start| sign * start.mean()[axis]).fold(f64::MIN, f64::max)
    };
    for (axis, width) in [(0, 0.5), (1, 20.0)] {
        for sign in [1.0, -1.0] {
            assert!((0.8 * width..=width).contains(&reach(axis, sign)), "{}", reach(axis, sign));
        }
    }
    assert!(starts.iter().all(|start| start.population_size() == 16 && start.sigma() == 0.5));
    assert_eq!(search(8, 64).restart_strategy(1, 40).population_size(), 64);
    assert_eq!(search(8, 4).restart_strategy(1, 8).population_size(), 8);
}

/// It has converged where the best costs of enough generations are alike, by their size.
#[test]
fn a_run_has_converged_when_its_best_stays() {
    let of = |costs: &[f64]| has_converged(&costs.iter().copied().collect(), 3);
    assert!(of(&[5.0, 5.0, 5.0]) && !of(&[5.0, 5.0]));
    assert!(of(&[5.0, 5.0 + 4e-9, 5.0]) && !of(&[5.0, 5.0 + 6e-9, 5.0]));
    assert!(of(&[-5.0, -5.0 + 4e-9, -5.0]) && !of(&[-5.0, -5.0 + 6e-9, -5.0]));
    assert!(of(&[0.0, 9e-13, 0.0]) && !of(&[0.0, 2e-12, 0.0]));
}

#[test]
fn candidates_are_evaluated_inside_with_the_mean_behind_them() {
    let candidates = DMatrix::from_column_slice(2, 2, &[0.2, 30.0, -2.0, -1.0]);
    let cost = |x: &[f64]| if x[0] < 0.0 { f64::NAN } else { x[0] + x[1] };
    let mean = DVector::from_vec(vec![0.1, -25.0]);
    let (points, costs) =
        evaluate_candidates(&BoundPenalty::new(&[0.5, 20.0]), &candidates, &mean, &cost);
    assert_eq!(points, [vec![0.2, 20.0], vec![-0.5, -1.0], vec![0.1, -20.0]]);
    assert_eq!(costs, [20.2, f64::INFINITY, -19.9]);
}

/// A search that begins outside the box begins at its edge, and tells what it spends.
#[test]
fn a_search_tells_how_it_stands() {
    let first = EvolutionStrategy::new(&[3.0, 0.0], 0.5, 8, 7);
    let cost = |x: &[f64]| (x[0] - 0.2).powi(2) + (x[1] - 3.0).powi(2);
    let mut told = Vec::new();
    let outcome = search(8, 64).search_from(first, &cost, &mut |state| {
        assert!(state.mean.iter().zip([0.5, 20.0]).all(|(x, width)| x.abs() <= width));
        assert_eq!(state.best.1, cost(state.best.0));
        told.push((state.spent.evaluations, state.best.1, state.population, state.restarts));
        true
    });
    let outcome = outcome.unwrap_or_else(|_| panic!("nobody asked to stop"));
    // One for the start, then eight candidates and the mean a generation.
    let spent: Vec<usize> = told.iter().map(|state| state.0).collect();
    assert_eq!(spent, (1..=11).map(|k| 1 + 9 * k).collect::<Vec<usize>>());
    assert!(told.windows(2).all(|pair| pair[1].1 <= pair[0].1));
    assert!(told.iter().all(|state| (state.2, state.3) == (8, 0)));
    assert_eq!((outcome.cost, cost(&outcome.best)), (told[10].1, told[10].1));
    assert_eq!((outcome.spent.evaluations, outcome.populations), (100, vec![8]));
}

/// The distribution that is told is of the run that found the best point.
#[test]
fn the_distribution_is_of_the_run_that_found_the_best() {
    let budget = SearchBudget { evaluations: 3_000, wall_s: None, cpu_s: None };
    let sphere = |x: &[f64]| (x[0] - 0.2).powi(2) + (x[1] - 3.0).powi(2);
    let outcome = CmaEsSearch { budget, ..search(8, 64) }.find_minimum(&sphere, &mut |_| true);
    let outcome = outcome.unwrap_or_else(|_| panic!("nobody asked to stop"));
    assert!(outcome.populations.len() > 1);
    let mean = outcome.strategy.mean();
    assert!((mean[0] - 0.2).abs() < 1e-4 && (mean[1] - 3.0).abs() < 1e-4, "{mean}");
}
