use super::*;

fn search(dimension: usize, width: f64, evaluations: usize) -> CmaEsSearch {
    let budget = SearchBudget { evaluations, wall_s: None, cpu_s: None };
    CmaEsSearch {
        widths: vec![width; dimension],
        sigma: 0.5,
        population: 16,
        largest_population: 64,
        seed: 7,
        budget,
    }
}

fn least(search: &CmaEsSearch, cost: &(dyn Fn(&[f64]) -> f64 + Sync)) -> SearchOutcome {
    search.find_minimum(cost, &mut |_| true).unwrap_or_else(|_| panic!("nobody asked to stop"))
}

fn sphere(x: &[f64]) -> f64 {
    x.iter().map(|x| (x - 1.0).powi(2)).sum()
}

/// Axes from 1 to 1e6, turned so that no coordinate is one.
fn ellipsoid(x: &[f64]) -> f64 {
    let n = x.len();
    let turned = |k: usize| x[k] + 0.5 * x[(k + 1) % n] - 0.25 * x[(k + 2) % n] - 1.0;
    (0..n).map(|k| 1e6_f64.powf(k as f64 / (n - 1) as f64) * turned(k).powi(2)).sum()
}

fn rosenbrock(x: &[f64]) -> f64 {
    x.windows(2).map(|w| 100.0 * (w[1] - w[0] * w[0]).powi(2) + (1.0 - w[0]).powi(2)).sum()
}

#[test]
fn the_sphere() {
    let outcome = least(&search(20, 5.0, 8_000), &sphere);
    assert!(outcome.cost < 1e-10, "{}", outcome.cost);
    assert!(outcome.best.iter().all(|x| (x - 1.0).abs() < 1e-5));
}

#[test]
fn a_turned_ellipsoid_whose_axes_differ_by_a_million() {
    let outcome = least(&search(12, 20.0, 30_000), &ellipsoid);
    assert!(outcome.cost < 1e-8, "{}", outcome.cost);
}

#[test]
fn the_valley_of_rosenbrock() {
    let outcome = least(&search(8, 5.0, 40_000), &rosenbrock);
    assert!(outcome.cost < 1e-8, "{}", outcome.cost);
}

/// Half of the coordinates have their best value outside the box: on its edge inside.
#[test]
fn an_optimum_on_the_edge_of_the_box() {
    let aim = |k: usize| if k.is_multiple_of(2) { 3.0 } else { -0.25 };
    let cost = |x: &[f64]| {
        x.iter().enumerate().map(|(k, x)| (1.0 + k as f64) * (x - aim(k)).powi(2)).sum::<f64>()
    };
    let outcome = least(&search(10, 1.0, 20_000), &cost);
    for (k, x) in outcome.best.iter().enumerate() {
        let wanted = aim(k).min(1.0);
        assert!((x - wanted).abs() < 1e-4, "{k}: {x}");
    }
}

#[test]
fn populations_grow_to_the_largest_and_all_candidates_are_inside() {
    // A plateau: every run converges at once.
    let mut told = 0;
    let cost = |x: &[f64]| {
        assert!(x.iter().all(|x| x.abs() <= 2.0));
        1.0
    };
    let outcome = search(4, 2.0, 12_000).find_minimum(&cost, &mut |standing| {
        told += 1;
        standing.population <= 64
    });
    let outcome = outcome.unwrap_or_else(|_| panic!("the population grew beyond its largest"));
    assert_eq!(outcome.populations[..4], [16, 32, 64, 64]);
    assert!(told > 100 && outcome.spent.evaluations >= 12_000);
}

#[test]
fn many_hills_are_left_behind_by_restarts() {
    let hills = |x: &[f64]| {
        let one =
            |x: &f64| (x - 0.7).powi(2) + 10.0 * (1.0 - (std::f64::consts::TAU * (x - 0.7)).cos());
        x.iter().map(one).sum::<f64>()
    };
    let outcome = least(&search(4, 5.0, 60_000), &hills);
    assert!(
        outcome.cost < 1e-8 && outcome.populations.len() > 1,
        "{} {:?}",
        outcome.cost,
        outcome.populations
    );
}

#[test]
fn a_seed_and_a_budget_give_the_same_point_to_the_last_bit() {
    let run = |seed| least(&CmaEsSearch { seed, ..search(6, 5.0, 2_000) }, &rosenbrock).best;
    assert_eq!(run(3), run(3));
    assert_ne!(run(3), run(4));
}

#[test]
fn a_search_that_is_told_to_stop_stops() {
    let mut generations = 0;
    let outcome = search(3, 1.0, 100_000).find_minimum(&sphere, &mut |_| {
        generations += 1;
        generations < 5
    });
    assert_eq!((outcome.err(), generations), (Some(SearchCancelled), 5));
}

#[test]
fn time_ends_a_search_too() {
    let budget = SearchBudget { evaluations: usize::MAX, wall_s: Some(0.05), cpu_s: None };
    let by_wall = least(&CmaEsSearch { budget, ..search(5, 5.0, 0) }, &rosenbrock);
    let budget = SearchBudget { evaluations: usize::MAX, wall_s: Some(30.0), cpu_s: Some(0.05) };
    let by_cpu = least(&CmaEsSearch { budget, ..search(5, 5.0, 0) }, &rosenbrock);
    assert!(by_wall.spent.wall_s() < 10.0 && by_cpu.spent.wall_s() < 10.0);
}

/// The share of a budget that is gone is the largest of its parts.
#[test]
fn a_budget_is_gone_by_what_is_scarcest() {
    let mut spent = SearchUsage::start_now();
    spent.evaluations = 30;
    let budget = |evaluations, wall_s, cpu_s| SearchBudget { evaluations, wall_s, cpu_s };
    assert_eq!(spent.used_share(&budget(120, None, None)), 0.25);
    assert_eq!(spent.used_share(&budget(120, Some(1e9), Some(1e9))), 0.25);
    std::thread::sleep(std::time::Duration::from_millis(5));
    assert!(spent.wall_s() >= 0.005 && spent.wall_s() < 5.0);
    assert!(spent.used_share(&budget(120, Some(0.002), None)) > 2.0);
    let begun = spent.cpu_s();
    while begun.zip(spent.cpu_s()).is_some_and(|(from, now)| now - from < 0.01) {}
    if let Some(cpu_s) = spent.cpu_s() {
        assert!((0.01..5.0).contains(&cpu_s), "{cpu_s}");
        assert!(spent.used_share(&budget(120, None, Some(0.005))) >= 2.0);
    }
}
