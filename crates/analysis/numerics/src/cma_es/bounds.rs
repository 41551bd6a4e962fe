//! A box kept by an adaptive penalty: Hansen et al. 2009, as `pycma`'s `BoundPenalty`.

use std::collections::VecDeque;

use nalgebra::DVector;

use super::strategy::Strategy;

/// Weights of leaving a box from -`widths` to `widths`, by coordinate.
#[derive(Debug, Clone)]
pub(super) struct Bounds {
    widths: Vec<f64>,
    weights: Vec<f64>,
    begun: bool,
    /// Spreads of recent costs by the variance of the coordinates.
    spreads: VecDeque<f64>,
}

impl Bounds {
    pub fn new(widths: &[f64]) -> Self {
        Self {
            widths: widths.to_vec(),
            weights: vec![1.0; widths.len()],
            begun: false,
            spreads: VecDeque::new(),
        }
    }

    /// The point of the box that is nearest.
    pub fn inside(&self, point: &[f64]) -> Vec<f64> {
        point.iter().zip(&self.widths).map(|(x, width)| x.clamp(-width, *width)).collect()
    }

    /// What a candidate pays for being outside.
    pub fn penalty(&self, point: &[f64]) -> f64 {
        let beyond = |(x, width): (&f64, &f64)| (x.abs() - width).max(0.0);
        let one = |(weight, at): (&f64, (&f64, &f64))| weight * beyond(at).powi(2);
        self.weights.iter().zip(point.iter().zip(&self.widths)).map(one).sum::<f64>()
            / point.len() as f64
    }

    /// Adapts the weights to how the costs of a generation (without penalty) spread and to how far
    /// the mean is outside.
    pub fn adapt(&mut self, strategy: &Strategy, costs: &[f64]) {
        let variances = strategy.variances();
        let n = variances.len() as f64;
        self.remember(
            quartiles(costs) / (variances.sum() / n),
            20 + 3 * self.widths.len() / costs.len().max(1),
        );
        let mut recent: Vec<f64> = self.spreads.iter().copied().collect();
        recent.sort_by(f64::total_cmp);
        let Some(&typical) = recent.get(recent.len() / 2) else { return };
        let beyond = self.beyond(strategy.mean(), &variances);
        if !self.begun && beyond.iter().any(|far| *far > 0.0) {
            self.weights.fill(2.0 * typical);
            self.begun = true;
        }
        if self.begun {
            let damping = (strategy.mass() / (10.0 * n)).min(1.0);
            let allowed = 3.0 * (n.sqrt() / strategy.mass()).max(1.0);
            self.reweigh(&beyond, allowed, damping, typical);
        }
    }

    fn remember(&mut self, spread: f64, count: usize) {
        if spread.is_finite() && spread > 0.0 {
            self.spreads.push_front(spread);
        }
        self.spreads.truncate(count);
    }

    /// How far the mean is outside, in standard deviations.
    fn beyond(&self, mean: &DVector<f64>, variances: &DVector<f64>) -> Vec<f64> {
        let one = |((x, width), v): ((&f64, &f64), &f64)| (x.abs() - width).max(0.0) / v.sqrt();
        mean.iter().zip(&self.widths).zip(variances.iter()).map(one).collect()
    }

    fn reweigh(&mut self, beyond: &[f64], allowed: f64, damping: f64, typical: f64) {
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

/// The distance between the quartiles.
fn quartiles(costs: &[f64]) -> f64 {
    let mut sorted = costs.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = |k: usize| sorted.get(k.min(sorted.len().saturating_sub(1))).copied().unwrap_or(0.0);
    at(3 * (sorted.len() + 1) / 4) - at((sorted.len() + 1) / 4)
}

#[cfg(test)]
#[path = "bounds_tests.rs"]
mod tests;
