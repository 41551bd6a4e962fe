//! Uncertainty bands: the standard manoeuvres of models drawn from a posterior.

use std::collections::BTreeMap;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sistership_model::Model;
use sistership_model::law::Law;
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{
    ManoeuvreSettings, NamedFigure, StandardManoeuvres, simulate_standard_ensemble,
};

use crate::uncertainty::next_trial::{DrawFigures, NextTrial, next_trial};
use crate::uncertainty::physical::physical_value;
use crate::uncertainty::sampling::{Sampling, draw_from_posterior};

/// Draws that are simulated in lockstep.
const LOCKSTEP_DRAWS: usize = 10;
/// Step of draws in units of the time in which the ship travels its own length. Draws reverse the
/// rudder within a step and are corrected by the estimate at the fine step: bands at this step
/// differ from those at 0.02 by 0.3 % of their width in the median (at most 9 %), draws of another
/// seed by 6 % (a tanker, 152 coefficients, 200 draws).
const STEP: f64 = 0.05;

/// Uncertainty bands of a model's standard manoeuvres.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct UncertaintyBands {
    /// Sampling of the posterior.
    pub sampling: Sampling,
    /// Number of draws that left the physical range in some manoeuvre.
    pub failed: usize,
    /// Bands by figure.
    pub figures: Vec<UncertaintyBand>,
    /// Trial that would narrow the bands most.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub next_trial: Option<NextTrial>,
}

impl UncertaintyBands {
    /// Returns the band of a figure.
    pub fn figure_band(&self, figure: &str) -> Option<&UncertaintyBand> {
        self.figures.iter().find(|band| band.figure == figure)
    }
}

/// The band of a figure: 95 % of the draws that reached it are inside. A draw with an impossible
/// figure, such as a tactical diameter below zero, counts as one that has not reached it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct UncertaintyBand {
    /// Name of the figure.
    pub figure: String,
    /// Its unit.
    pub unit: String,
    /// Quantile of 2.5 %.
    pub low: f64,
    /// Quantile of 97.5 %.
    pub high: f64,
    /// Share of the draws that reached it.
    pub reached: f64,
    /// Share of these that meet the criterion, where it is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pass: Option<f64>,
}

/// Returns the bands of the standard manoeuvres; `None` if the model has no posterior of its
/// present coefficients. The default step is [`STEP`] of the time of a ship length. `depth_m` is
/// for laws that depend on it.
pub fn uncertainty_bands(
    model: &Model,
    law: &Law,
    settings: &ManoeuvreSettings,
    depth_m: Option<f64>,
    sampling: Sampling,
) -> Option<UncertaintyBands> {
    let draws = draw_from_posterior(model, sampling)?;
    let (ship, fast) = prepare_ship(model, law, settings, depth_m)?;
    let sailed = simulate_draws(&ship, &draws, &fast)?;
    // A draw that fails one manoeuvre still gives the figures of the others.
    let failed = sailed.iter().filter(|sailed| !sailed.failures.is_empty()).count();
    // Draws run at a coarse step; the estimate, simulated at both, gives the correction for it.
    let by_step = errors_by_step(&ship, &ship.open_coefficient_values(model)?, settings, &fast);
    let mut figures: BTreeMap<String, Vec<NamedFigure>> = BTreeMap::new();
    let mut order = Vec::new();
    let mut drawn = vec![DrawFigures::new(); sailed.len()];
    for (draw, sailed) in sailed.into_iter().enumerate() {
        for mut figure in sailed.list_figures() {
            // Impossible figures are removed before the quantiles are taken.
            let by_step = by_step.get(&figure.name).copied().unwrap_or(0.0);
            figure.value =
                figure.value.and_then(|value| physical_value(&figure.name, value, by_step));
            drawn[draw].extend(figure.value.map(|value| (figure.name.clone(), value)));
            if !figures.contains_key(&figure.name) {
                order.push(figure.name.clone());
            }
            figures.entry(figure.name.clone()).or_default().push(figure);
        }
    }
    let figures =
        order.iter().filter_map(|name| band_of_draws(&figures[name], draws.len())).collect();
    let next_trial = next_trial(&drawn);
    Some(UncertaintyBands { sampling, failed, figures, next_trial })
}

/// Returns the bands of figures over simulated standard manoeuvres, in the order in which the
/// figures first occur.
pub fn bands_over(sailed: Vec<StandardManoeuvres>) -> Vec<UncertaintyBand> {
    let draws = sailed.len();
    let mut order: Vec<String> = Vec::new();
    let mut figures: BTreeMap<String, Vec<NamedFigure>> = BTreeMap::new();
    for mut figure in sailed.into_iter().flat_map(|sailed| sailed.list_figures()) {
        figure.value = figure.value.and_then(|value| physical_value(&figure.name, value, 0.0));
        if !figures.contains_key(&figure.name) {
            order.push(figure.name.clone());
        }
        figures.entry(figure.name.clone()).or_default().push(figure);
    }
    order.iter().filter_map(|name| band_of_draws(&figures[name], draws)).collect()
}

/// The ship whose coefficients draws replace, and the settings of their simulations, at a coarse
/// step.
fn prepare_ship(
    model: &Model,
    law: &Law,
    settings: &ManoeuvreSettings,
    depth_m: Option<f64>,
) -> Option<(Ship, ManoeuvreSettings)> {
    let mut ship = Ship::with_open_coefficients(model, law).ok()?;
    let speed_m_s = settings.speed_m_s.unwrap_or(ship.approach_speed_m_s());
    // The physical range is set once by the approach speed, since draws share the ship.
    ship.set_envelope_speed(speed_m_s);
    // Draws are simulated outside the range of the trials, too.
    ship.disable_excursions();
    depth_m.into_iter().for_each(|depth_m| ship.set_depth(depth_m));
    let coarse = STEP * ship.lpp_m() / speed_m_s;
    let step_s = settings.step_s.or(Some(coarse));
    // Figures do not need the rest of an initial turn; overshoots need the time of each reversal.
    let fast =
        ManoeuvreSettings { step_s, reversals_within_steps: true, figures_only: true, ..*settings };
    Some((ship, fast))
}

/// Standard manoeuvres of several models, simulated in lockstep; `None` if one of them differs in
/// more than its coefficients.
fn simulate_draws(
    ship: &Ship,
    models: &[Model],
    settings: &ManoeuvreSettings,
) -> Option<Vec<StandardManoeuvres>> {
    let sisters: Vec<Vec<f64>> =
        models.iter().map(|model| ship.open_coefficient_values(model)).collect::<Option<_>>()?;
    let together = |sisters: &[Vec<f64>]| {
        let sisters: Vec<&[f64]> = sisters.iter().map(Vec::as_slice).collect();
        simulate_standard_ensemble(ship, &sisters, settings)
    };
    Some(sisters.par_chunks(LOCKSTEP_DRAWS).flat_map_iter(together).collect())
}

/// Returns the figures of the standard manoeuvres, by their names, of models with the law and
/// particulars of a model; `None` if the law does not fit.
pub fn figures_by_name(model: &Model, law: &Law, models: &[Model]) -> Option<Vec<DrawFigures>> {
    let (ship, fast) = prepare_ship(model, law, &ManoeuvreSettings::default(), None)?;
    let named = |sailed: StandardManoeuvres| {
        let figures = sailed.list_figures().into_iter();
        figures.filter_map(|figure| Some((figure.name, figure.value?))).collect()
    };
    Some(simulate_draws(&ship, models, &fast)?.into_iter().map(named).collect())
}

/// Error of the draws' coarse step in each figure, from the estimate at both steps.
fn errors_by_step(
    ship: &Ship,
    estimate: &[f64],
    settings: &ManoeuvreSettings,
    fast: &ManoeuvreSettings,
) -> BTreeMap<String, f64> {
    let figures = |settings: &ManoeuvreSettings| {
        let sailed = simulate_standard_ensemble(ship, &[estimate], settings).into_iter();
        sailed.flat_map(|sailed| sailed.list_figures()).collect::<Vec<_>>()
    };
    let settings = ManoeuvreSettings { figures_only: fast.figures_only, ..*settings };
    let fine: BTreeMap<String, f64> =
        figures(&settings).into_iter().filter_map(|fine| Some((fine.name, fine.value?))).collect();
    let of = |fast: NamedFigure| Some((fine.get(&fast.name)?, fast.value?, fast.name));
    let fast = figures(fast).into_iter().filter_map(of);
    fast.map(|(fine, fast, name)| (name, fast - fine)).collect()
}

/// The band of a figure over draws.
fn band_of_draws(figures: &[NamedFigure], draws: usize) -> Option<UncertaintyBand> {
    let mut values: Vec<f64> = figures.iter().filter_map(|figure| figure.value).collect();
    values.sort_by(f64::total_cmp);
    let first = figures.first()?;
    let reached = figures.iter().filter(|figure| figure.value.is_some());
    let judged: Vec<bool> = reached.filter_map(|figure| figure.pass).collect();
    let share = |count: usize, all: usize| count as f64 / all as f64;
    Some(UncertaintyBand {
        figure: first.name.clone(),
        unit: first.unit.clone(),
        low: quantile(&values, 0.025)?,
        high: quantile(&values, 0.975)?,
        reached: share(values.len(), draws),
        pass: (!judged.is_empty())
            .then(|| share(judged.iter().filter(|pass| **pass).count(), judged.len())),
    })
}

/// Returns a quantile of sorted values, linear between them (Hyndman and Fan 1996, The American
/// Statistician 50, 361-365, definition 6: without the narrow tails of definition 7). `None`
/// without values.
pub fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    // Definition 6: the k-th of n sorted values is the quantile of `k/(n + 1)`.
    let place = (share * (sorted.len() + 1) as f64 - 1.0).clamp(0.0, last as f64);
    let (below, above) = (place.floor() as usize, place.ceil() as usize);
    Some(sorted[below] + (place - below as f64) * (sorted[above] - sorted[below]))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::Zoo;
    use sistership_model::posterior::Posterior;

    fn mariner(deviation: f64) -> (Model, std::sync::Arc<Law>) {
        let zoo = Zoo::load_embedded().unwrap();
        let mut model = zoo.find_model("mariner").unwrap();
        let names: Vec<String> = ["N_delta", "Y_delta"].map(str::to_owned).to_vec();
        let values: Vec<f64> = names.iter().map(|name| model.coefficient(name)).collect();
        let deviations = values.iter().map(|value| deviation * value.abs()).collect();
        let root_correlation = Posterior::format_rows(2, &|i, j| [[1.0, 0.0], [-0.6, 0.8]][i][j]);
        model.posterior = Some(Posterior { names, values, deviations, root_correlation });
        (model, zoo.law("abkowitz").unwrap().clone())
    }

    #[test]
    fn draws_have_the_posterior_s_covariance_and_the_estimate_in_their_midst() {
        let (model, _) = mariner(0.1);
        let draws = draw_from_posterior(&model, Sampling { samples: 4000, seed: 3 }).unwrap();
        let moved = |name: &str| {
            draws
                .iter()
                .map(|d| d.coefficient(name) / model.coefficient(name) - 1.0)
                .collect::<Vec<f64>>()
        };
        let (a, b) = (moved("N_delta"), moved("Y_delta"));
        let mean = |x: &[f64], y: &[f64]| {
            x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>() / x.len() as f64
        };
        assert!(a.iter().sum::<f64>().abs() < 1e-9);
        assert!((mean(&a, &a).sqrt() - 0.1).abs() < 0.003);
        // N_delta is negative: -0.6 between the coefficients is 0.6 between their relative changes.
        assert!((mean(&a, &b) / mean(&a, &a) - 0.6).abs() < 0.05);
    }

    #[test]
    fn bands_widen_with_the_posterior_and_follow_from_the_seed() {
        let width = |deviation: f64, seed: u64| {
            let (model, law) = mariner(deviation);
            let bands = uncertainty_bands(
                &model,
                &law,
                &ManoeuvreSettings::default(),
                None,
                Sampling { samples: 20, seed },
            )
            .unwrap();
            let band = bands
                .figures
                .iter()
                .find(|band| band.figure == "turn 35 deg: tactical diameter")
                .unwrap()
                .clone();
            assert!(bands.figures.iter().any(|band| band.pass.is_some()));
            band.high - band.low
        };
        assert_eq!(width(0.05, 1), width(0.05, 1));
        assert_ne!(width(0.05, 1), width(0.05, 2));
        assert!(width(0.1, 1) > 1.7 * width(0.05, 1));
    }

    #[test]
    fn narrow_bands_hold_the_estimate_s_figures() {
        let (model, law) = mariner(1e-3);
        let settings = ManoeuvreSettings::default();
        let sampling = Sampling { samples: 40, seed: 2 };
        let bands = uncertainty_bands(&model, &law, &settings, None, sampling).unwrap();
        let ship = Ship::with_open_coefficients(&model, &law).unwrap();
        let own = ship.open_coefficient_values(&model).unwrap();
        for figure in simulate_standard_ensemble(&ship, &[&own], &settings)[0].list_figures() {
            let band = bands.figure_band(&figure.name).unwrap_or_else(|| panic!("{}", figure.name));
            let value = figure.value.unwrap();
            let slack = 1e-3 * (band.high - band.low);
            let inside = (band.low - slack..=band.high + slack).contains(&value);
            assert!(inside, "{}: {value} in {band:?}", figure.name);
        }
        assert!(bands.next_trial.is_some());
    }

    #[test]
    fn a_model_whose_coefficients_were_changed_has_no_bands() {
        let (mut model, law) = mariner(0.1);
        model.coefficients.get_mut("N_delta").unwrap().value *= 1.1;
        assert_eq!(
            uncertainty_bands(
                &model,
                &law,
                &ManoeuvreSettings::default(),
                None,
                Sampling::default()
            ),
            None
        );
    }

    #[test]
    fn quantiles_lie_between_values() {
        let values: Vec<f64> = (1..=99).map(f64::from).collect();
        assert_eq!(quantile(&values, 0.025), Some(2.5));
        assert_eq!(quantile(&values, 0.975), Some(97.5));
        assert_eq!(quantile(&[], 0.5), None);
    }
}
