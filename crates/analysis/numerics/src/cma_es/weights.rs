//! Recombination weights and learning rates: Hansen 2016, Table 1.

/// Constants that depend on dimension and population.
#[derive(Debug, Clone)]
pub(super) struct RecombinationWeights {
    /// Weights by rank, best first; those of the worse half are negative.
    pub all: Vec<f64>,
    /// Number of positive weights.
    pub parents: usize,
    /// Variance effective selection mass.
    pub mass: f64,
    pub path_rate: f64,
    pub rank_one_rate: f64,
    pub rank_mu_rate: f64,
    pub step_rate: f64,
    pub step_damping: f64,
    /// Expected length of a standard normal vector.
    pub expected_length: f64,
}

impl RecombinationWeights {
    /// Computes the constants for a dimension and a population.
    pub fn new(dimension: usize, population: usize) -> Self {
        let n = dimension as f64;
        // Logarithmic weights ln((population + 1) / 2) - ln(rank).
        let raw: Vec<f64> = (1..=population)
            .map(|i| (0.5 * (population as f64 + 1.0)).ln() - (i as f64).ln())
            .collect();
        let parents = raw.iter().filter(|w| **w > 0.0).count();
        let (better, worse) = raw.split_at(parents);
        let mass = effective_mass(better);
        let rank_one_rate = 2.0 / ((n + 1.3).powi(2) + mass);
        let rank_mu_rate = (2.0 * (0.25 + mass + 1.0 / mass - 2.0) / ((n + 2.0).powi(2) + mass))
            .min(1.0 - rank_one_rate);
        // Limits of the sum of the negative weights; the smallest of them applies.
        let against = [
            1.0 + rank_one_rate / rank_mu_rate,
            1.0 + 2.0 * effective_mass(worse) / (mass + 2.0),
            (1.0 - rank_one_rate - rank_mu_rate) / (n * rank_mu_rate),
        ];
        let against = against.into_iter().fold(f64::INFINITY, f64::min);
        let (up, down) = (better.iter().sum::<f64>(), -worse.iter().sum::<f64>());
        let all = raw
            .iter()
            .map(|w| if *w >= 0.0 { w / up } else { against * w / down.max(f64::MIN_POSITIVE) })
            .collect();
        let step_rate = (mass + 2.0) / (n + mass + 5.0);
        Self {
            all,
            parents,
            mass,
            path_rate: (4.0 + mass / n) / (n + 4.0 + 2.0 * mass / n),
            rank_one_rate,
            rank_mu_rate,
            step_rate,
            step_damping: 1.0
                + 2.0 * (((mass - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0)
                + step_rate,
            expected_length: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
        }
    }

    /// Number of generations over which the covariance changes too little for a new decomposition.
    pub fn decomposition_interval(&self, dimension: usize) -> usize {
        (0.5 / (dimension as f64 * (self.rank_one_rate + self.rank_mu_rate))).floor().max(1.0)
            as usize
    }
}

/// Effective number of weights, (sum w)^2 / sum w^2.
fn effective_mass(weights: &[f64]) -> f64 {
    let (sum, squares) =
        weights.iter().fold((0.0, 0.0), |(sum, squares), w| (sum + w, squares + w * w));
    if squares > 0.0 { sum * sum / squares } else { 0.0 }
}
