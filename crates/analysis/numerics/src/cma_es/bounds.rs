//! Box constraints by an adaptive penalty: Hansen et al. 2009, as `pycma`'s `BoundPenalty`.

use std::collections::VecDeque;

use nalgebra::DVector;

use super::strategy::EvolutionStrategy;

/// Penalty weights of leaving a box from -`widths` to `widths`, by coordinate.
#[derive(Debug, Clone)]
pub(super) struct BoundPenalty {
    widths: Vec<f64>,
    weights: Vec<f64>,
    begun: bool,
    /// Spreads of recent costs, relative to the variance of the coordinates.
    spreads: VecDeque<f64>,
}

impl BoundPenalty {
    /// Creates a penalty that is not active yet.
    pub fn new(widths: &[f64]) -> Self {
        Self {
            widths: widths.to_vec(),
            weights: vec![1.0; widths.len()],
            begun: false,
            spreads: VecDeque::new(),
        }
    }

    /// Nearest point of the box.
    pub fn nearest_inside(&self, point: &[f64]) -> Vec<f64> {
        point.iter().zip(&self.widths).map(|(x, width)| x.clamp(-width, *width)).collect()
    }

    /// Penalty of a candidate outside the box.
    pub fn penalty_at(&self, point: &[f64]) -> f64 {
        let beyond = |(x, width): (&f64, &f64)| (x.abs() - width).max(0.0);
        // Quadratic in the distance from the box, per coordinate.
        let one = |(weight, at): (&f64, (&f64, &f64))| weight * beyond(at).powi(2);
        self.weights.iter().zip(point.iter().zip(&self.widths)).map(one).sum::<f64>()
            / point.len() as f64
    }

    /// Adapts the weights to the spread of the costs of a generation (without penalty) and to the
    /// distance of the mean from the box.
    pub fn adapt_weights(&mut self, strategy: &EvolutionStrategy, costs: &[f64]) {
        let variances = strategy.coordinate_variances();
        let n = variances.len() as f64;
        self.record_spread(
            // The spread of costs per variance of the coordinates estimates the curvature of the
            // cost.
            interquartile_range(costs) / (variances.sum() / n),
            20 + 3 * self.widths.len() / costs.len().max(1),
        );
        let mut recent: Vec<f64> = self.spreads.iter().copied().collect();
        recent.sort_by(f64::total_cmp);
        let Some(&typical) = recent.get(recent.len() / 2) else { return };
        let beyond = self.distance_outside(strategy.mean(), &variances);
        // The penalty starts when the mean leaves the box for the first time.
        if !self.begun && beyond.iter().any(|far| *far > 0.0) {
            self.weights.fill(2.0 * typical);
            self.begun = true;
        }
        if self.begun {
            let damping = (strategy.selection_mass() / (10.0 * n)).min(1.0);
            // Distance at which the weight of a coordinate starts to increase, in standard
            // deviations.
            let allowed = 3.0 * (n.sqrt() / strategy.selection_mass()).max(1.0);
            self.update_weights(&beyond, allowed, damping, typical);
        }
    }

    /// Adds a spread to the recent ones, of which at most `count` are kept.
    fn record_spread(&mut self, spread: f64, count: usize) {
        if spread.is_finite() && spread > 0.0 {
            self.spreads.push_front(spread);
        }
        self.spreads.truncate(count);
    }

    /// Distance of the mean from the box, in standard deviations.
    fn distance_outside(&self, mean: &DVector<f64>, variances: &DVector<f64>) -> Vec<f64> {
        let one = |((x, width), v): ((&f64, &f64), &f64)| (x.abs() - width).max(0.0) / v.sqrt();
        mean.iter().zip(&self.widths).zip(variances.iter()).map(one).collect()
    }

    /// Increases the weights of coordinates that are too far outside, and reduces very large ones.
    fn update_weights(&mut self, beyond: &[f64], allowed: f64, damping: f64, typical: f64) {
        for (weight, far) in self.weights.iter_mut().zip(beyond) {
            if *far > allowed {
                *weight *= (0.5 * damping * ((far - allowed) / 3.0).tanh()).exp();
            }
            if *weight > 5.0 * typical {
                *weight *= (-damping / 3.0).exp();
            }
        }
    }
}

/// Interquartile range of the costs.
fn interquartile_range(costs: &[f64]) -> f64 {
    let mut sorted = costs.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = |k: usize| sorted.get(k.min(sorted.len().saturating_sub(1))).copied().unwrap_or(0.0);
    at(3 * (sorted.len() + 1) / 4) - at((sorted.len() + 1) / 4)
}

#[cfg(test)]
#[path = "bounds_tests.rs"]
mod tests;
