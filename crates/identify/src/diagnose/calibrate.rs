//! What the trials that a model was fitted on leave open.

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::Cholesky;
use sistership_model::law::Law;
use sistership_model::uncertainty::{Discrepancy, Uncertainty};
use sistership_model::{Effect, Model, Trial};

use super::evidence::{Fixed, Reduced};
use super::nuisance::{lacked, learned, prior, regressor};
use super::workspace::{Scales, Workspace};
use crate::refine::RefineError;
use crate::residual::{Columns, Discrepancies, Gram, Nuisance};

/// How far coefficients may be from the model's before its own trials are asked.
const WIDE: f64 = 1.0;
/// Levels of the discrepancy that are tried first, by the typical acceleration.
const COARSE: [f64; 7] = [1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2];
/// Factors by which single axes are then tried.
const FINE: [f64; 4] = [4.0, 2.0, 1.4, 1.2];
/// The white part that is tried first, by the density of the other at zero frequency.
const WHITE: f64 = 0.05;

/// What the trials that a model was fitted on leave open, to be kept with it. Terms of the library's grammar that the model
/// lacks are learned too, as far as those trials show them.
///
/// # Errors
/// Names the channel that a trial lacks, or says that the information is not positive.
pub fn calibrate(model: &Model, law: &Law, effects: &[Arc<Effect>], trials: &[&Trial]) -> Result<Uncertainty, RefineError> {
    let terms = learned(&lacked(model, law, effects, trials));
    let extra: Vec<_> = terms.iter().filter_map(|(name, form)| Some((name.clone(), regressor(model, form)?.0))).collect();
    let columns = Columns { nuisance: Columns::nuisance(model, law, &extra), candidates: Vec::new() };
    let workspace = Workspace::new(model, law, columns, &terms, trials, None)?;
    let fixed = prior(model, &workspace.columns().nuisance, &terms, WIDE);
    let (discrepancies, gram) = most_probable(&workspace, &fixed);
    uncertainty(&workspace, &fixed, &gram, &discrepancies, trials)
}

/// The discrepancies under which the trials are most probable: first all axes together, then each alone.
fn most_probable(workspace: &Workspace<'_>, fixed: &Fixed) -> (Discrepancies, Gram) {
    let scales = workspace.scales();
    let at = |discrepancies: Discrepancies| {
        let gram = workspace.total(&discrepancies);
        let deviance = Reduced::new(&gram, fixed).map_or(f64::INFINITY, |reduced| reduced.deviance);
        (deviance, discrepancies, gram)
    };
    let coarse = COARSE.iter().map(|level| at(scales.discrepancies(*level)));
    let mut best = coarse.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_else(|| at(scales.discrepancies(1e-3)));
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
    (best.1, best.2)
}

fn deviation(discrepancy: &mut Discrepancy) -> &mut f64 {
    &mut discrepancy.deviation
}

fn white(discrepancy: &mut Discrepancy) -> &mut f64 {
    &mut discrepancy.white
}

fn uncertainty(
    workspace: &Workspace<'_>,
    fixed: &Fixed,
    gram: &Gram,
    discrepancies: &Discrepancies,
    trials: &[&Trial],
) -> Result<Uncertainty, RefineError> {
    let size = fixed.weighted_mean.len();
    let information = gram.products.view((1, 1), (size, size)) + &fixed.information;
    let scales: Vec<f64> = (0..size).map(|i| fixed.information[(i, i)].sqrt().recip()).collect();
    let scaled = nalgebra::DMatrix::from_fn(size, size, |i, j| information[(i, j)] * scales[i] * scales[j]);
    let right = nalgebra::DVector::from_fn(size, |i, _| gram.products[(1 + i, 0)] * scales[i]);
    let factor = Cholesky::new(scaled).ok_or_else(|| RefineError::Data("the trials' information is not positive".into()))?;
    let lower = factor.l();
    let offset = lower.solve_lower_triangular(&right).unwrap_or(right);
    let axes = workspace.axes();
    let discrepancy: BTreeMap<_, Discrepancy> = axes.iter().copied().zip(discrepancies.iter().copied()).collect();
    Ok(Uncertainty {
        names: workspace.columns().nuisance.iter().map(|n: &Nuisance| n.name.clone()).collect(),
        scales,
        root_information: Uncertainty::rows(size, &|i, j| lower[(j, i)]),
        offset: offset.iter().copied().collect(),
        discrepancy,
        trials: trials.iter().map(|trial| trial.name.clone()).collect(),
    })
}

impl Scales {
    /// Discrepancies of a level: a share of the typical acceleration of each axis.
    pub(super) fn discrepancies(&self, level: f64) -> Discrepancies {
        let time_s = self.time_s;
        let of = |typical: &f64| {
            let deviation = level * typical;
            Discrepancy { deviation, time_s, white: WHITE * deviation * time_s.sqrt() }
        };
        self.accelerations.iter().map(of).collect()
    }
}
