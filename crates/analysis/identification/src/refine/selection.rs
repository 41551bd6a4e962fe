//! The whole refinement: an estimator gives candidates from the source outwards, and the one with
//! the best simulations of held-out manoeuvres is chosen.

use sistership_model::law::Law;
use sistership_model::trial::Trial;
use sistership_model::{Model, Vessel};
use sistership_simulation::error::standard_deviations;

use super::across::SourceEnvelopes;
use super::candidate::CandidateFit;
use super::estimators::estimator_for;
use super::evaluation::{CandidateEvaluation, RefinementExtent, evaluate_best};
use super::finish::{best_model, finish_refinement, has_no_source};
use super::longer_restarts::compare_longer;
use super::mixture;
use super::mixture_position::choose_position;
use super::outcome::{RefineError, Refinement};
use super::parts::trial_parts;
use super::problem::RefinementProblem;
use super::progress::{IterateObserver, MonotoneProgress, Progress, report_progress};
use super::replayed_trials::ReplayedTrials;
use super::request::RefinementSpec;
use super::ridge_candidates::source_candidate;
use super::settings::{Prior, RefinementSettings};
use super::settings_check::combined_error;
use super::starting_point::StartingPoint;
use super::thresholds::SELECTION;
use super::variant::{TermVariant, family_variants};
use sistership_priors::steering::measured_rate;
use sistership_priors::transfer::trial_approach;

/// Refines a source model against trials.
///
/// # Errors
/// Returns an error with the setting, trial or channel at fault; no model is left half refined.
pub fn refine(
    request: &RefinementSpec<'_>,
    progress: Progress<'_>,
) -> Result<Refinement, RefineError> {
    refine_watched(request, progress, &|_| ())
}

/// As [`refine`], with an observer of the iterates of `trajectory` and `cma-es`.
///
/// # Errors
/// As [`refine`].
pub fn refine_watched(
    request: &RefinementSpec<'_>,
    progress: Progress<'_>,
    watch: IterateObserver<'_>,
) -> Result<Refinement, RefineError> {
    let known = SourceEnvelopes::default();
    let weighed = |settings: &RefinementSettings| {
        let request = RefinementSpec { settings, ..*request };
        let goes_on = |_, _: &str| progress(0.02, "selecting the mixture of source and estimate");
        evaluate_candidates((&request, &known), RefinementExtent::Estimator, &goes_on)
    };
    // The position of a mixture is chosen first, by complete evaluations at each position.
    let Some(position) = choose_position(request.settings, weighed)? else {
        return with_candidates(
            (request, &known),
            RefinementExtent::Estimator,
            progress,
            watch,
            finish_refinement,
        );
    };
    let settings =
        &RefinementSettings { mixture_positions: vec![position], ..request.settings.clone() };
    let request = RefinementSpec { settings, ..*request };
    with_candidates(
        (&request, &known),
        RefinementExtent::Estimator,
        progress,
        watch,
        finish_refinement,
    )
}

/// Evaluates the source as it is, and the best fit to the given extent, on held-out manoeuvres,
/// without making a model. `known` keeps the envelopes of sources for further requests on the same
/// trials.
///
/// # Errors
/// As [`refine`].
pub fn evaluate_candidates(
    (request, known): (&RefinementSpec<'_>, &SourceEnvelopes),
    extent: RefinementExtent,
    progress: Progress<'_>,
) -> Result<Vec<CandidateEvaluation>, RefineError> {
    let weigh = |problem: &RefinementProblem<'_>,
                 fits: Vec<CandidateFit>,
                 variants: &[TermVariant],
                 _: Progress<'_>| Ok(evaluate_best(problem, &fits, variants));
    with_candidates((request, known), extent, progress, &|_| (), weigh)
}

/// Evaluates candidates without making a model, and completes the refinement if `wanted` returns
/// true for the evaluations.
///
/// # Errors
/// As [`refine`].
pub fn refine_if_wanted(
    (request, known): (&RefinementSpec<'_>, &SourceEnvelopes),
    wanted: impl FnOnce(&[CandidateEvaluation]) -> Result<bool, RefineError>,
    progress: Progress<'_>,
) -> Result<(Vec<CandidateEvaluation>, Option<Refinement>), RefineError> {
    let both = |problem: &RefinementProblem<'_>,
                fits: Vec<CandidateFit>,
                variants: &[TermVariant],
                progress: Progress<'_>| {
        let weighed = evaluate_best(problem, &fits, variants);
        let refinement = match wanted(&weighed)? {
            true => Some(finish_refinement(problem, fits, variants, progress)?),
            false => None,
        };
        Ok((weighed, refinement))
    };
    with_candidates((request, known), RefinementExtent::Estimator, progress, &|_| (), both)
}

/// Returns the model that a refinement gives, without standard manoeuvres, uncertainty bands and
/// the checks on them.
///
/// # Errors
/// As [`refine`].
pub fn fit_model(request: &RefinementSpec<'_>) -> Result<Model, RefineError> {
    let known = SourceEnvelopes::default();
    let fitted = |problem: &RefinementProblem<'_>,
                  fits: Vec<CandidateFit>,
                  variants: &[TermVariant],
                  _: Progress<'_>| best_model(problem, &fits, variants);
    with_candidates((request, &known), RefinementExtent::Estimator, &|_, _| true, &|_| (), fitted)
}

/// Sets up the problem, computes its candidates to the given extent, and passes them to `then`.
fn with_candidates<T>(
    (request, known): (&RefinementSpec<'_>, &SourceEnvelopes),
    extent: RefinementExtent,
    progress: Progress<'_>,
    watch: IterateObserver<'_>,
    then: impl FnOnce(
        &RefinementProblem<'_>,
        Vec<CandidateFit>,
        &[TermVariant],
        Progress<'_>,
    ) -> Result<T, RefineError>,
) -> Result<T, RefineError> {
    request.settings.check().map_err(combined_error)?;
    let (judged, whole) = divide_trials(request)?;
    let progress = MonotoneProgress::new(progress);
    // Parts of the work report overlapping fractions; users see them never decrease.
    let progress: Progress<'_> = &|fraction, what| progress.report_fraction(fraction, what);
    let lpp_m = request.target.particular("lpp_m");
    let mut settings = resolve_settings(request.settings, request.law, lpp_m, &whole);
    if settings.prior == Prior::Mixture {
        // A stored version names its regressions; others are refused.
        let asked = settings.regressions_sha256.as_deref();
        settings.regressions_sha256 = Some(mixture::regressions_sha256(asked)?);
    }
    // Parts must be known before the prior, whose measure depends on them.
    let estimator = estimator_for(settings.method);
    let equations = estimator.equation_form(&settings);
    let parts = trial_parts(&whole, request.law, equations, &settings);
    let started = StartingPoint { request, known, whole: &whole, approach: trial_approach(&whole) };
    let propeller = started.source_propeller();
    let (mut transferred, measure) = started.starting_prior(!parts.is_empty())?;
    if request.law.steers_by_difference() {
        steer_by_thrusters(&mut transferred);
    }
    steer_as_recorded(&mut transferred, request.target, &whole);
    // Parts replace whole trials in fit and comparison alike.
    let training = if parts.is_empty() { whole.clone() } else { parts.iter().collect() };
    // A source with coefficients of zero is a placeholder and has no name.
    let named = Some(&*request.source.name).filter(|_| !has_no_source(request.source));
    let source = settings.prior_origin(named).to_owned();
    let (law, watch) = (request.law, Some(watch));
    let replayed = ReplayedTrials::new(law, lpp_m, &training, settings.smoothing_s);
    let deviations = standard_deviations(&training);
    let problem = RefinementProblem {
        law,
        target: Some(request.target),
        source: &source,
        training,
        replayed,
        whole,
        judged,
        deviations,
        transferred,
        propeller,
        measure,
        settings,
        watch,
    };
    report_progress(progress, 0.05, "sufficient statistics of each trial")?;
    let variants = family_variants(&problem, equations)?;
    let mut candidates = vec![source_candidate(&problem, &variants)?];
    if extent == RefinementExtent::Estimator {
        estimator.add_candidates(&problem, &variants, &mut candidates, progress)?;
    }
    // After all candidates, since it excludes those that are far from the least error.
    compare_longer(&problem, &mut candidates)?;
    report_progress(progress, 0.8, "fitting all trials")?;
    then(&problem, candidates, &variants, progress)
}

/// Rate of the helm of a craft that the difference of thrusters steers, deg/s: the whole difference
/// in half a second, in which electric thrusters change their revolutions.
const THRUSTER_RATE_DEG_S: f64 = 70.0;

/// Sets the rate of the helm of a craft without a rudder, whose source may have a steering gear.
fn steer_by_thrusters(model: &mut Model) {
    model.steering.rate_deg_s = THRUSTER_RATE_DEG_S;
    model.steering.source = Some("thrusters that change their revolutions at once".to_owned());
}

/// Sets a model's rudder rate to that of the recorded rudder movements, where these show it.
fn steer_as_recorded(model: &mut Model, target: &Vessel, trials: &[&Trial]) {
    let length_s = target.particular("lpp_m").zip(trial_approach(trials));
    let rate = length_s.and_then(|(l, approach)| measured_rate(trials, l / approach.speed_m_s));
    if let Some(rate) = rate {
        model.steering.rate_deg_s = rate.to_degrees();
        model.steering.source = Some("simulating the rudder movements of the trials".to_owned());
    }
}

/// Divides the trials into those that are kept out of fit and choice, and the others.
fn divide_trials<'a>(
    request: &'a RefinementSpec<'a>,
) -> Result<(Vec<&'a Trial>, Vec<&'a Trial>), RefineError> {
    let names = &request.settings.held_out;
    if let Some(unknown) =
        names.iter().find(|name| !request.trials.iter().any(|trial| trial.name == **name))
    {
        let message = format!("there is no trial `{unknown}`");
        return Err(RefineError::Setting { field: "held_out".into(), message });
    }
    let (judged, whole): (Vec<&Trial>, Vec<&Trial>) =
        request.trials.iter().partition(|trial| names.contains(&trial.name));
    if whole.is_empty() {
        return Err(RefineError::Data(
            "no trial is left to fit to; give more trials, or hold out \
                                      fewer"
                .into(),
        ));
    }
    Ok((judged, whole))
}

/// Returns the settings with the times that depend on the ship filled in, so that a version records
/// those that were used.
pub(super) fn resolve_settings(
    settings: &RefinementSettings,
    law: &Law,
    lpp_m: Option<f64>,
    training: &[&Trial],
) -> RefinementSettings {
    let length_s = lpp_m.zip(trial_approach(training)).map(|(l, approach)| l / approach.speed_m_s);
    let mut settings = settings.clone();
    estimator_for(settings.method).resolve_settings(&mut settings, law, length_s);
    settings.restart_s = settings.restart_s.or(length_s.map(|s| SELECTION.restart * s));
    settings
}
