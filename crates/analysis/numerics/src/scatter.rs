//! Scatter of several vectors about a robust mean, as the covariance of a prior.

use nalgebra::{DMatrix, DVector};

use crate::PriorMetric;

/// Mean and scatter of members.
#[derive(Debug, Clone)]
pub struct RobustScatter {
    /// Robust means, by target.
    pub means: Vec<DVector<f64>>,
    /// Scatter matrix over all targets, each scaled by its own size; of trace 1.
    matrix: DMatrix<f64>,
}

impl RobustScatter {
    /// Computes mean and scatter of coordinates by target and member, with `rounds` iterations of
    /// the robust mean.
    pub fn new(coordinates: &[Vec<DVector<f64>>], rounds: usize) -> Self {
        let size = coordinates.first().and_then(|all| all.first()).map_or(0, DVector::len);
        let mut matrix = DMatrix::zeros(size, size);
        let mut means = Vec::new();
        for members in coordinates {
            let (mean, weights) = weighted_mean(members, rounds);
            let away: Vec<DVector<f64>> =
                members.iter().zip(&weights).map(|(z, w)| (z - &mean) * *w).collect();
            let sum: f64 = away.iter().map(DVector::norm_squared).sum();
            let share = 1.0 / (sum * coordinates.len() as f64).max(f64::MIN_POSITIVE);
            away.iter().for_each(|away| matrix.ger(share, away, away, 1.0));
            means.push(mean);
        }
        Self { means, matrix }
    }

    /// Precision of coefficients, whose coordinates are given by a metric, with a share `outside`
    /// of their variance in directions that no member shows. Returns `None` if the covariance is
    /// not positive definite.
    pub fn coefficient_precision(
        &self,
        metric: &PriorMetric,
        outside: f64,
    ) -> Option<DMatrix<f64>> {
        let size = metric.coefficient_count();
        let moving = (0..size).filter(|k| !metric.is_fixed(*k)).count() as f64;
        // Scaled so that the trace equals the number of varying coefficients, as for the identity.
        let mut covariance = &self.matrix * ((1.0 - outside) * moving);
        (0..size).for_each(|k| covariance[(k, k)] += outside);
        let precision = metric.root_matrix().transpose()
            * covariance.cholesky()?.inverse()
            * metric.root_matrix();
        // Rounding leaves the product slightly asymmetric.
        Some((&precision + precision.transpose()) * 0.5)
    }
}

/// Robust mean of members, and their weights: a member that is further from it than the median
/// counts as if it were at that distance (Huber 1981, Robust Statistics, section 8.4: a monotone
/// M-estimate).
fn weighted_mean(members: &[DVector<f64>], rounds: usize) -> (DVector<f64>, Vec<f64>) {
    let mut weights = vec![1.0; members.len()];
    let mean = |weights: &[f64]| {
        let sum = members.iter().zip(weights).map(|(z, w)| z * *w).sum::<DVector<f64>>();
        sum / weights.iter().sum::<f64>()
    };
    for _ in 0..rounds {
        let centre = mean(&weights);
        let far: Vec<f64> = members.iter().map(|z| (z - &centre).norm()).collect();
        let mut sorted = far.clone();
        sorted.sort_by(f64::total_cmp);
        let middle = sorted[sorted.len() / 2];
        // Huber weights with the median distance as their limit.
        weights = far.iter().map(|far| if *far > middle { middle / far } else { 1.0 }).collect();
    }
    (mean(&weights), weights)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const ROUNDS: usize = 10;
    const OUTSIDE: f64 = 0.1;

    fn members() -> Vec<DVector<f64>> {
        let along = [-1.2, -0.7, -0.1, 0.3, 0.6, 1.1];
        along.iter().map(|t| DVector::from_vec(vec![1.0 + 3.0 * t, 2.0 - t, 5.0])).collect()
    }

    #[test]
    fn one_ship_that_is_nothing_like_the_others_hardly_moves_the_mean() {
        let (before, _) = weighted_mean(&members(), ROUNDS);
        let far = DVector::from_vec(vec![400.0, -900.0, 70.0]);
        let (after, weights) = weighted_mean(&[members(), vec![far]].concat(), ROUNDS);
        assert!((&after - &before).norm() < 1.5, "{after}");
        assert!(weights[6] < 0.01);
    }

    #[test]
    fn what_ships_differ_by_is_held_least() {
        let metric = PriorMetric::of_precision(&DMatrix::identity(3, 3)).unwrap();
        let scatter = RobustScatter::new(&[members()], ROUNDS);
        assert!((scatter.matrix.trace() - 1.0).abs() < 1e-12);
        let precision = scatter.coefficient_precision(&metric, OUTSIDE).unwrap();
        let held = |along: [f64; 3]| {
            let along = DVector::from_row_slice(&along).normalize();
            along.dot(&(&precision * &along))
        };
        let (shown, never) = (held([3.0, -1.0, 0.0]), held([0.0, 0.0, 1.0]));
        assert!((never * OUTSIDE - 1.0).abs() < 1e-9, "{never}");
        assert!(shown < 0.4 && shown > 0.3, "a third of what all alike would be: {shown}");
    }

    /// Members that are all as far from their mean count alike: the scatter is their covariance, by
    /// its trace, and a coefficient that nothing moves has no part in it.
    #[test]
    fn the_precision_is_that_of_the_members_and_of_what_none_shows() {
        let member = |a: f64, b: f64| DVector::from_vec(vec![5.0 + a, b - 2.0, 0.0]);
        let first =
            vec![member(0.6, 0.8), member(-0.6, -0.8), member(0.8, -0.6), member(-0.8, 0.6)];
        let second = vec![member(2.0, 0.0), member(-2.0, 0.0)];
        let scatter = RobustScatter::new(&[first, second], ROUNDS);
        for mean in &scatter.means {
            assert!((mean - DVector::from_vec(vec![5.0, -2.0, 0.0])).norm() < 1e-12);
        }
        // Each target by its own size: (1/2, 1/2) and (1, 0), in the mean.
        let direct = DMatrix::from_diagonal(&DVector::from_vec(vec![0.75, 0.25, 0.0]));
        assert!((&scatter.matrix - &direct).amax() < 1e-12, "{}", scatter.matrix);
        let own = DMatrix::from_diagonal(&DVector::from_vec(vec![4.0, 9.0, 0.0]));
        let metric = PriorMetric::of_precision(&own).unwrap();
        let precision = scatter.coefficient_precision(&metric, OUTSIDE).unwrap();
        // Two coefficients move.
        let variance = |share: f64| (1.0 - OUTSIDE) * 2.0 * share + OUTSIDE;
        let expected = [4.0 / variance(0.75), 9.0 / variance(0.25), 0.0];
        for i in 0..3 {
            for j in 0..3 {
                let expected = if i == j { expected[i] } else { 0.0 };
                assert!((precision[(i, j)] - expected).abs() < 1e-12, "{precision}");
            }
        }
    }

    /// One that is `k` times as far as the median counts one `k`-th.
    #[test]
    fn a_member_counts_less_by_how_far_it_is() {
        let along = [-1.0, 0.0, 1.0].map(|t| DVector::from_vec(vec![t]));
        let far = DVector::from_vec(vec![40.0]);
        let (mean, weights) = weighted_mean(&[along.as_slice(), &[far]].concat(), 200);
        let distance = |t: f64| (t - mean[0]).abs();
        let mut all = [-1.0, 0.0, 1.0, 40.0].map(distance);
        all.sort_by(f64::total_cmp);
        let median = all[2];
        for (t, weight) in [-1.0, 0.0, 1.0, 40.0].into_iter().zip(&weights) {
            let expected = (median / distance(t)).min(1.0);
            assert!((weight - expected).abs() < 1e-9, "{t}: {weight} {expected}");
        }
        let sum: f64 = weights.iter().sum();
        let direct = (-weights[0] + weights[2] + 40.0 * weights[3]) / sum;
        assert!((mean[0] - direct).abs() < 1e-12);
    }
}
