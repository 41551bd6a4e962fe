//! From a request to a search: which forms are tried, what the coefficients are left, which discrepancy is expected.

use std::collections::BTreeMap;
use std::sync::Arc;

use sistership_model::effect::Form;
use sistership_model::law::Law;
use sistership_model::{Effect, Model, Trial};

use super::Request;
use super::evidence::Level;
use super::learned::Learned;
use super::nuisance::{Terms, columns, lacked, learned, learned_prior, prior};
use super::search::Search;
use super::workspace::Workspace;
use crate::residual::{Candidate, Columns, Discrepancies};
use sistership_estimate::refine::RefineError;

/// Levels of the discrepancy where the model brings one, as factors on it, and the spread of their prior's logarithm.
const FACTORS: [f64; 3] = [1.0, 3.0, 10.0];
const SPREAD: f64 = 1.0;
/// Levels where it brings none, as factors on a hundred-thousandth of the typical acceleration; all equally probable.
const UNKNOWN: [f64; 7] = [1.0, 4.0, 16.0, 64.0, 256.0, 1024.0, 4096.0];
const LEAST: f64 = 1e-5;

/// The forms that can be tried on trials: those whose channels every trial has, of effects that the model does not carry,
/// but for what its instruments are known to do.
pub(super) fn listed(model: &Model, law: &Law, effects: &[Arc<Effect>], trials: &[&Trial]) -> Vec<Candidate> {
    let carried = |effect: &&Arc<Effect>| !model.effects.iter().any(|applied| applied.name == effect.name);
    let systematic_errors = model.uncertainty.as_ref().map(|known| known.systematic_errors.as_slice()).unwrap_or_default();
    let of = |effect: &Arc<Effect>| -> Vec<Candidate> {
        let is_systematic =
            |form: &Form| systematic_errors.iter().any(|error| error.name == effect.name && error.form.name == form.file.name);
        let forms = effect.forms.iter().filter(|form| fits(form, law, trials) && !is_systematic(form));
        forms.map(|form| Candidate::absent(&effect.name, form)).collect()
    };
    effects.iter().filter(carried).flat_map(of).collect()
}

/// The terms that the library's grammars spell.
fn freed(request: &Request<'_>) -> Vec<Candidate> {
    let terms = lacked(request.model, request.law, request.effects, request.trials);
    terms.iter().map(|(effect, form)| Candidate::absent(effect, form)).collect()
}

fn fits(form: &Form, law: &Law, trials: &[&Trial]) -> bool {
    let everywhere = |channel: &_| trials.iter().all(|trial: &&Trial| trial.channel(*channel).is_some());
    let somewhere = |channel: &_| trials.iter().any(|trial: &&Trial| trial.channel(*channel).is_some());
    let rolls = form.file.only_without_roll && law.has_roll();
    form.file.needs.iter().all(everywhere) && !form.file.unless.iter().any(somewhere) && !rolls
}

/// Every effect is as probable as another, and so is every form of it.
fn log_priors<'a>(candidates: impl Iterator<Item = &'a Candidate> + Clone) -> BTreeMap<String, f64> {
    let mut forms: BTreeMap<&str, f64> = BTreeMap::new();
    candidates.clone().for_each(|candidate| *forms.entry(&candidate.effect).or_default() += 1.0);
    let effects = forms.len() as f64;
    candidates.map(|candidate| (candidate.key(), -(effects * forms[candidate.effect.as_str()]).ln())).collect()
}

/// # Errors
/// Names what the model or a trial lacks.
pub(super) fn search<'a>(request: &Request<'a>) -> Result<Search<'a>, RefineError> {
    let listed = listed(request.model, request.law, request.effects, request.trials);
    let freed = freed(request);
    let terms: Terms = learned(request.model, request.law, request.effects, request.trials);
    let nuisance = columns(request.model, request.law);
    let (fixed, levels) = match &request.model.uncertainty {
        Some(uncertainty) => {
            (learned_prior(uncertainty).map_err(|e| RefineError::Law(e.to_string()))?, FACTORS.map(known).to_vec())
        }
        None => (prior(request.model, &nuisance, &terms, request.settings.slack), UNKNOWN.map(unknown).to_vec()),
    };
    let shift =
        fixed.expected_shift(&nuisance).ok_or_else(|| RefineError::Law("what it knows of itself is not positive".into()))?;
    let mut search = Search {
        model: request.model,
        law: request.law,
        learned: Learned::new(request.model, request.law, &terms, &nuisance, &shift)?,
        trials: request.trials,
        nuisance,
        terms,
        fixed: fixed.from(&shift),
        calibrated_at_first: shift.clone(),
        calibrated: shift,
        expected: Vec::new(),
        levels,
        least_step_s: request.settings.least_step_s,
        log_priors: log_priors(listed.iter().chain(&freed)),
        listed,
        freed,
    };
    search.expected = expected(request, &search)?;
    Ok(search)
}

fn known(factor: f64) -> Level {
    Level { factor, log_prior: -0.5 * (factor.ln() / SPREAD).powi(2) }
}

fn unknown(factor: f64) -> Level {
    Level { factor, log_prior: 0.0 }
}

/// The discrepancy that the model brings with it, or the least that is weighed.
fn expected(request: &Request<'_>, search: &Search<'_>) -> Result<Discrepancies, RefineError> {
    let columns = Columns::default();
    let workspace = Workspace::new(&search.learned, columns, search.trials, Some(f64::MAX))?;
    let mut expected = workspace.scales().discrepancies(LEAST);
    if let Some(uncertainty) = &request.model.uncertainty {
        for (axis, discrepancy) in workspace.axes().iter().zip(&mut expected) {
            if let Some(known) = uncertainty.discrepancy.get(axis) {
                *discrepancy = *known;
            }
        }
    }
    Ok(expected)
}
