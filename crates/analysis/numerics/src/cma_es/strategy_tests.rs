//! The strategy against the equations of Hansen (2016), written out one by one.

use super::*;

const N: usize = 3;
const POPULATION: usize = 8;

/// Figure 6 and Table 1 of the tutorial, with `C^(-1/2)` by an eigendecomposition each time.
struct Reference {
    mean: DVector<f64>,
    sigma: f64,
    covariance: DMatrix<f64>,
    step_path: DVector<f64>,
    path: DVector<f64>,
    generation: i32,
}

/// The constants of Table 1 for the weights `w'` of Eq. 49.
struct Constants {
    weights: Vec<f64>,
    mass: f64,
    c_sigma: f64,
    d_sigma: f64,
    c_c: f64,
    c_1: f64,
    c_mu: f64,
}

fn constants(n: f64, population: usize) -> Constants {
    let raw: Vec<f64> = (1..=population)
        .map(|i| ((population as f64 + 1.0) / 2.0).ln() - (i as f64).ln())
        .collect();
    let mass_of =
        |all: &[f64]| all.iter().sum::<f64>().powi(2) / all.iter().map(|w| w * w).sum::<f64>();
    let parents = population / 2;
    let (mass, negative) = (mass_of(&raw[..parents]), mass_of(&raw[parents..]));
    let c_sigma = (mass + 2.0) / (n + mass + 5.0);
    let c_1 = 2.0 / ((n + 1.3).powi(2) + mass);
    let c_mu =
        f64::min(1.0 - c_1, 2.0 * (0.25 + mass + 1.0 / mass - 2.0) / ((n + 2.0).powi(2) + mass));
    let alpha =
        [1.0 + c_1 / c_mu, 1.0 + 2.0 * negative / (mass + 2.0), (1.0 - c_1 - c_mu) / (n * c_mu)];
    let alpha = alpha.into_iter().fold(f64::INFINITY, f64::min);
    let positive: f64 = raw.iter().filter(|w| **w > 0.0).sum();
    let beyond: f64 = raw.iter().filter(|w| **w < 0.0).map(|w| w.abs()).sum();
    let weight = |w: &f64| if *w > 0.0 { w / positive } else { alpha * w / beyond };
    Constants {
        weights: raw.iter().map(weight).collect(),
        mass,
        c_sigma,
        d_sigma: 1.0 + 2.0 * f64::max(0.0, ((mass - 1.0) / (n + 1.0)).sqrt() - 1.0) + c_sigma,
        c_c: (4.0 + mass / n) / (n + 4.0 + 2.0 * mass / n),
        c_1,
        c_mu,
    }
}

impl Reference {
    fn tell(&mut self, candidates: &DMatrix<f64>, costs: &[f64]) {
        let n = N as f64;
        let Constants { weights, mass, c_sigma, d_sigma, c_c, c_1, c_mu } =
            constants(n, POPULATION);
        let mut order: Vec<usize> = (0..costs.len()).collect();
        order.sort_by(|a, b| costs[*a].total_cmp(&costs[*b]));
        let y: Vec<DVector<f64>> =
            order.iter().map(|&k| (candidates.column(k) - &self.mean) / self.sigma).collect();
        let eigen = self.covariance.clone().symmetric_eigen();
        let inverse = DMatrix::from_diagonal(&eigen.eigenvalues.map(|d| 1.0 / d.sqrt()));
        let inverse = &eigen.eigenvectors * inverse * eigen.eigenvectors.transpose();
        let moved = y.iter().zip(&weights).take(POPULATION / 2).map(|(y, w)| y * *w);
        let moved: DVector<f64> = moved.sum();
        self.mean += &moved * self.sigma;
        self.generation += 1;
        let length = n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
        self.step_path = &self.step_path * (1.0 - c_sigma)
            + &inverse * &moved * (c_sigma * (2.0 - c_sigma) * mass).sqrt();
        let settled = (1.0 - (1.0 - c_sigma).powi(2 * self.generation)).sqrt();
        let steady = self.step_path.norm() / settled < (1.4 + 2.0 / (n + 1.0)) * length;
        let steady = f64::from(u8::from(steady));
        self.path =
            &self.path * (1.0 - c_c) + &moved * (steady * (c_c * (2.0 - c_c) * mass).sqrt());
        let missed = (1.0 - steady) * c_c * (2.0 - c_c);
        let kept = 1.0 + c_1 * missed - c_1 - c_mu * weights.iter().sum::<f64>();
        let mut covariance = &self.covariance * kept + &self.path * self.path.transpose() * c_1;
        for (y, w) in y.iter().zip(&weights) {
            let w = if *w >= 0.0 { *w } else { w * n / (&inverse * y).norm_squared() };
            covariance += y * y.transpose() * (c_mu * w);
        }
        self.covariance = covariance;
        self.sigma *= (c_sigma / d_sigma * (self.step_path.norm() / length - 1.0)).exp();
    }
}

/// Far from the optimum paths get long, so that they stop; then the search turns about it.
fn cost(x: &[f64]) -> f64 {
    x.iter().enumerate().map(|(k, x)| (1.0 + 9.0 * k as f64) * (x - 30.0).powi(2)).sum()
}

#[test]
fn generations_are_those_of_the_tutorial() {
    let start = [1.0, -2.0, 0.5];
    let mut strategy = EvolutionStrategy::new(&start, 0.5, POPULATION, 3);
    let mut reference = Reference {
        mean: DVector::from_column_slice(&start),
        sigma: 0.5,
        covariance: DMatrix::identity(N, N),
        step_path: DVector::zeros(N),
        path: DVector::zeros(N),
        generation: 0,
    };
    assert_eq!(
        (strategy.weights.decomposition_interval(N), strategy.population_size()),
        (1, POPULATION)
    );
    assert_eq!(strategy.selection_mass(), constants(3.0, POPULATION).mass);
    let (mut stopped, mut steady) = (0, 0);
    for _ in 0..30 {
        let candidates = strategy.draw_candidates();
        let costs: Vec<f64> = candidates.column_iter().map(|x| cost(x.as_slice())).collect();
        let before = strategy.path.clone();
        strategy.update_from_costs(&costs);
        reference.tell(&candidates, &costs);
        let shrunk = &before * (1.0 - strategy.weights.path_rate);
        if (&strategy.path - shrunk).norm() < 1e-12 {
            stopped += 1
        } else {
            steady += 1
        }
        let near = |own: f64, other: f64| (own - other).abs() < 1e-8 * (1.0 + other.abs());
        assert!(near(strategy.sigma(), reference.sigma));
        for i in 0..N {
            assert!(near(strategy.mean()[i], reference.mean[i]));
            let variance = reference.covariance[(i, i)] * reference.sigma.powi(2);
            assert!(near(strategy.coordinate_variances()[i], variance));
            for j in 0..N {
                assert!(near(strategy.covariance[(i, j)], reference.covariance[(i, j)]));
            }
        }
    }
    assert!(stopped > 0 && steady > 10, "both kinds of steps: {stopped}, {steady}");
}

/// In one generation sigma grows by a factor of e at most.
#[test]
fn a_step_size_grows_by_no_more_than_e() {
    let mut strategy = EvolutionStrategy::new(&[0.0; N], 1.0, POPULATION, 3);
    strategy.step_path = DVector::repeat(N, 1e6);
    strategy.draw_candidates();
    strategy.update_from_costs(&[1.0; POPULATION]);
    assert!((strategy.sigma() - std::f64::consts::E).abs() < 1e-12);
}

#[test]
fn a_decomposition_gives_the_covariance_back() {
    let mut strategy = EvolutionStrategy::new(&[0.0; 2], 1.0, POPULATION, 3);
    strategy.covariance = DMatrix::from_row_slice(2, 2, &[4.0, 1.5, 0.5, 2.0]);
    strategy.generation = 7;
    strategy.decompose_covariance();
    let symmetric = DMatrix::from_row_slice(2, 2, &[4.0, 1.0, 1.0, 2.0]);
    assert!((&strategy.axes * strategy.axes.transpose() - &symmetric).amax() < 1e-12);
    assert_eq!((strategy.covariance.clone(), strategy.decomposed), (symmetric, 7));
    let root = &strategy.vectors * DMatrix::from_diagonal(&strategy.roots);
    assert!((root - &strategy.axes).amax() < 1e-12);
    strategy.covariance = DMatrix::from_diagonal(&DVector::from_vec(vec![4.0, -1.0]));
    strategy.decompose_covariance();
    assert!((strategy.roots.min() - 2e-7).abs() < 1e-12, "{}", strategy.roots);
}

/// After one step the path is that step by `sqrt(c(2 - c))`: h_sigma compares its own length.
#[test]
fn a_path_of_one_step_is_judged_by_its_length() {
    let mut strategy = EvolutionStrategy::new(&[0.0; N], 1.0, POPULATION, 3);
    strategy.generation = 1;
    let longest = (1.4 + 2.0 / (N as f64 + 1.0)) * strategy.weights.expected_length;
    let length = longest / strategy.selection_mass().sqrt();
    let step = |share: f64| DVector::from_vec(vec![share * length, 0.0, 0.0]);
    assert!(strategy.clone().extend_paths(&step(0.95), &step(0.95)));
    assert!(!strategy.extend_paths(&step(1.05), &step(1.05)));
}

#[test]
fn what_cannot_move_any_more_is_exhausted() {
    let strategy = EvolutionStrategy::new(&[1.0, 2.0], 0.5, POPULATION, 3);
    assert!(!strategy.is_exhausted());
    let mut small = strategy.clone();
    small.sigma = 1e-17;
    assert!(small.is_exhausted());
    // One coordinate that moves is enough.
    small.mean[0] = 0.0;
    assert!(!small.is_exhausted());
    let mut grown = strategy.clone();
    grown.sigma = f64::INFINITY;
    assert!(grown.is_exhausted());
    for (least, is_exhausted) in [(1.1e-7, false), (1e-7, true)] {
        let mut narrow = strategy.clone();
        narrow.roots = DVector::from_vec(vec![1.0, least]);
        assert_eq!(narrow.is_exhausted(), is_exhausted, "{least}");
    }
}

#[test]
fn what_is_renewed_keeps_its_shape_and_moves_again() {
    let mut strategy = EvolutionStrategy::new(&[1.0, 2.0], 0.5, POPULATION, 3);
    strategy.covariance = DMatrix::from_diagonal(&DVector::from_vec(vec![1.0, 7.0]));
    for _ in 0..3 {
        let candidates = strategy.draw_candidates();
        let costs: Vec<f64> = candidates.column_iter().map(|x| cost(x.as_slice())).collect();
        strategy.update_from_costs(&costs);
    }
    strategy.sigma = 1e-3;
    let variance = strategy.covariance.diagonal().mean();
    let mut renewed = strategy.restart_at(&[5.0, 6.0], 0.4, 9);
    assert_eq!(renewed.mean(), &DVector::from_vec(vec![5.0, 6.0]));
    assert!((renewed.sigma() - 0.4 / variance.sqrt()).abs() < 1e-12);
    assert_eq!(renewed.covariance, strategy.covariance);
    assert_eq!((renewed.path.norm(), renewed.step_path.norm()), (0.0, 0.0));
    assert_eq!((renewed.generation, renewed.decomposed), (0, 0));
    assert_ne!(
        renewed.draw_candidates(),
        strategy.restart_at(&[5.0, 6.0], 0.4, 10).draw_candidates()
    );
    assert_eq!(strategy.restart_at(&[5.0, 6.0], 1e-9, 9).sigma(), 1e-3);
}

/// A population of four is the least.
#[test]
fn a_population_is_four_at_least() {
    assert_eq!(EvolutionStrategy::new(&[0.0; 2], 1.0, 1, 3).population_size(), 4);
    assert_eq!(EvolutionStrategy::new(&[0.0; 2], 1.0, 9, 3).population_size(), 9);
}

/// Table 1 over dimensions and populations, also where the learning rates are bounded.
#[test]
fn weights_and_rates_are_those_of_the_table() {
    for (n, population) in [(3, 8), (40, 14), (2, 300), (100, 7)] {
        let own = RecombinationWeights::new(n, population);
        let table = constants(n as f64, population);
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{n}, {population}: {a} {b}");
        own.all.iter().zip(&table.weights).for_each(|(a, b)| near(*a, *b));
        near(own.mass, table.mass);
        near(own.step_rate, table.c_sigma);
        near(own.step_damping, table.d_sigma);
        near(own.path_rate, table.c_c);
        near(own.rank_one_rate, table.c_1);
        near(own.rank_mu_rate, table.c_mu);
        let lag = (0.5 / (n as f64 * (table.c_1 + table.c_mu))).floor().max(1.0);
        assert_eq!(own.decomposition_interval(n), lag as usize);
        assert_eq!(own.parents, population / 2);
    }
    assert!(RecombinationWeights::new(100, 7).decomposition_interval(100) > 1);
}
