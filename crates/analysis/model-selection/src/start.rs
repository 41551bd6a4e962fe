//! The default call: a refinement without a given source, law or method.

use std::collections::BTreeMap;

use sistership_model::trial::Trial;
use sistership_model::{Model, Vessel, Zoo};

use crate::candidate::{AdditionalPriors, CandidatePrior, SelectionCandidate, list_candidates};
use crate::correction_choice::choose_correction;
use crate::evaluation::{CandidateSearch, candidate_request};
use crate::foundation::CorrectionBase;
use crate::population::{envelope_source, similar_population};
use crate::preference::Preference;
use crate::search::search_candidates;
use crate::selection_report::SelectionReport;
use crate::thresholds::SEARCH;
use sistership_identification::refine::{
    PopulationShip, Progress, RefineError, Refinement, RefinementSettings,
};
use sistership_priors::source::{SimilarityRanking, rank_similar_with};

/// Request of a default refinement.
#[derive(Debug, Clone, Copy)]
pub struct StartRequest<'a> {
    /// Ships and laws.
    pub zoo: &'a Zoo,
    /// The ship.
    pub target: &'a Vessel,
    /// Models better than the published ones, by ship.
    pub champions: &'a BTreeMap<String, Model>,
    /// All trials.
    pub trials: &'a [&'a Trial],
    /// Settings except the method; trials that they hold out are not used.
    pub settings: &'a RefinementSettings,
    /// Preference for the least error, or for few physical parameters.
    pub preference: Preference,
}

/// The selected source, law and method, with the evidence for them.
#[derive(Debug, Clone)]
pub struct StartSelection {
    /// The source and the law to fit.
    pub entrant: SelectionCandidate,
    /// Ships of the population that is its prior; empty for other priors.
    pub population: Vec<PopulationShip>,
    /// Settings that name the method.
    pub settings: RefinementSettings,
    /// Ranking of the ships by similarity.
    pub similarity: SimilarityRanking,
    /// Selection report.
    pub ladder: SelectionReport,
    /// The refinement itself.
    pub refinement: Refinement,
}

/// Selects source, law and method, and refines by them.
///
/// # Errors
/// Returns an error if it was cancelled, a setting is refused, or no candidate could be simulated
/// to its end.
pub fn best_start(
    asked: &StartRequest<'_>,
    progress: Progress<'_>,
) -> Result<StartSelection, RefineError> {
    let StartRequest { zoo, target, champions, trials, settings, preference } = *asked;
    let held_out = &settings.held_out;
    let fitted: Vec<&Trial> =
        trials.iter().copied().filter(|trial| !held_out.contains(&trial.name)).collect();
    let similarity = rank_similar_with(zoo, target, None, &fitted, champions);
    let population = similar_population(zoo, target);
    // With few trials the estimate from particulars is a candidate as well.
    let beside = AdditionalPriors {
        estimate: fitted.len() < SEARCH.few,
        population: envelope_source(&population, &similarity),
    };
    let entrants =
        list_candidates(zoo, target, (&source_models(asked, &similarity), beside), &fitted);
    let all = CandidateSearch {
        target,
        entrants: &entrants,
        trials,
        population: &population,
        settings,
        preference,
    };
    let winner = search_candidates(&all, progress)?;
    let foundation = CorrectionBase {
        request: candidate_request(&all, winner.entrant, &winner.settings),
        refinement: &winner.refinement,
        folds: &winner.folds,
        trials: &fitted,
    };
    let branch = Some(choose_correction(&foundation, progress)?);
    let (entrant, refinement) = (entrants[winner.entrant].clone(), winner.refinement);
    let ladder = SelectionReport { branch, ..winner.ladder };
    // The population is part of the recipe only if the chosen candidate depends on it.
    let is_held = entrant.held_by == CandidatePrior::Population;
    let population = if is_held { population } else { Vec::new() };
    Ok(StartSelection {
        entrant,
        population,
        settings: winner.settings,
        similarity,
        ladder,
        refinement,
    })
}

/// Models of the first eligible ships: the version in use of a ship, else the published model. A
/// file that cannot be read is skipped.
fn source_models(asked: &StartRequest<'_>, similarity: &SimilarityRanking) -> Vec<Model> {
    let model = |ship: &str, name: &str| match asked.champions.get(ship) {
        Some(champion) => Some(champion.clone()),
        None => asked.zoo.find_model(name).ok(),
    };
    let named = similarity
        .eligible_sources()
        .filter_map(|ranked| Some((&ranked.ship, ranked.model.as_ref()?)));
    named.filter_map(|(ship, name)| model(ship, name)).take(SEARCH.sources).collect()
}
