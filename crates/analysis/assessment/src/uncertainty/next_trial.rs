//! The trial that would narrow the bands most.
//!
//! A trial of a manoeuvre measures its figures. If the draws of the posterior are taken as normal,
//! the remaining variance of another figure is `S_kk - S_kf S_ff^-1 S_fk`, `S` being the covariance
//! of the figures over the draws and `f` the measured ones: the residual of the figure's regression
//! on them.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// Singular values below this share of the largest count as zero: mirrored manoeuvres have the same
/// information.
const LEAST_SINGULAR: f64 = 1e-6;

/// Scatter, as a share of the mean, below which it is rounding error.
const LEAST_SCATTER: f64 = 1e-9;

/// A manoeuvre, with the gain of a trial of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NextTrial {
    /// The manoeuvre, such as `turn 35 deg`.
    pub manoeuvre: String,
    /// Reduction of the width of the bands of all standard manoeuvres, as a share, in the mean,
    /// weighted by relative width.
    pub narrower: f64,
}

impl NextTrial {
    /// Returns the advice as a sentence.
    pub fn as_sentence(&self) -> String {
        let Self { manoeuvre, narrower } = self;
        let percent = 100.0 * narrower;
        format!(
            "most informative next trial: {manoeuvre}; it would narrow the bands of the standard \
             manoeuvres by {percent:.0} % on average"
        )
    }
}

/// Figures of a draw by name.
pub type DrawFigures = BTreeMap<String, f64>;

/// Returns the most informative manoeuvre; `None` if fewer draws than twice the number of figures
/// reached all of them, or if no figure scatters.
pub(crate) fn next_trial(draws: &[DrawFigures]) -> Option<NextTrial> {
    let most = draws.iter().max_by_key(|draw| draw.len())?;
    let mut names: Vec<&String> =
        most.keys().filter(|name| figure_manoeuvre(name).is_some()).collect();
    // A covariance needs draws that reached every figure.
    let complete: Vec<&DrawFigures> =
        draws.iter().filter(|draw| names.iter().all(|name| draw.contains_key(*name))).collect();
    // With fewer draws the covariance of the figures is too uncertain, or singular.
    if complete.len() < 2 * names.len().max(1) {
        return None;
    }
    names.retain(|name| relative_scatter(&complete, name) > LEAST_SCATTER);
    let columns: Vec<DVector<f64>> =
        names.iter().map(|name| centred_figure(&complete, name)).collect();
    let weights: Vec<f64> = names.iter().map(|name| relative_scatter(&complete, name)).collect();
    let told = |of: &str| {
        let own: Vec<&DVector<f64>> = (names.iter().zip(&columns))
            .filter_map(|(name, column)| (figure_manoeuvre(name) == Some(of)).then_some(column))
            .collect();
        Some(NextTrial {
            manoeuvre: of.to_owned(),
            narrower: mean_narrowing(&own, &columns, &weights)?,
        })
    };
    let mut manoeuvres: Vec<&str> =
        names.iter().filter_map(|name| figure_manoeuvre(name)).collect();
    // Figures are in the order of their names, so that those of a manoeuvre are neighbours.
    manoeuvres.dedup();
    let tried = manoeuvres.into_iter().filter_map(told).filter(|one| one.narrower > 0.0);
    tried.max_by(|a, b| a.narrower.total_cmp(&b.narrower))
}

/// The manoeuvre of a figure; `None` for criteria.
fn figure_manoeuvre(figure: &str) -> Option<&str> {
    let (manoeuvre, _) = figure.split_once(": ")?;
    (manoeuvre != "IMO").then_some(manoeuvre)
}

fn mean(draws: &[&DrawFigures], name: &str) -> f64 {
    draws.iter().map(|draw| draw[name]).sum::<f64>() / draws.len() as f64
}

/// A figure over draws, less its mean.
fn centred_figure(draws: &[&DrawFigures], name: &str) -> DVector<f64> {
    let mean = mean(draws, name);
    DVector::from_iterator(draws.len(), draws.iter().map(|draw| draw[name] - mean))
}

/// Standard deviation divided by the mean, so that metres, degrees and seconds can be averaged.
fn relative_scatter(draws: &[&DrawFigures], name: &str) -> f64 {
    let scatter = (centred_figure(draws, name).norm_squared() / draws.len() as f64).sqrt();
    scatter / mean(draws, name).abs().max(f64::MIN_POSITIVE)
}

/// Reduction of the width of the figures, as a share, in the weighted mean, if some are measured.
fn mean_narrowing(
    told: &[&DVector<f64>],
    figures: &[DVector<f64>],
    weights: &[f64],
) -> Option<f64> {
    let scaled: Vec<DVector<f64>> = told.iter().map(|column| column.normalize()).collect();
    let svd = DMatrix::from_columns(&scaled).svd(true, false);
    let largest = svd.singular_values.max();
    // The left singular vectors are an orthonormal basis of the measured figures: projection on it
    // is the regression on them, also where they are collinear.
    let axes = svd.u?;
    let known = |figure: &DVector<f64>| {
        let singular = svd.singular_values.iter().enumerate();
        let kept = singular.filter(|(_, value)| **value > LEAST_SINGULAR * largest);
        kept.map(|(axis, _)| axes.column(axis).dot(figure).powi(2)).sum::<f64>()
    };
    let share = |figure: &DVector<f64>| {
        let all = figure.norm_squared();
        if all > 0.0 { 1.0 - (1.0 - known(figure) / all).max(0.0).sqrt() } else { 0.0 }
    };
    let sum: f64 = weights.iter().sum();
    let gained: f64 = figures.iter().zip(weights).map(|(figure, w)| w * share(figure)).sum();
    (sum > 0.0).then(|| gained / sum)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha12Rng;
    use rand_distr::StandardNormal;

    use super::*;

    /// `a` is wide and follows `b` but for a share; `c` is narrow.
    fn draws(share: f64) -> Vec<DrawFigures> {
        let mut rng = ChaCha12Rng::seed_from_u64(4);
        let mut one = |_| {
            let [x, y, z]: [f64; 3] = std::array::from_fn(|_| rng.sample(StandardNormal));
            let a = (1.0 - share * share).sqrt() * x + share * y;
            [("a: advance", 500.0 + 50.0 * a), ("b: advance", 400.0 + 20.0 * x)]
                .into_iter()
                .chain([("c: period", 90.0 + 0.1 * z), ("IMO: advance", 3.0 + a)])
                .map(|(name, value)| (name.to_owned(), value))
                .collect()
        };
        (0..400).map(&mut one).collect()
    }

    #[test]
    fn the_widest_figure_is_told_by_its_own_manoeuvre() {
        let next = next_trial(&draws(0.6)).unwrap();
        assert_eq!(next.manoeuvre, "a");
        // Its own band goes, and of the other remains 0.6; weights are as 0.1 to 0.05 to 0.001.
        let expected = (0.1 + 0.05 * 0.4) / 0.151;
        assert!((next.narrower - expected).abs() < 0.03, "{next:?}");
    }

    #[test]
    fn nothing_is_said_where_nothing_scatters() {
        let same: Vec<DrawFigures> = vec![draws(0.5)[0].clone(); 50];
        assert_eq!(next_trial(&same), None);
        assert_eq!(next_trial(&draws(0.5)[..4]), None);
    }
}
