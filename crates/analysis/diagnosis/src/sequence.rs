//! Diagnosis in sequence: trials that count already do not count again, and trials that earlier ones
//! contradict are diagnosed by themselves.

use sistership_identification::refine::{Progress, RefineError};
use sistership_model::Trial;
use sistership_model::sample_hash::sample_hash;

use super::DiagnosisInputs;
use super::effect_history::EffectHistory;
use super::outcome::{Diagnosis, Verdict};
use super::run::diagnose_trials;
use super::settings::Settings;

/// Share of the progress at which trials that earlier ones contradict are diagnosed by themselves.
const ALONE_FROM: f64 = 0.9;
/// Remark on trials of which all were known.
const ALL_KNOWN: &str = "all trials were part of an earlier diagnosis: they are diagnosed by themselves, and do not \
     count again";
/// Beginning of the remark on trials of which some were known.
const LEFT_OUT: &str = "left out, as trials of an earlier diagnosis would count twice";
/// Remark on trials that earlier ones contradict.
const CONTRADICTED: &str = "earlier trials contradict these, as after a repair: these are diagnosed by themselves, and \
     the sequence begins again with them";

/// Diagnoses a model on trials.
///
/// # Errors
/// Returns an error that names the setting, trial or channel at fault, or one if `progress`
/// cancels.
pub fn diagnose(
    request: &DiagnosisInputs<'_>,
    progress: Progress<'_>,
) -> Result<Diagnosis, RefineError> {
    request
        .settings
        .check_values()
        .map_err(|(field, message)| RefineError::Setting { field, message })?;
    check_inputs(request)?;
    match &request.settings.earlier {
        None => diagnose_trials(request, progress),
        Some(earlier) => diagnose_after(request, earlier, progress),
    }
}

/// Checks that a diagnosis has trials, and that earlier ones are of the same model.
fn check_inputs(request: &DiagnosisInputs<'_>) -> Result<(), RefineError> {
    if request.trials.is_empty() {
        return Err(RefineError::Data(
            "no trial is given; give one that the model was not fitted to".into(),
        ));
    }
    let earlier = request.settings.earlier.as_ref();
    match earlier.filter(|earlier| earlier.model != request.model.name) {
        Some(earlier) => Err(RefineError::Setting {
            field: "earlier".into(),
            message: format!(
                "is of the model `{}`; give the answer of a diagnosis of `{}`",
                earlier.model, request.model.name
            ),
        }),
        None => Ok(()),
    }
}

/// Diagnoses the trials that are not among the earlier ones.
fn diagnose_after(
    request: &DiagnosisInputs<'_>,
    earlier: &EffectHistory,
    progress: Progress<'_>,
) -> Result<Diagnosis, RefineError> {
    let is_known = |trial: &&Trial| earlier.samples.contains(&sample_hash(trial));
    let (known, new): (Vec<&Trial>, Vec<&Trial>) =
        request.trials.iter().copied().partition(is_known);
    if new.is_empty() {
        let alone = diagnose_alone(request, progress)?;
        // The earlier information holds them already, and stays as it is.
        let kept = Diagnosis { history: Some(earlier.clone()), ..alone };
        return Ok(with_remark(kept, ALL_KNOWN.to_owned()));
    }
    let request = DiagnosisInputs { trials: &new, ..*request };
    let diagnosis = diagnose_new(&request, progress)?;
    let names: Vec<&str> = known.iter().map(|trial| trial.name.as_str()).collect();
    Ok(match names.is_empty() {
        true => diagnosis,
        false => with_remark(diagnosis, format!("{LEFT_OUT}: {}", names.join(", "))),
    })
}

/// Diagnoses trials from what earlier ones say, and by themselves where these contradict them, as
/// after a repair: the sequence then begins again with them.
fn diagnose_new(
    request: &DiagnosisInputs<'_>,
    progress: Progress<'_>,
) -> Result<Diagnosis, RefineError> {
    let diagnosis = diagnose_trials(request, progress)?;
    if diagnosis.verdict != Verdict::Unexplained {
        return Ok(diagnosis);
    }
    // The first answer is large, and is not needed any more.
    drop(diagnosis);
    let alone = diagnose_alone(request, &|fraction, what| {
        progress(ALONE_FROM + (1.0 - ALONE_FROM) * fraction, what)
    })?;
    Ok(match alone.verdict {
        Verdict::Unexplained => alone,
        _ => with_remark(alone, CONTRADICTED.to_owned()),
    })
}

/// Diagnoses trials without earlier ones.
fn diagnose_alone(
    request: &DiagnosisInputs<'_>,
    progress: Progress<'_>,
) -> Result<Diagnosis, RefineError> {
    let settings = Settings { earlier: None, ..request.settings.clone() };
    diagnose_trials(&DiagnosisInputs { settings: &settings, ..*request }, progress)
}

fn with_remark(mut diagnosis: Diagnosis, remark: String) -> Diagnosis {
    diagnosis.remarks.push(remark);
    diagnosis
}
