//! The discrepancies and instruments under which trials are most probable.

use nalgebra::DVector;
use rayon::prelude::*;
use sistership_model::trial::Channel;
use sistership_model::uncertainty::Discrepancy;

use super::super::evidence::Fixed;
use super::super::workspace::{Scales, Workspace};
use super::known::Known;
use crate::residual::{Discrepancies, Linearised, Noise, errors};
use sistership_estimate::refine::RefineError;

/// Levels of the discrepancy that are tried first, by the typical acceleration.
const COARSE: [f64; 7] = [1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2];
/// Factors by which single numbers are then tried, in rounds between which coefficients are fitted anew.
const ROUNDS: [[f64; 2]; 3] = [[8.0, 3.0], [3.0, 1.6], [1.6, 1.2]];
/// The white part that is tried first, by the density of the other at zero frequency.
const WHITE: f64 = 0.05;

/// What readings scatter by beside the model.
#[derive(Debug, Clone)]
pub(super) struct Scatter {
    pub discrepancies: Discrepancies,
    pub noise: Noise,
}

/// One number of it.
#[derive(Debug, Clone, Copy)]
enum Number {
    Deviation(usize),
    White(usize),
    Noise(Channel),
    Drift(Channel),
}

impl Scatter {
    fn times(&self, number: Number, factor: f64) -> Self {
        let mut changed = self.clone();
        let instrument = |noise: &mut Noise, channel| noise.remove(&channel).map(|instrument| (channel, instrument));
        match number {
            Number::Deviation(axis) => changed.discrepancies[axis].deviation *= factor,
            Number::White(axis) => changed.discrepancies[axis].white *= factor,
            Number::Noise(channel) => {
                if let Some((channel, mut own)) = instrument(&mut changed.noise, channel) {
                    own.deviation *= factor;
                    changed.noise.insert(channel, own);
                }
            }
            Number::Drift(channel) => {
                if let Some((channel, mut own)) = instrument(&mut changed.noise, channel) {
                    own.drift *= factor;
                    changed.noise.insert(channel, own);
                }
            }
        }
        changed
    }

    fn numbers(&self) -> Vec<Number> {
        let axes = 0..self.discrepancies.len();
        let of_axes = axes.flat_map(|axis| [Number::Deviation(axis), Number::White(axis)]);
        let follow = [Channel::Psi, Channel::X, Channel::Y];
        let drifts = follow.into_iter().filter(|channel| self.noise.contains_key(channel)).map(Number::Drift);
        of_axes.chain(drifts).chain(self.noise.keys().copied().map(Number::Noise)).collect()
    }
}

/// The most probable scatter, coefficients and scatter being fitted in turn. Each trial is judged by coefficients fitted on
/// the others, so that what these have followed by chance is not taken for knowledge.
///
/// # Errors
/// Says that the information is not positive.
pub(super) fn most_probable(workspace: &Workspace<'_>, fixed: &Fixed, start: Option<Scatter>) -> Result<Scatter, RefineError> {
    let first = if start.is_some() { ROUNDS.len() - 1 } else { 0 };
    let mut best = start.or_else(|| coarse(workspace)).ok_or_else(unlikely)?;
    for factors in &ROUNDS[first..] {
        let coefficients = coefficients(workspace, fixed, &best).ok_or_else(unlikely)?;
        best = refined(workspace, best, &coefficients, factors);
    }
    Ok(best)
}

/// The best of a few levels of discrepancy, the same for all axes.
fn coarse(workspace: &Workspace<'_>) -> Option<Scatter> {
    let as_it_is = vec![vec![0.0; workspace.columns().len()]; workspace.trials.len()];
    let (scales, parts) = (workspace.scales(), along(workspace, &as_it_is));
    let at = |level: &f64| Scatter { discrepancies: scales.discrepancies(*level), noise: workspace.noise.clone() };
    let scored = COARSE.iter().map(at).map(|tried| (deviance(&parts, &tried), tried));
    Some(scored.min_by(|a, b| a.0.total_cmp(&b.0))?.1)
}

fn unlikely() -> RefineError {
    RefineError::Data("the trials' information is not positive".into())
}

/// For each trial the coefficients by the others; of a single trial, by itself.
fn coefficients(workspace: &Workspace<'_>, fixed: &Fixed, scatter: &Scatter) -> Option<Vec<Vec<f64>>> {
    let columns: Vec<usize> = (0..fixed.weighted_mean.len()).collect();
    let grams = workspace.each_under(&scatter.noise, &scatter.discrepancies);
    let grams: Vec<_> = grams.iter().map(|gram| gram.select(&columns)).collect();
    let known = Known { fixed, grams: &grams, scatter: 1.0 };
    let of = |trial: usize| -> Option<Vec<f64>> {
        let mean: DVector<f64> = known.by(&|other| other != trial || grams.len() == 1).mean()?;
        let mut mean = mean.as_slice().to_vec();
        mean.resize(workspace.columns().len(), 0.0);
        Some(mean)
    };
    (0..grams.len()).map(of).collect()
}

/// Parts of trials with all columns in one.
type Parts = Vec<Vec<Linearised>>;

fn along(workspace: &Workspace<'_>, parameters: &[Vec<f64>]) -> Parts {
    let along = |(parts, of): (&Vec<Linearised>, &Vec<f64>)| parts.iter().map(|part| part.along(of)).collect();
    workspace.linear().par_iter().zip(parameters).map(along).collect()
}

/// Minus twice the logarithm of the likelihood.
fn deviance(parts: &Parts, scatter: &Scatter) -> f64 {
    let one = |part: &Linearised| {
        let (errors, log_variance) = errors(part, &scatter.noise, &scatter.discrepancies);
        errors.iter().map(|error| error * error).sum::<f64>() + log_variance
    };
    // Summed in order: the same on any number of threads.
    let trials: Vec<f64> = parts.par_iter().map(|parts| parts.iter().map(one).sum()).collect();
    trials.iter().sum()
}

/// Each number alone, as far as it helps.
fn refined(workspace: &Workspace<'_>, start: Scatter, coefficients: &[Vec<f64>], factors: &[f64]) -> Scatter {
    let parts = along(workspace, coefficients);
    let mut best = (deviance(&parts, &start), start);
    for factor in factors {
        for number in best.1.numbers() {
            for by in [*factor, factor.recip()] {
                loop {
                    let tried = best.1.times(number, by);
                    if !is_possible(workspace, &tried, number) {
                        break;
                    }
                    let deviance = deviance(&parts, &tried);
                    // What is no number is no gain.
                    if deviance.is_nan() || deviance > best.0 - 0.1 {
                        break;
                    }
                    best = (deviance, tried);
                }
            }
        }
    }
    best.1
}

/// No instrument errs by less than its readings scatter.
fn is_possible(workspace: &Workspace<'_>, tried: &Scatter, number: Number) -> bool {
    let (Number::Noise(channel) | Number::Drift(channel)) = number else { return true };
    let pair = workspace.noise.get(&channel).zip(tried.noise.get(&channel));
    pair.is_none_or(|(least, own)| own.deviation >= 0.999 * least.deviation && own.drift >= 0.999 * least.drift)
}

impl Scales {
    /// Discrepancies of a level: a share of the typical acceleration of each axis.
    pub(crate) fn discrepancies(&self, level: f64) -> Discrepancies {
        let time_s = self.time_s;
        let of = |typical: &f64| {
            let deviation = level * typical;
            Discrepancy { deviation, time_s, white: WHITE * deviation * time_s.sqrt() }
        };
        self.accelerations.iter().map(of).collect()
    }
}
