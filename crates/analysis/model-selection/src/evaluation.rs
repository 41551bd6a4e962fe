//! Evaluation of candidates at the stages, and the settings of each.

use std::time::Instant;

use sistership_model::Vessel;
use sistership_model::trial::Trial;

use crate::candidate::{CandidatePrior, SelectionCandidate};
use crate::choice::choose_candidate;
use crate::preference::{Preference, defensible_place};
use crate::selection_report::SelectionStage;
use crate::thresholds::SEARCH;
use sistership_identification::refine::{
    CandidateEvaluation, PopulationShip, Progress, RefineError, Refinement, RefinementExtent,
    RefinementSettings, RefinementSpec, SourceEnvelopes, TermFamily, evaluate_candidates,
};

/// Inputs of the search.
#[derive(Debug, Clone, Copy)]
pub struct CandidateSearch<'a> {
    /// The ship.
    pub target: &'a Vessel,
    /// Candidates.
    pub entrants: &'a [SelectionCandidate],
    /// All trials; those that the settings hold out are not used.
    pub trials: &'a [&'a Trial],
    /// Ships of the population.
    pub population: &'a [PopulationShip],
    /// Settings except the method.
    pub settings: &'a RefinementSettings,
    /// Preference for the least error, or for few physical parameters.
    pub preference: Preference,
}

impl<'a> CandidateSearch<'a> {
    /// Returns the trials that are used.
    pub(super) fn fitted_trials(&self) -> Vec<&'a Trial> {
        let held_out = &self.settings.held_out;
        self.trials.iter().copied().filter(|trial| !held_out.contains(&trial.name)).collect()
    }

    /// Returns the place of the reference: the most similar eligible ship by correlation, under its
    /// own law if that can be fitted, with the source as l2 prior. `None` without such a ship.
    pub(super) fn reference_candidate(&self) -> Option<usize> {
        let is_source = |one: &SelectionCandidate| {
            one.source_law.is_some() && one.held_by == CandidatePrior::Source
        };
        self.entrants.iter().position(is_source)
    }
}

/// An evaluated candidate, with its stage.
pub(super) struct EvaluatedCandidate {
    pub entrant: usize,
    pub rung: SelectionStage,
    pub weighed: CandidateEvaluation,
    /// Its refinement, if that was computed with the evaluation.
    pub refinement: Option<Refinement>,
    pub cost_s: f64,
    /// Factor of roll's prior on the likeliest strength; none for a factor of 1.
    pub roll_strength: Option<f64>,
    /// Reason why it is excluded after its evaluation, if so.
    pub refusal: Option<String>,
}

/// Returns the request that refines a candidate by some settings.
pub(super) fn candidate_request<'a>(
    search: &CandidateSearch<'a>,
    entrant: usize,
    settings: &'a RefinementSettings,
) -> RefinementSpec<'a> {
    let entrant = &search.entrants[entrant];
    RefinementSpec {
        target: search.target,
        source: &entrant.source,
        source_law: entrant.source_law.as_deref(),
        law: &entrant.law,
        trials: search.trials,
        population: search.population,
        settings,
    }
}

/// Returns the evaluation of a candidate at a stage; a candidate that cannot be fitted is excluded
/// with the reason.
pub(super) fn stage_evaluation(
    rung: SelectionStage,
    weighed: Result<Vec<CandidateEvaluation>, RefineError>,
) -> Result<CandidateEvaluation, RefineError> {
    let (of_source, of_fit) = (0, 1);
    // Evaluations are those of the source and of the best fit, in this order.
    let wanted = if rung == SelectionStage::CarriedOver { of_source } else { of_fit };
    match weighed {
        // Cancellation and wrong settings end the search; all other errors exclude the candidate
        // alone.
        Err(error @ (RefineError::Cancelled | RefineError::Setting { .. })) => Err(error),
        Err(error) => Ok(CandidateEvaluation::with_refusal(error.to_string())),
        Ok(all) => {
            let no_fit = || {
                CandidateEvaluation::with_refusal(
                    "the trials are not sufficient for a fit".to_owned(),
                )
            };
            Ok(all.into_iter().nth(wanted).unwrap_or_else(no_fit))
        }
    }
}

/// Evaluates a candidate at a stage by its settings.
pub(super) fn evaluate_candidate(
    (search, known): (&CandidateSearch<'_>, &SourceEnvelopes),
    (entrant, rung): (usize, SelectionStage),
    settings: &RefinementSettings,
    progress: Progress<'_>,
) -> Result<EvaluatedCandidate, RefineError> {
    let begun = Instant::now();
    let extent = if rung == SelectionStage::CarriedOver {
        RefinementExtent::Source
    } else {
        RefinementExtent::Estimator
    };
    let settings = stage_settings(settings, rung, None);
    let weighed = evaluate_candidates(
        (&candidate_request(search, entrant, &settings), known),
        extent,
        progress,
    );
    let weighed = stage_evaluation(rung, weighed)?;
    let cost_s = begun.elapsed().as_secs_f64();
    let roll_strength = settings.roll_strength;
    Ok(EvaluatedCandidate {
        entrant,
        rung,
        weighed,
        refinement: None,
        cost_s,
        roll_strength,
        refusal: None,
    })
}

/// Returns the place of the chosen candidate among those that were not refused.
pub(super) fn chosen_place(
    search: &CandidateSearch<'_>,
    tried: &[EvaluatedCandidate],
) -> Option<usize> {
    preferred_place(search, tried, search.preference)
}

/// Returns the place of the candidate that a preference chooses among those that were not refused.
pub(super) fn preferred_place(
    search: &CandidateSearch<'_>,
    tried: &[EvaluatedCandidate],
    preference: Preference,
) -> Option<usize> {
    let is_held = |one: &EvaluatedCandidate| {
        search.entrants[one.entrant].held_by == CandidatePrior::Population
    };
    let left: Vec<(usize, &EvaluatedCandidate)> =
        tried.iter().enumerate().filter(|(_, one)| one.refusal.is_none()).collect();
    let all: Vec<_> = left.iter().map(|(_, one)| (&one.weighed, is_held(one))).collect();
    let accurate = choose_candidate(&all)?;
    let is_physical =
        |one: &EvaluatedCandidate| search.entrants[one.entrant].law.parameter_priors().count() > 0;
    let physical: Vec<_> = left.iter().map(|(_, one)| (&one.weighed, is_physical(one))).collect();
    let defensible = match preference {
        Preference::Accurate => None,
        Preference::Defensible => defensible_place(&physical, accurate),
    };
    Some(left[defensible.unwrap_or(accurate)].0)
}

/// Family and strength of a candidate's last evaluation.
pub(super) fn last_ridge(
    tried: &[EvaluatedCandidate],
    entrant: usize,
) -> Option<(TermFamily, f64)> {
    // Later stages come later in the list.
    tried.iter().rev().find(|one| one.entrant == entrant)?.weighed.ridge
}

/// Returns the settings by which a candidate is fitted at a stage. As transferred, the prior is so
/// strong that the source stays; in weak form few strengths are tried; trajectories start near the
/// best of those.
pub(super) fn stage_settings(
    settings: &RefinementSettings,
    rung: SelectionStage,
    ridge: Option<(TermFamily, f64)>,
) -> RefinementSettings {
    // Families and strengths that the request names take precedence over those of the stage.
    let mut settings = RefinementSettings { method: rung.method(), ..settings.clone() };
    let (families, strengths) = match (rung, ridge) {
        (SelectionStage::CarriedOver, _) => (vec![TermFamily::Own], vec![SEARCH.kept]),
        (SelectionStage::Weak, _) | (SelectionStage::Trajectory, None) => {
            (Vec::new(), SEARCH.strengths.to_vec())
        }
        (SelectionStage::Trajectory, Some((family, lambda))) => {
            (vec![family], SEARCH.near.map(|factor| factor * lambda).to_vec())
        }
    };
    if settings.families.is_empty() {
        settings.families = families;
    }
    if settings.strengths.is_empty() {
        settings.strengths = strengths;
    }
    settings
}

/// Returns the settings that give one weak form and no other: the others have been tried already.
pub(super) fn ridge_settings(
    settings: &RefinementSettings,
    ridge: Option<(TermFamily, f64)>,
) -> RefinementSettings {
    let mut settings = settings.clone();
    if let Some((family, lambda)) = ridge {
        settings.families = vec![family];
        settings.strengths = vec![lambda];
    }
    stage_settings(&settings, SelectionStage::Weak, None)
}
