//! The whole diagnosis.

use super::Request;
use super::choose::{Choice, Settled, choose};
use super::confounded::Responses;
use super::judge::errors;
use super::next_trial::next_trial;
use super::outcome::{Diagnosis, Found, Hypothesis, NextTrial, Unexplained, Verdict};
use super::refit::refits;
use super::remainder::unexplained;
use super::search::{Judged, Search};
use super::series::{levels, residuals};
use super::setup::search;
use super::values::{acts_on, own_covariance, values};
use crate::refine::{Progress, RefineError};

/// Diagnoses a model on trials.
///
/// # Errors
/// Says which setting, trial or channel is at fault.
pub fn diagnose(request: &Request<'_>, progress: Progress<'_>) -> Result<Diagnosis, RefineError> {
    request.settings.check().map_err(|(field, message)| RefineError::Setting { field, message })?;
    if request.trials.is_empty() {
        return Err(RefineError::Data("there is no trial to diagnose on".into()));
    }
    step(progress, 0.05, "which effects can be tried on these trials")?;
    let search = search(request)?;
    step(progress, 0.1, "every effect alone, then together")?;
    let choice = choose(&search, request.settings)?;
    step(progress, 0.8, "what remains")?;
    answer(request, &search, choice, progress)
}

fn step(progress: Progress<'_>, fraction: f64, what: &str) -> Result<(), RefineError> {
    if progress(fraction, what) { Ok(()) } else { Err(RefineError::Cancelled) }
}

fn answer(request: &Request<'_>, first: &Search<'_>, choice: Choice, progress: Progress<'_>) -> Result<Diagnosis, RefineError> {
    let Believed { choice, settled, remaining, refused } = believed(request, first, choice, progress)?;
    let Settled { search, base, best } = &settled;
    let workspace = &base.workspace;
    let length_s = workspace.lpp_m / workspace.speed_m_s;
    step(progress, 0.85, "simulating each trial by a fit on the others")?;
    let restart_s = request.settings.restart_s.unwrap_or(10.0 * length_s);
    let mut refits = refits(request, search, best, restart_s);
    let errors = errors(request, &refits, restart_s);
    let taken = refits.swap_remove(errors.taken);
    step(progress, 0.95, "what these trials cannot tell apart")?;
    let (found, next_trial) = apart(request, search, best, choice.best().log_evidence - choice.alone.log_evidence)?;
    let verdict = match (remaining.is_empty(), found.is_empty()) {
        (false, _) => Verdict::Unexplained,
        (true, true) => Verdict::Complete,
        (true, false) => Verdict::Effects,
    };
    let model = (!found.is_empty() && errors.change < 0.0).then_some(taken.all);
    let is_better = found.is_empty() || model.is_some();
    Ok(Diagnosis {
        verdict,
        effects: found,
        unexplained: remaining,
        next_trial,
        before: errors.before,
        after: errors.after,
        noise: workspace.noise.iter().map(|(channel, instrument)| (channel.name().to_owned(), instrument.deviation)).collect(),
        how: how(request, taken.how.as_deref()),
        diagnosed: request.model.name.clone(),
        hypotheses: hypotheses(request, search, &choice),
        trials: errors.trials,
        manoeuvres: errors.manoeuvres,
        residuals: residuals(first, search, best)?,
        discrepancies: levels(search, workspace, &choice.alone, best),
        model,
        settings: request.settings.clone(),
        remarks: remarks(&refused, is_better),
    })
}

/// What is taken in the end.
struct Believed<'a> {
    choice: Choice,
    settled: Settled<'a>,
    remaining: Vec<Unexplained>,
    /// Names of effects that are not the same at all times.
    refused: Vec<String>,
}

/// The effects taken, as far as each is the same at all times where something remains unexplained. Where one is not, the
/// choice is made again without it: it may have stood before another.
fn believed<'a>(
    request: &Request<'_>,
    search: &Search<'a>,
    choice: Choice,
    progress: Progress<'_>,
) -> Result<Believed<'a>, RefineError> {
    let (mut search, mut choice, mut refused) = (search.clone(), choice, Vec::new());
    loop {
        let settled = choice.settled(&search, request)?;
        let remaining = remaining(&settled.search, &settled.best, &settled.base.workspace)?;
        let margin = request.settings.least_evidence;
        let inconstant = match remaining.is_empty() {
            true => Vec::new(),
            false => settled.search.inconstant(&settled.base, &settled.best, margin)?,
        };
        if inconstant.is_empty() {
            return Ok(Believed { choice, settled, remaining, refused });
        }
        let names = inconstant.into_iter().map(|place| settled.best.candidates[place].effect.clone());
        refused.extend(names.inspect(|name| search.forget(name)));
        step(progress, 0.8, "effects without those that only resemble what is missing")?;
        choice = choose(&search, request.settings)?.after(choice);
    }
}

/// What is said of effects that were refused.
fn remarks(refused: &[String], is_better: bool) -> Vec<String> {
    let one = |name: &String| {
        format!(
            "`{name}` would explain a part of what remains, but in one size here and in another there: it resembles what is \
             missing and is not named"
        )
    };
    let worse = "with what was found the model does not simulate trials better that the fit has not seen: no model is given";
    refused.iter().map(one).chain((!is_better).then(|| worse.to_owned())).collect()
}

fn remaining(
    search: &Search<'_>,
    best: &Judged,
    workspace: &super::workspace::Workspace<'_>,
) -> Result<Vec<Unexplained>, RefineError> {
    let expected = match search.model.uncertainty {
        Some(_) => &search.expected,
        None => &workspace.scales().discrepancies(REMAINDER),
    };
    let moved = best.candidates.iter().zip(&best.stood).flat_map(|(c, s)| c.at.iter().zip(&s.at).map(|(a, b)| a - b));
    let parameters: Vec<f64> = best.shift.iter().copied().chain(moved).collect();
    let clean = search.model.uncertainty.as_ref().map(|uncertainty| &uncertainty.remainder);
    let changes: Vec<f64> = best.candidates.iter().flat_map(|candidate| candidate.change()).collect();
    let effects: Vec<f64> = vec![0.0; best.shift.len()].into_iter().chain(changes).collect();
    let found = unexplained(workspace, expected, &parameters, &effects, clean);
    if clean.is_none() || found.is_empty() {
        return Ok(found);
    }
    // Coefficients that gave way to what is missing have spread it over the trial: it is dated by those of clean trials.
    let given_way = search.given_way().into_iter().map(|change| -change);
    let as_taught: Vec<f64> = given_way.chain(parameters.iter().copied().skip(best.shift.len())).collect();
    let dated = unexplained(workspace, expected, &as_taught, &effects, clean);
    let same = |a: &Unexplained, b: &Unexplained| a.trial == b.trial && a.channel == b.channel;
    let dated: Vec<Unexplained> = dated.into_iter().filter(|a| found.iter().any(|b| same(a, b))).collect();
    Ok(if dated.is_empty() { found } else { dated })
}

/// The discrepancy that is forgiven a model that brings none, by the typical acceleration.
const REMAINDER: f64 = 3e-4;

fn how(request: &Request<'_>, refit: Option<&str>) -> String {
    let fitted = match request.trials.len() {
        1 => "there is one trial only: these are errors on the trial that the effects were fitted on".to_owned(),
        count => format!("each of {count} trials simulated with effects fitted on the others"),
    };
    match refit {
        Some(refit) => format!("{fitted}, and so were the coefficients, in the way that does best on the others ({refit})"),
        None => fitted,
    }
}

/// The effects found with those they are confounded with, the strongest first, and the trial that would separate them.
fn apart(
    request: &Request<'_>,
    search: &Search<'_>,
    best: &Judged,
    of_all: f64,
) -> Result<(Vec<Found>, Option<NextTrial>), RefineError> {
    let mut all: Vec<Found> = (0..best.candidates.len()).map(|place| found(request, search, best, place, of_all)).collect();
    let mut next = None;
    if !all.is_empty() {
        let level = best.level.min(search.levels.len() - 1);
        let base = search.base(&best.candidates, &search.levels[level..=level])?;
        let responses = Responses::new(search, &base, best, &base.total(0));
        for (place, found) in all.iter_mut().enumerate() {
            found.confounded_with = responses.as_ref().map(|responses| responses.beside(place)).unwrap_or_default();
        }
        next = next_trial(search, &base, best, &all);
    }
    all.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    Ok((all, next))
}

/// `of_all` is the evidence of all effects together where the model alone may have any discrepancy: none has more.
fn found(request: &Request<'_>, search: &Search<'_>, best: &Judged, place: usize, of_all: f64) -> Found {
    let candidate = &best.candidates[place];
    let covariance = search.covariance(best, place);
    Found {
        name: candidate.effect.clone(),
        form: candidate.form.file.name.clone(),
        meaning: candidate.form.file.meaning.clone(),
        acts_on: acts_on(candidate),
        parameters: values(candidate, &covariance, request.model),
        evidence: search.evidence(best, place).unwrap_or_default().min(of_all),
        confounded_with: Vec::new(),
    }
}

/// Everything that was judged where it stands, the most probable first.
fn hypotheses(request: &Request<'_>, search: &Search<'_>, choice: &Choice) -> Vec<Hypothesis> {
    let alone = choice.alone.held_out(&search.fixed);
    let one = |(place, judged): (usize, &Judged)| Hypothesis {
        effects: judged.candidates.iter().map(crate::residual::Candidate::key).collect(),
        evidence: judged.log_evidence - choice.alone.log_evidence,
        held_out: judged.held_out(&search.fixed).zip(alone).map(|(with, without)| with - without),
        parameters: parameters(request, judged),
        taken: choice.taken == Some(place),
    };
    let mut all: Vec<Hypothesis> = choice.tried.iter().enumerate().map(one).collect();
    all.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    all
}

fn parameters(request: &Request<'_>, judged: &Judged) -> std::collections::BTreeMap<String, super::outcome::Value> {
    let of = |place: usize| {
        let covariance = own_covariance(&judged.candidates, place, &judged.covariance);
        values(&judged.candidates[place], &covariance, request.model)
    };
    (0..judged.candidates.len()).flat_map(of).collect()
}
