//! The end of a refinement: the best candidate is chosen whose model also completes the standard
//! manoeuvres.

use sistership_model::Model;
use sistership_model::posterior::Posterior;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, StandardManoeuvres};

use super::blocks::RegressionBlocks;
use super::candidate::{CandidateFit, CandidateSolution, best_candidate};
use super::family::TermFamily;
use super::manoeuvres::{measured_manoeuvres, standard_manoeuvres};
use super::misfit::misfit_factor;
use super::mixture;
use super::outcome::{RefineError, Refinement, RefinementManoeuvres};
use super::problem::RefinementProblem;
use super::progress::{Progress, report_progress};
use super::range_check::RangeFaults;
use super::refinement_result::{ChosenCandidate, assemble_refinement};
use super::ridge::{CoefficientFit, RidgeChoices};
use super::thresholds::SELECTION;
use super::variant::TermVariant;
use crate::constraints::LimitError;
use sistership_assessment::course::course_figures;
use sistership_assessment::uncertainty::{fold_factor, uncertainty_bands};
use sistership_numerics::RidgeChoice;
use sistership_priors::engine_response::engine_response;
use sistership_priors::transfer::TYPICAL_SOURCE;
use sistership_propulsion::{PropulsionContext, PropulsionFault, SourcePropeller};

/// The error type for a candidate that cannot be chosen.
#[derive(Debug, thiserror::Error)]
enum CandidateRefusal {
    #[error(transparent)]
    Constraints(LimitError),
    #[error("leaves the physical range: {0}")]
    Range(String),
}

/// Reason against the source where there is none: a law without coefficients.
const NO_MODEL: &str = "a law without coefficients cannot be selected";

/// Returns true if a model has coefficients and all of them are zero: the placeholder for a source
/// where there is none.
fn has_only_zeros(model: &Model) -> bool {
    let mut values = model.coefficients.values().peekable();
    values.peek().is_some() && values.all(|coefficient| coefficient.value == 0.0)
}

/// Returns true if no ship is the source of a model: its coefficients are zero, or typical values of
/// the law.
pub(super) fn has_no_source(model: &Model) -> bool {
    has_only_zeros(model) || model.coefficients.values().any(|one| one.source == TYPICAL_SOURCE)
}

/// A candidate fitted on all trials, with the standard manoeuvres of its model.
struct FittedCandidate {
    fit: Option<CoefficientFit>,
    model: Model,
    manoeuvres: StandardManoeuvres,
    faults: RangeFaults,
}

/// A fitted candidate, or the reason why it cannot be chosen.
type CandidateOutcome = Result<FittedCandidate, CandidateRefusal>;

/// A candidate that leaves the physical range only at angles beyond those of its trials.
struct SpareCandidate {
    place: usize,
    fitted: FittedCandidate,
    /// Its error on held-out trials.
    error: Option<f64>,
}

/// Returns the refinement by the best candidate whose model, fitted on all trials, also stays within
/// the physical range in turns and zigzags at every angle of the steering gear; if there is none, by
/// the best that does so at the angles of its trials, with a remark.
///
/// # Errors
/// Returns an error if no candidate's simulations run to their end, or if it was cancelled.
pub(super) fn finish_refinement(
    problem: &RefinementProblem<'_>,
    mut candidates: Vec<CandidateFit>,
    variants: &[TermVariant],
    progress: Progress<'_>,
) -> Result<Refinement, RefineError> {
    if has_only_zeros(&problem.transferred) {
        let source = &mut candidates[0].option;
        (source.error, source.reason) = (None, Some(NO_MODEL.to_owned()));
    }
    report_progress(progress, 0.9, "standard manoeuvres of the source, and of the best option")?;
    let first =
        |place: usize| simulate_candidate(problem, candidates[place].solution.as_ref(), variants);
    // The manoeuvres of the source and of the first candidate are independent and run in parallel.
    let (before, mut first) = rayon::join(
        || standard_manoeuvres(&problem.transferred, problem.law),
        || best_candidate(&candidates).map(first),
    );
    let mut spare: Option<SpareCandidate> = None;
    loop {
        // A refused candidate loses its error below, so that each round finds another one and the
        // loop ends.
        let Some(best) = best_candidate(&candidates) else {
            let Some(SpareCandidate { place, fitted, error }) = spare else {
                let reasons = candidates.iter().filter_map(|one| one.option.reason.as_deref());
                return Err(RefineError::all_diverged(reasons));
            };
            let option = &mut candidates[place].option;
            (option.reason, option.error) = (None, error);
            let taken = (candidates, place);
            return build_refinement(problem, taken, (fitted, variants), before, progress);
        };
        report_progress(
            progress,
            0.9,
            &format!("standard manoeuvres of option {}", candidates[best].option.step),
        )?;
        let sailed = match first.take() {
            Some(sailed) => sailed,
            None => simulate_candidate(problem, candidates[best].solution.as_ref(), variants),
        };
        let refusal = match sailed? {
            Err(refusal) => refusal,
            Ok(fitted) => {
                let Some(fault) = fitted.faults.first() else {
                    let taken = (candidates, best);
                    return build_refinement(problem, taken, (fitted, variants), before, progress);
                };
                if fitted.faults.within.is_none() {
                    let error = candidates[best].option.error;
                    spare.get_or_insert(SpareCandidate { place: best, fitted, error });
                }
                CandidateRefusal::Range(fault)
            }
        };
        let option = &mut candidates[best].option;
        (option.reason, option.error) = (Some(refusal.to_string()), None);
    }
}

/// Returns the model of the best candidate, fitted on all trials.
///
/// # Errors
/// Returns an error if no candidate's simulations run to their end, or the constraints cannot be
/// kept.
pub(super) fn best_model(
    problem: &RefinementProblem<'_>,
    candidates: &[CandidateFit],
    variants: &[TermVariant],
) -> Result<Model, RefineError> {
    let reasons = || candidates.iter().filter_map(|one| one.option.reason.as_deref());
    let best = best_candidate(candidates).ok_or_else(|| RefineError::all_diverged(reasons()))?;
    Ok(refined_model(problem, candidates[best].solution.fit(variants)?.as_ref()))
}

/// Fits a candidate on all trials and simulates its standard manoeuvres; a refusal if it does not
/// keep the constraints.
fn simulate_candidate(
    problem: &RefinementProblem<'_>,
    solution: &dyn CandidateSolution,
    variants: &[TermVariant],
) -> Result<CandidateOutcome, RefineError> {
    let fitted = match solution.fit(variants) {
        Err(RefineError::Constraints(reason)) => {
            return Ok(Err(CandidateRefusal::Constraints(reason)));
        }
        fitted => fitted?,
    };
    // Engine and propulsion come before the manoeuvres, which they affect.
    let refined = with_engine(refined_model(problem, fitted.as_ref()), problem);
    let model = propulsion_context(problem).with_propulsion(refined);
    let manoeuvres = standard_manoeuvres(&model, problem.law);
    let faults = RangeFaults::simulate(&model, problem.law, &problem.whole, &manoeuvres);
    Ok(Ok(FittedCandidate { fit: fitted, model, manoeuvres, faults }))
}

/// The propulsion context of the law and the trials, with the estimate from particulars where there
/// is one.
fn propulsion_context<'a>(problem: &'a RefinementProblem<'_>) -> PropulsionContext<'a> {
    // The estimate is optional: a ship whose particulars do not suffice has none.
    let of_ship =
        |target| mixture::particulars_estimate(target, problem.transferred.speed_m_s).ok();
    let estimate = problem.target.and_then(of_ship).map(|(estimate, _)| estimate);
    let source = problem.propeller.as_ref().map(|(model, law)| SourcePropeller { model, law });
    PropulsionContext { law: problem.law, trials: &problem.whole, source, estimate }
}

/// The model with the response of the engine in its trials.
fn with_engine(model: Model, problem: &RefinementProblem<'_>) -> Model {
    let Some(engine) = engine_response(&problem.whole) else { return model };
    let (n_rps, loss) = (Some(engine.n_rps), Some(engine.loss));
    Model { revolutions_rps: n_rps, revolutions_loss: loss, ..model }
}

/// The refined model; the transferred source if nothing was fitted.
fn refined_model(problem: &RefinementProblem<'_>, fitted: Option<&CoefficientFit>) -> Model {
    fitted.map_or_else(|| problem.transferred.clone(), |fit| problem.fitted_model(fit))
}

/// Builds the refinement from the chosen candidate: errors, posterior, propulsion and uncertainty
/// bands.
fn build_refinement(
    problem: &RefinementProblem<'_>,
    (mut candidates, best): (Vec<CandidateFit>, usize),
    (taken, variants): (FittedCandidate, &[TermVariant]),
    before: StandardManoeuvres,
    progress: Progress<'_>,
) -> Result<Refinement, RefineError> {
    candidates[best].option.chosen = true;
    let errors = candidates[best].solution.coefficient_errors(problem, variants)?;
    let mut fitted = taken.fit.map(|fit| fit.with_errors(errors));
    // The values are read again for their standard errors, which are known only now.
    let Model { coefficients, parameters, .. } = refined_model(problem, fitted.as_ref());
    let mut model = Model { coefficients, parameters, ..taken.model };
    model.posterior = coefficient_posterior(problem, &model, fitted.as_ref(), variants)?;
    // The fold models' scatter widens the posterior; it never narrows it.
    let factor = fold_factor(&model, problem.law, &candidates[best].left_out);
    widen_errors(&mut model, fitted.as_mut(), factor);
    // Nor does the scatter show what every fold has wrong.
    let misfit = misfit_factor(problem, &model, &candidates[best].left_out);
    widen_errors(&mut model, fitted.as_mut(), misfit);
    let propulsion = propulsion_context(problem);
    let model = with_posterior_balance(problem, &propulsion, (model, &taken.faults));
    let fault = propulsion
        .propulsion_fault(&model)
        .filter(|fault| *fault != PropulsionFault::NoRevolutions);
    let measured = measured_manoeuvres(problem, &model);
    report_progress(progress, 0.93, "confidence bands")?;
    let bands = uncertainty_bands(
        &model,
        problem.law,
        &ManoeuvreSettings::default(),
        None,
        problem.settings.bands,
    );
    let course = course_figures(&model, problem.law);
    let manoeuvres =
        RefinementManoeuvres { source: before, refined: taken.manoeuvres, bands, course, measured };
    let propulsion_fault = fault.map(|fault| fault.to_string());
    let range_fault = taken.faults.beyond;
    let chosen = ChosenCandidate { candidates, best, model, fitted, propulsion_fault, range_fault };
    assemble_refinement(problem, chosen, manoeuvres)
}

/// The model with its balance weighted by its posterior, which is known only now, unless it then
/// leaves the physical range where it did not before.
fn with_posterior_balance(
    problem: &RefinementProblem<'_>,
    propulsion: &PropulsionContext<'_>,
    (model, before): (Model, &RangeFaults),
) -> Model {
    if model.propulsion.is_none() {
        return model;
    }
    let balanced = propulsion.with_posterior(model.clone());
    let standard = StandardManoeuvres::default();
    let faults = RangeFaults::simulate(&balanced, problem.law, &problem.whole, &standard);
    let is_worse = faults.within.is_some() || faults.beyond.is_some() && before.beyond.is_none();
    if is_worse { model } else { balanced }
}

/// Multiplies all standard errors of a model and its fit by a factor.
fn widen_errors(model: &mut Model, fitted: Option<&mut CoefficientFit>, factor: f64) {
    let of_fit = fitted.into_iter().flat_map(|fit| {
        // Errors of parameters that were not fitted are those of their source.
        for name in fit.parameters.keys() {
            let own = model.parameters.get_mut(name).and_then(|one| one.standard_error.as_mut());
            own.into_iter().for_each(|error| *error *= factor);
        }
        fit.coefficients.values_mut().chain(fit.parameters.values_mut())
    });
    of_fit.for_each(|fitted| fitted.standard_error *= factor);
    let own = model.coefficients.values_mut().filter_map(|one| one.standard_error.as_mut());
    own.for_each(|error| *error *= factor);
    let posterior = model.posterior.iter_mut().flat_map(|all| all.deviations.iter_mut());
    posterior.for_each(|deviation| *deviation *= factor);
}

/// The posterior of the model's coefficients. If the source is kept, its errors are those that the
/// trials indicate at a prior that holds it.
fn coefficient_posterior(
    problem: &RefinementProblem<'_>,
    model: &Model,
    fitted: Option<&CoefficientFit>,
    variants: &[TermVariant],
) -> Result<Option<Posterior>, RefineError> {
    let errors = match (fitted, variants.iter().find(|variant| variant.family == TermFamily::Own)) {
        (Some(fitted), _) => fitted.errors.clone(),
        (None, Some(own)) => own.ridge_errors(&problem.training, &source_choices(&own.blocks))?,
        (None, None) => None,
    };
    Ok(errors.and_then(|errors| errors.to_posterior(model)))
}

/// Ridge choices so strong that the source is kept.
fn source_choices(blocks: &RegressionBlocks) -> RidgeChoices {
    blocks
        .blocks
        .iter()
        .map(|block| vec![RidgeChoice { lambda: SELECTION.held, alpha: 0.0 }; block.axes.len()])
        .collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::refine::request::RefinementSpec;
    use crate::refine::selection::refine;
    use crate::refine::settings::{EstimationMethod, RefinementSettings};
    use crate::testing::{mariner_model, simulated_trials, with_scaled_coefficients};
    use sistership_model::trial::Trial;

    /// What the strongest of priors leaves is no better than what it pulls to: what stands for the
    /// source where there is none would be kept.
    #[test]
    fn a_law_without_coefficients_is_never_taken() {
        let (model, law) = mariner_model();
        let trials = simulated_trials(&model, &law, 0.001);
        let trials: Vec<&Trial> = trials.iter().collect();
        let settings = RefinementSettings {
            method: EstimationMethod::Weak,
            strengths: vec![SELECTION.held],
            ..RefinementSettings::default()
        };
        let zoo = sistership_model::Zoo::load_embedded().unwrap();
        let kept = |source: &Model| {
            let (target, settings) = (zoo.vessel("mariner").unwrap(), &settings);
            let request = RefinementSpec {
                target,
                source,
                source_law: None,
                law: &law,
                trials: &trials,
                population: &[],
                settings,
            };
            refine(&request, &|_, _| true).map(|made| made.is_source_kept())
        };
        assert_eq!(kept(&model), Ok(true));
        assert_ne!(kept(&with_scaled_coefficients(&model, |_| 0.0)), Ok(true));
    }
}
