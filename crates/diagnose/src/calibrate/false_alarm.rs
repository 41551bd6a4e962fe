//! What effects would explain of trials that do not have them.
//!
//! The discrepancy is a random motion; what a law cannot follow is not, and an effect that resembles it would be believed.
//! How often that is so is measured: on each clean trial, under coefficients fitted on the others, and on all together.

use std::collections::BTreeMap;

use rayon::prelude::*;
use sistership_model::uncertainty::FalseAlarmLevel;

use super::super::evidence::{Fixing, Reduced};
use super::super::search::priors;
use super::super::workspace::Workspace;
use super::known::Known;
use crate::residual::Candidate;

/// By `effect/form`.
pub(super) fn levels(
    workspace: &Workspace<'_>,
    known: &Known<'_>,
    candidates: &[Candidate],
) -> BTreeMap<String, FalseAlarmLevel> {
    let size = known.fixed.weighted_mean.len();
    let columns: Vec<usize> = candidates.iter().flat_map(|candidate| workspace.columns().showing(candidate)).collect();
    let places: Vec<usize> = (0..size).chain(columns).collect();
    let alone = |trial: usize| Reduced::new(&known.grams[trial].select(&places), &known.by(&|t| t != trial));
    let single: Vec<Reduced> = (0..known.grams.len()).into_par_iter().filter_map(alone).collect();
    let Some(total) = single.iter().cloned().reduce(Reduced::plus) else { return BTreeMap::new() };
    let mut first = 0;
    let mut of = |candidate: &Candidate| {
        let columns: Vec<usize> = (first..first + candidate.at.len()).collect();
        first += candidate.at.len();
        let fixing: Vec<Fixing> = priors(candidate);
        let each = ratio(single.iter(), &columns, &fixing);
        let together = ratio(std::iter::once(&total), &columns, &fixing);
        let rounded = |x: f64| (1e3 * x).round() / 1e3;
        (candidate.key(), FalseAlarmLevel { each: rounded(each), together: rounded(together) })
    };
    candidates.iter().map(&mut of).collect()
}

/// Explained by what chance explains; one where no trial says anything of the effect.
fn ratio<'a>(reduced: impl Iterator<Item = &'a Reduced>, columns: &[usize], fixing: &[Fixing]) -> f64 {
    let parts = reduced.filter_map(|reduced| reduced.explained(columns, fixing));
    let (explained, chance) = parts.fold((0.0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1));
    if chance > 1e-3 { explained / chance } else { 1.0 }
}
