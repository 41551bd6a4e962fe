//! The default call: a refinement without a given source, law or method.

use std::collections::BTreeMap;

use sistership_model::trial::Trial;
use sistership_model::{Model, Vessel, Zoo};

use crate::branch::branch;
use crate::entrant::{Beside, Entrant, HeldBy, entrants};
use crate::foundation::Foundation;
use crate::ladder::Ladder;
use crate::population::{asked_at, population};
use crate::search::search;
use crate::thresholds::SEARCH;
use crate::tried::{Search, request};
use sistership_identification::refine::{Member, Progress, RefineError, Refinement, Settings};
use sistership_priors::source::{Similarity, similar_with};

/// Request of a default refinement.
#[derive(Debug, Clone, Copy)]
pub struct Asked<'a> {
    /// Ships and laws.
    pub zoo: &'a Zoo,
    /// The ship.
    pub target: &'a Vessel,
    /// Models better than the published ones, by ship.
    pub champions: &'a BTreeMap<String, Model>,
    /// All trials.
    pub trials: &'a [&'a Trial],
    /// Settings except the method; trials that they hold out are not used.
    pub settings: &'a Settings,
}

/// The selected source, law and method, with the evidence for them.
#[derive(Debug, Clone)]
pub struct Start {
    /// The source and the law to fit.
    pub entrant: Entrant,
    /// Ships of the population that is its prior; empty for other priors.
    pub population: Vec<Member>,
    /// Settings that name the method.
    pub settings: Settings,
    /// Ranking of the ships by similarity.
    pub similarity: Similarity,
    /// Selection report.
    pub ladder: Ladder,
    /// The refinement itself.
    pub refinement: Refinement,
}

/// Selects source, law and method, and refines by them.
///
/// # Errors
/// Returns an error if it was cancelled, a setting is refused, or no candidate could be simulated
/// to its end.
pub fn best_start(asked: &Asked<'_>, progress: Progress<'_>) -> Result<Start, RefineError> {
    let Asked { zoo, target, champions, trials, settings } = *asked;
    let held_out = &settings.held_out;
    let fitted: Vec<&Trial> =
        trials.iter().copied().filter(|trial| !held_out.contains(&trial.name)).collect();
    let similarity = similar_with(zoo, target, None, &fitted, champions);
    let population = population(zoo, target);
    // With few trials the estimate from particulars is a candidate as well.
    let beside = Beside {
        estimate: fitted.len() < SEARCH.few,
        population: asked_at(&population, &similarity),
    };
    let entrants = entrants(zoo, target, (&sources(asked, &similarity), beside), &fitted);
    let all = Search { target, entrants: &entrants, trials, population: &population, settings };
    let winner = search(&all, progress)?;
    let foundation = Foundation {
        request: request(&all, winner.entrant, &winner.settings),
        refinement: &winner.refinement,
        folds: &winner.folds,
        trials: &fitted,
    };
    let branch = Some(branch(&foundation, progress)?);
    let (entrant, refinement) = (entrants[winner.entrant].clone(), winner.refinement);
    let ladder = Ladder { branch, ..winner.ladder };
    // The population is part of the recipe only if the chosen candidate depends on it.
    let is_held = entrant.held_by == HeldBy::Population;
    let population = if is_held { population } else { Vec::new() };
    Ok(Start { entrant, population, settings: winner.settings, similarity, ladder, refinement })
}

/// Models of the first eligible ships: the version in use of a ship, else the published model. A
/// file that cannot be read is skipped.
fn sources(asked: &Asked<'_>, similarity: &Similarity) -> Vec<Model> {
    let model = |ship: &str, name: &str| match asked.champions.get(ship) {
        Some(champion) => Some(champion.clone()),
        None => asked.zoo.model(name).ok(),
    };
    let named =
        similarity.eligible().filter_map(|ranked| Some((&ranked.ship, ranked.model.as_ref()?)));
    named.filter_map(|(ship, name)| model(ship, name)).take(SEARCH.sources).collect()
}
