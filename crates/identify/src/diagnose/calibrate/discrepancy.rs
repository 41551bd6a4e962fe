//! The discrepancy under which trials are most probable.

use rayon::prelude::*;
use sistership_model::uncertainty::Discrepancy;

use super::super::evidence::Fixed;
use super::super::workspace::{Scales, Workspace};
use crate::refine::RefineError;
use crate::residual::{Discrepancies, Gram, Linearised, Noise, errors};

/// Levels that are tried first, by the typical acceleration.
const COARSE: [f64; 7] = [1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2];
/// Factors by which single axes are then tried.
const FINE: [f64; 4] = [4.0, 2.0, 1.4, 1.2];
/// The white part that is tried first, by the density of the other at zero frequency.
const WHITE: f64 = 0.05;
/// How often coefficients and discrepancies are fitted in turn.
const ROUNDS: usize = 3;

/// The most probable discrepancies, coefficients and discrepancies being fitted in turn.
///
/// # Errors
/// Says that the information is not positive.
pub(super) fn most_probable(
    workspace: &Workspace<'_>,
    fixed: &Fixed,
    start: Option<Discrepancies>,
) -> Result<Discrepancies, RefineError> {
    let mut parameters = vec![0.0; workspace.columns().len()];
    let rounds = if start.is_some() { 1 } else { ROUNDS };
    let mut best = start.or_else(|| coarse(workspace, &parameters)).ok_or_else(unlikely)?;
    for _ in 0..rounds {
        let known = coefficients(workspace, fixed, &best).ok_or_else(unlikely)?;
        parameters[..known.len()].copy_from_slice(&known);
        best = refined(workspace, best, &parameters);
    }
    Ok(best)
}

/// The best of a few levels, the same for all axes.
fn coarse(workspace: &Workspace<'_>, parameters: &[f64]) -> Option<Discrepancies> {
    let (scales, as_it_is) = (workspace.scales(), along(workspace, parameters));
    let levels = COARSE.iter().map(|level| scales.discrepancies(*level));
    let scored = levels.map(|tried| (deviance(&as_it_is, &workspace.noise, &tried), tried));
    Some(scored.min_by(|a, b| a.0.total_cmp(&b.0))?.1)
}

fn unlikely() -> RefineError {
    RefineError::Data("the trials' information is not positive".into())
}

fn coefficients(workspace: &Workspace<'_>, fixed: &Fixed, discrepancies: &Discrepancies) -> Option<Vec<f64>> {
    let size = fixed.weighted_mean.len();
    let columns: Vec<usize> = (0..size).collect();
    let gram: Gram = workspace.total(discrepancies).select(&columns);
    let information = gram.products.view((1, 1), (size, size)) + &fixed.information;
    let weighted_mean = gram.products.view((1, 0), (size, 1)).column(0) + &fixed.weighted_mean;
    Some(Fixed { information, weighted_mean }.mean()?.as_slice().to_vec())
}

/// Parts of trials with all columns in one.
type Parts = Vec<Vec<Linearised>>;

fn along(workspace: &Workspace<'_>, parameters: &[f64]) -> Parts {
    let along = |parts: &Vec<Linearised>| parts.iter().map(|part| part.along(parameters)).collect();
    workspace.linear().par_iter().map(along).collect()
}

/// Minus twice the logarithm of the likelihood.
fn deviance(parts: &Parts, noise: &Noise, discrepancies: &Discrepancies) -> f64 {
    let one = |part: &Linearised| {
        let (errors, log_variance) = errors(part, noise, discrepancies);
        errors.iter().map(|error| error * error).sum::<f64>() + log_variance
    };
    // Summed in order: the same on any number of threads.
    let trials: Vec<f64> = parts.par_iter().map(|parts| parts.iter().map(one).sum()).collect();
    trials.iter().sum()
}

/// Each axis and part alone, by smaller and smaller factors.
fn refined(workspace: &Workspace<'_>, best: Discrepancies, parameters: &[f64]) -> Discrepancies {
    let parts = along(workspace, parameters);
    let at = |tried: Discrepancies| (deviance(&parts, &workspace.noise, &tried), tried);
    let mut best = at(best);
    for factor in FINE {
        for axis in 0..best.1.len() {
            for part in [deviation, white] {
                for by in [factor, factor.recip()] {
                    let mut tried = best.1.clone();
                    *part(&mut tried[axis]) *= by;
                    let tried = at(tried);
                    if tried.0 < best.0 {
                        best = tried;
                    }
                }
            }
        }
    }
    best.1
}

fn deviation(discrepancy: &mut Discrepancy) -> &mut f64 {
    &mut discrepancy.deviation
}

fn white(discrepancy: &mut Discrepancy) -> &mut f64 {
    &mut discrepancy.white
}

impl Scales {
    /// Discrepancies of a level: a share of the typical acceleration of each axis.
    pub(in crate::diagnose) fn discrepancies(&self, level: f64) -> Discrepancies {
        let time_s = self.time_s;
        let of = |typical: &f64| {
            let deviation = level * typical;
            Discrepancy { deviation, time_s, white: WHITE * deviation * time_s.sqrt() }
        };
        self.accelerations.iter().map(of).collect()
    }
}
