//! Selection of the candidate whose model also completes the required manoeuvres.

use sistership_model::Law;

use sistership_identification::refine::{
    CandidateEvaluation, FoldModel, Progress, RefineError, Refinement, RefinementSettings,
    SourceEnvelopes, refine,
};

use crate::candidate::CandidatePrior;
use crate::choice::standard_error;
use crate::evaluation::{
    CandidateSearch, EvaluatedCandidate, candidate_request, chosen_place, evaluate_candidate,
    last_ridge, preferred_place, ridge_settings, stage_settings,
};
use crate::preference::Preference;
use crate::selection_report::{ReportLine, SelectionReport, SelectionStage};
use crate::simulation_check::{SimulationFault, simulation_fault};
use crate::thresholds::SEARCH;

/// The selected candidate, with the settings that give its refinement explicitly.
#[derive(Debug, Clone)]
pub struct SelectedCandidate {
    /// Place among the candidates.
    pub entrant: usize,
    /// Settings that name its method.
    pub settings: RefinementSettings,
    /// Selection report.
    pub ladder: SelectionReport,
    /// Refinement that these settings give.
    pub refinement: Refinement,
    /// The models of its folds.
    pub folds: Vec<FoldModel>,
}

/// Refines the chosen candidate by its own settings. If its refinement keeps the source, since no
/// fitted model keeps the constraints and completes the standard manoeuvres, the candidate is
/// excluded and the next one is chosen: the source as it is, or a law without coefficients, is not
/// what was chosen. The same applies if the model leaves the physical range under rudder orders at
/// random, as long as another candidate does not. A model that does not stop or go astern gives way
/// to one that does only if that one's error is within a factor ([`SEARCH`]`.propulsion`): what the
/// trials measured counts more than what they do not reach.
///
/// # Errors
/// Returns an error if it was cancelled, a setting is refused, or no candidate is left.
pub(super) fn select_candidate(
    search: &CandidateSearch<'_>,
    mut tried: Vec<EvaluatedCandidate>,
    progress: Progress<'_>,
) -> Result<SelectedCandidate, RefineError> {
    let mut spare = Spare::default();
    loop {
        let Some(best) = chosen_place(search, &tried) else {
            return spare.into_best().ok_or_else(|| nothing_left(&tried));
        };
        let error = tried[best].weighed.error.unwrap_or(f64::INFINITY);
        if spare.is_better_than(error) {
            return spare.into_best().ok_or_else(|| nothing_left(&tried));
        }
        let settings = explicit_settings(search, &tried, best);
        let entrant = tried[best].entrant;
        let made = match tried[best].refinement.take() {
            Some(made) => Ok(made),
            None => refine_candidate(search, (entrant, &settings), progress),
        };
        let reason = match require_fitted(made, tried[best].rung)? {
            Err(reason) => reason,
            Ok(refinement) => {
                let law = &search.entrants[entrant].law;
                let unsailed = simulation_fault(&refinement.model, law, &search.fitted_trials());
                let ladder = build_report(search, &tried, best);
                let folds = tried[best].weighed.folds.clone();
                let winner = SelectedCandidate { entrant, settings, ladder, refinement, folds };
                let Some(fault) = unsailed else { return Ok(winner) };
                spare.keep(winner, &fault, error);
                // A prior that keeps more of the source does not mend the propulsion.
                if let SimulationFault::Propulsion(reason) = fault {
                    tried[best].refusal = Some(reason);
                    continue;
                }
                fault.into_reason()
            }
        };
        tried[best].refusal = Some(reason);
        // A refused weak form gets a successor with a stronger prior. Strengths only grow, so that
        // the loop ends.
        tried.extend(refit_stronger(search, &tried[best], progress)?);
    }
}

/// First models that fail only additional simulations, used if no other one passes.
#[derive(Default)]
struct Spare {
    steering: Option<SelectedCandidate>,
    /// With its error.
    propulsion: Option<(SelectedCandidate, f64)>,
}

impl Spare {
    fn keep(&mut self, model: SelectedCandidate, fault: &SimulationFault, error: f64) {
        match fault {
            SimulationFault::Steering(_) => {
                self.steering.get_or_insert(model);
            }
            SimulationFault::Propulsion(_) => {
                self.propulsion.get_or_insert((model, error));
            }
        }
    }

    /// Returns true if a model that fails only with another propulsion is kept whose error is less
    /// by the factor.
    fn is_better_than(&self, error: f64) -> bool {
        self.propulsion.as_ref().is_some_and(|(_, least)| error > SEARCH.propulsion * least)
    }

    fn into_best(self) -> Option<SelectedCandidate> {
        self.propulsion.map(|(model, _)| model).or(self.steering)
    }
}

/// The weak form of a refused candidate with a stronger prior, nearer to the prior's mean. `None`
/// for another stage, or if no stronger prior is left.
fn refit_stronger(
    search: &CandidateSearch<'_>,
    refused: &EvaluatedCandidate,
    progress: Progress<'_>,
) -> Result<Option<EvaluatedCandidate>, RefineError> {
    let is_weak = refused.rung == SelectionStage::Weak && search.settings.strengths.is_empty();
    let Some((family, lambda)) = refused.weighed.ridge.filter(|_| is_weak) else {
        return Ok(None);
    };
    let strengths: Vec<f64> = SEARCH.stronger.iter().map(|factor| factor * lambda).collect();
    let strongest = SEARCH.strengths.iter().copied().fold(0.0, f64::max);
    if strengths[0] > strongest {
        return Ok(None);
    }
    let entrant = refused.entrant;
    let own = search.entrants[entrant].candidate_settings(search.settings);
    let roll_strength = stronger_roll(&search.entrants[entrant].law, refused.roll_strength);
    let settings = RefinementSettings { families: vec![family], strengths, roll_strength, ..own };
    let named = search.entrants[entrant].name();
    let told = |_: f64, what: &str| progress(0.9, &format!("{named}, stronger prior: {what}"));
    let known = SourceEnvelopes::default();
    evaluate_candidate((search, &known), (entrant, SelectionStage::Weak), &settings, &told)
        .map(Some)
}

/// Strength of roll's own prior after a refusal. It is relative to the likeliest by the trials,
/// which does not depend on the common strength: a ship that capsizes does so by its roll as the
/// trials give it.
fn stronger_roll(law: &Law, before: Option<f64>) -> Option<f64> {
    law.has_roll().then(|| SEARCH.roll_stronger * before.unwrap_or(1.0))
}

/// The error that no candidate is left, with the reasons.
fn nothing_left(tried: &[EvaluatedCandidate]) -> RefineError {
    let reason =
        |one: &'_ EvaluatedCandidate| one.refusal.clone().or_else(|| one.weighed.reason.clone());
    let reasons: Vec<String> = tried.iter().filter_map(reason).collect();
    RefineError::all_diverged(reasons.iter().map(String::as_str))
}

/// Settings that give an evaluated candidate explicitly: the method of its stage, and the strength
/// of its weak form or of the one from which its trajectories start.
fn explicit_settings(
    search: &CandidateSearch<'_>,
    tried: &[EvaluatedCandidate],
    place: usize,
) -> RefinementSettings {
    let (entrant, rung) = (tried[place].entrant, tried[place].rung);
    let own = search.entrants[entrant].candidate_settings(search.settings);
    if rung == SelectionStage::Weak {
        let own = RefinementSettings { roll_strength: tried[place].roll_strength, ..own };
        return ridge_settings(&own, tried[place].weighed.ridge);
    }
    // Only evaluations before the first trajectory: later ones may be weak forms with a stronger
    // prior.
    let below = tried.iter().position(|one| one.rung == rung).unwrap_or(0);
    stage_settings(&own, rung, last_ridge(&tried[..below], entrant))
}

/// The refinement of a candidate by some settings.
fn refine_candidate(
    search: &CandidateSearch<'_>,
    (entrant, settings): (usize, &RefinementSettings),
    progress: Progress<'_>,
) -> Result<Refinement, RefineError> {
    let named = search.entrants[entrant].name();
    let told =
        |fraction: f64, what: &str| progress(0.9 + 0.1 * fraction, &format!("{named}: {what}"));
    refine(&candidate_request(search, entrant, settings), &told)
}

/// Reason against a fit whose refinement keeps the source.
const SOURCE_KEPT: &str = "no fit to all trials has less error than the source as it is";

/// Returns a refinement in which something was fitted, or the reason (inner error) why there is
/// none; a transferred source need not be fitted.
fn require_fitted(
    made: Result<Refinement, RefineError>,
    rung: SelectionStage,
) -> Result<Result<Refinement, String>, RefineError> {
    match made {
        Ok(made) if rung != SelectionStage::CarriedOver && made.is_source_kept() => {
            let reasons = made.refusal_reasons();
            Ok(Err(if reasons.is_empty() { SOURCE_KEPT.to_owned() } else { reasons }))
        }
        Ok(made) => Ok(Ok(made)),
        Err(error @ (RefineError::Cancelled | RefineError::Setting { .. })) => Err(error),
        Err(error) => Ok(Err(error.to_string())),
    }
}

/// The selection report with the place of the chosen candidate.
fn build_report(
    search: &CandidateSearch<'_>,
    tried: &[EvaluatedCandidate],
    best: usize,
) -> SelectionReport {
    let left = tried.iter().filter(|one| one.refusal.is_none());
    let least = left.filter_map(|one| one.weighed.error).fold(f64::INFINITY, f64::min);
    let reference = reference_place(search, tried);
    let accurate = preferred_place(search, tried, Preference::Accurate);
    let price =
        accurate.filter(|place| *place != best).map(|place| (place, price(tried, place, best)));
    let lines = tried.iter().enumerate();
    let line = |(k, one)| {
        let own = report_line(search, one, least, k == best);
        let reason = match &price {
            Some((_, price)) if k == best => price.clone(),
            Some((place, _)) if k == *place => MOST_ACCURATE.to_owned(),
            _ => own.reason,
        };
        ReportLine { reference: reference == Some(k), reason, ..own }
    };
    SelectionReport { lines: lines.map(line).collect(), branch: None }
}

/// Reason in the line of the model that the errors select, where another one is preferred.
const MOST_ACCURATE: &str = "what the errors select; `--prefer accurate` uses it";

/// Reason for a model of few parameters at a place, with what it costs and buys.
fn price(tried: &[EvaluatedCandidate], accurate: usize, best: usize) -> String {
    let ratio = |of: &dyn Fn(&CandidateEvaluation) -> Option<f64>| {
        let [own, other] = [best, accurate].map(|place| of(&tried[place].weighed));
        own.zip(other).map_or(f64::NAN, |(own, other)| own / other)
    };
    format!(
        "selected: {} physical coefficients and parameters in place of {}, {:.2} times its error and \
         {:.2} times its variance elsewhere",
        tried[best].weighed.coefficients,
        tried[accurate].weighed.coefficients,
        ratio(&|one| one.error),
        ratio(&|one| one.variance)
    )
}

/// Place of the first fit of the reference.
fn reference_place(search: &CandidateSearch<'_>, tried: &[EvaluatedCandidate]) -> Option<usize> {
    let entrant = search.reference_candidate()?;
    tried.iter().position(|one| one.entrant == entrant && one.rung == SelectionStage::Weak)
}

/// Line of the report for one evaluated candidate; `least` is the least error of all that were not
/// refused.
fn report_line(
    search: &CandidateSearch<'_>,
    tried: &EvaluatedCandidate,
    least: f64,
    chosen: bool,
) -> ReportLine {
    let entrant = &search.entrants[tried.entrant];
    let ratio = tried.weighed.error.unwrap_or(f64::INFINITY) / least;
    let outcome = match chosen {
        true if entrant.held_by == CandidatePrior::Population => {
            "selected: population prior, no other candidate significantly better (95 %)".to_owned()
        }
        true => "selected: smallest error plus five times the variance elsewhere, among \
                 statistically tied candidates"
            .to_owned(),
        false => format!("{ratio:.2} times the smallest error"),
    };
    let reason = tried.refusal.clone().or_else(|| tried.weighed.reason.clone());
    ReportLine {
        source: entrant.source_name().map(str::to_owned),
        law: entrant.law.name.clone(),
        rung: tried.rung,
        coefficients: tried.weighed.coefficients,
        effective: tried.weighed.effective,
        error: tried.weighed.error,
        standard_error: standard_error(&tried.weighed),
        variance: tried.weighed.variance.filter(|variance| variance.is_finite()),
        cost_s: tried.cost_s,
        chosen,
        reference: false,
        reason: reason.unwrap_or(outcome),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::candidate::SelectionCandidate;
    use sistership_identification::refine::{EstimationMethod, RefinementSpec, TermFamily};
    use sistership_identification::testing::{
        mariner_model, simulated_trials, with_scaled_coefficients,
    };
    use sistership_model::Zoo;

    #[test]
    fn a_source_that_is_kept_is_not_what_was_chosen() {
        let (zoo, (model, law)) = (Zoo::load_embedded().unwrap(), mariner_model());
        let trials = simulated_trials(&model, &law, 0.0);
        let trials: Vec<_> = trials.iter().collect();
        let settings =
            RefinementSettings { method: EstimationMethod::Weak, ..RefinementSettings::default() };
        let request = RefinementSpec {
            target: zoo.vessel("mariner").unwrap(),
            source: &model,
            source_law: None,
            law: &law,
            trials: &trials,
            population: &[],
            settings: &settings,
        };
        let made = refine(&request, &|_, _| true).unwrap();
        assert!(made.is_source_kept(), "the trials are the source's own");
        assert!(require_fitted(Ok(made.clone()), SelectionStage::Weak).unwrap().is_err());
        assert_eq!(
            require_fitted(Ok(made.clone()), SelectionStage::CarriedOver).unwrap(),
            Ok(made)
        );
        assert!(require_fitted(Err(RefineError::Cancelled), SelectionStage::Weak).is_err());
    }

    #[test]
    fn the_reference_keeps_its_error_where_it_is_refused() {
        let (zoo, (model, law)) = (Zoo::load_embedded().unwrap(), mariner_model());
        let source_law = Some(law.clone());
        let alone = SelectionCandidate {
            source: model.clone(),
            source_law: None,
            law: law.clone(),
            held_by: CandidatePrior::Source,
        };
        let similar =
            SelectionCandidate { source: model, source_law, law, held_by: CandidatePrior::Source };
        let search = CandidateSearch {
            target: zoo.vessel("mariner").unwrap(),
            entrants: &[alone, similar],
            trials: &[],
            population: &[],
            settings: &RefinementSettings::default(),
            preference: Preference::default(),
        };
        let tried = |entrant, error, refusal: Option<&str>| EvaluatedCandidate {
            entrant,
            rung: SelectionStage::Weak,
            weighed: CandidateEvaluation {
                error: Some(error),
                reason: None,
                ..CandidateEvaluation::with_refusal(String::new())
            },
            refinement: None,
            cost_s: 0.0,
            roll_strength: None,
            refusal: refusal.map(str::to_owned),
        };
        let all = [tried(0, 0.2, None), tried(1, 0.1, Some("does not sail"))];
        let ladder = build_report(&search, &all, 0);
        let line = &ladder.lines[1];
        assert!(line.reference && !line.chosen && !ladder.lines[0].reference);
        assert_eq!((line.error, line.reason.as_str()), (Some(0.1), "does not sail"));
        assert_eq!(ladder.lines[0].reason.split(' ').next(), Some("selected:"), "chosen");
        let words = ladder.reference_summary();
        assert!(words.contains("mariner/") && words.contains("0.50 times"), "{words}");
    }

    #[test]
    fn roll_is_held_more_with_every_refusal() {
        let zoo = Zoo::load_embedded().unwrap();
        let law = |name: &str| zoo.law(name).unwrap();
        assert_eq!(stronger_roll(law("abkowitz"), None), None);
        let once = stronger_roll(law("abkowitz-roll"), None);
        let twice = stronger_roll(law("abkowitz-roll"), once);
        assert_eq!((once, twice), (Some(10.0), Some(100.0)));
    }

    #[test]
    fn what_cannot_be_taken_is_tried_nearer_to_its_source() {
        let (zoo, (model, law)) = (Zoo::load_embedded().unwrap(), mariner_model());
        let trials = simulated_trials(&with_scaled_coefficients(&model, |_| 1.1), &law, 0.001);
        let trials: Vec<_> = trials.iter().collect();
        let entrant = SelectionCandidate {
            source: model,
            source_law: Some(law.clone()),
            law,
            held_by: CandidatePrior::Source,
        };
        let search = CandidateSearch {
            target: zoo.vessel("mariner").unwrap(),
            entrants: &[entrant],
            trials: &trials,
            population: &[],
            settings: &RefinementSettings::default(),
            preference: Preference::default(),
        };
        let refused = |rung, lambda| {
            let ridge = Some((TermFamily::Own, lambda));
            let weighed =
                CandidateEvaluation { ridge, ..CandidateEvaluation::with_refusal(String::new()) };
            let (refinement, roll_strength) = (None, None);
            let refusal = Some("does not sail".to_owned());
            EvaluatedCandidate {
                entrant: 0,
                rung,
                weighed,
                refinement,
                cost_s: 0.0,
                roll_strength,
                refusal,
            }
        };
        let again = |rung, lambda| {
            let refused = refused(rung, lambda);
            refit_stronger(&search, &refused, &|_, _| true).unwrap()
        };
        let nearer = again(SelectionStage::Weak, 1e-6).unwrap();
        assert!(nearer.rung == SelectionStage::Weak && nearer.weighed.error.is_some());
        assert!(nearer.weighed.ridge.unwrap().1 > 3e-6);
        assert!(again(SelectionStage::Weak, 10.0).is_none(), "no strength is left");
        assert!(again(SelectionStage::Trajectory, 1e-6).is_none());
    }
}
