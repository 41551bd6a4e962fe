//! Scatter of the models of folds in the standard manoeuvres.

use std::collections::BTreeMap;

use sistership_simulation::manoeuvre::StandardManoeuvres;

/// Returns the ratio of the variances of the figures of the standard manoeuvres over two sets of
/// folds, `after` to `before`: the geometric mean over the figures that all of `before` reach;
/// infinite if one of `after` does not reach such a figure, 1 if no figure scatters.
pub(super) fn scatter_ratio(before: &[StandardManoeuvres], after: &[StandardManoeuvres]) -> f64 {
    let [before, after] =
        [before, after].map(|all| all.iter().map(reached_figures).collect::<Vec<_>>());
    let names = before.first().into_iter().flat_map(BTreeMap::keys);
    let variances = names.filter_map(|name| Some((name, figure_variance(&before, name)?)));
    let ratios: Vec<f64> = variances
        .filter(|(_, own)| *own > 0.0)
        .map(|(name, own)| {
            figure_variance(&after, name).map_or(f64::INFINITY, |other| (other / own).ln())
        })
        .collect();
    if ratios.is_empty() {
        return 1.0;
    }
    (ratios.iter().sum::<f64>() / ratios.len() as f64).exp()
}

/// Figures that are reached, without the IMO criteria, which repeat them.
fn reached_figures(sailed: &StandardManoeuvres) -> BTreeMap<String, f64> {
    let reached = sailed.list_figures().into_iter();
    let reached = reached.filter_map(|figure| Some((figure.name, figure.value?)));
    reached.filter(|(name, _)| !name.starts_with("IMO")).collect()
}

/// Variance of a figure; `None` if one of all does not reach it.
fn figure_variance(all: &[BTreeMap<String, f64>], name: &str) -> Option<f64> {
    let values: Vec<f64> = all.iter().map(|one| one.get(name).copied()).collect::<Option<_>>()?;
    if values.is_empty() {
        return None;
    }
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    Some(values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_identification::testing::{mariner_model, with_scaled_coefficients};
    use sistership_simulation::Ship;
    use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_standard_manoeuvres};

    #[test]
    fn twice_the_scatter_is_four_times_the_variance() {
        let (model, law) = mariner_model();
        let sailed = |apart: f64| -> Vec<StandardManoeuvres> {
            let one = |by: f64| {
                let moved = with_scaled_coefficients(&model, |name| {
                    if name == "N_delta" { 1.0 + by } else { 1.0 }
                });
                simulate_standard_manoeuvres(
                    &Ship::new(&moved, &law).unwrap(),
                    &ManoeuvreSettings::default(),
                )
            };
            vec![one(-apart), one(0.0), one(apart)]
        };
        let (near, far) = (sailed(0.02), sailed(0.04));
        let ratio = scatter_ratio(&near, &far);
        assert!((ratio / 4.0 - 1.0).abs() < 0.25, "{ratio}");
        assert!((scatter_ratio(&near, &near) - 1.0).abs() < 1e-12);
        assert_eq!(scatter_ratio(&near, &[]), f64::INFINITY);
    }
}
