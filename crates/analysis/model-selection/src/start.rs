//! Where a refinement starts that names neither source, law nor method.

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

/// What is to be started.
#[derive(Debug, Clone, Copy)]
pub struct Asked<'a> {
    /// Ships and laws.
    pub zoo: &'a Zoo,
    /// The ship.
    pub target: &'a Vessel,
    /// Models better than the published ones, by ship.
    pub champions: &'a BTreeMap<String, Model>,
    /// Every trial.
    pub trials: &'a [&'a Trial],
    /// Settings but the method; trials that they keep out have no say.
    pub settings: &'a Settings,
}

/// Where to start, and how that was found.
#[derive(Debug, Clone)]
pub struct Start {
    /// The source and the law to fit.
    pub entrant: Entrant,
    /// The ships whose population holds it; none where something else does.
    pub population: Vec<Member>,
    /// Settings that name the method.
    pub settings: Settings,
    /// How ships ranked.
    pub similarity: Similarity,
    /// What was tried.
    pub ladder: Ladder,
    /// The refinement itself.
    pub refinement: Refinement,
}

/// Finds the best start.
///
/// # Errors
/// It was cancelled, a setting is refused, or no entrant could be simulated to its end.
pub fn best_start(asked: &Asked<'_>, progress: Progress<'_>) -> Result<Start, RefineError> {
    let Asked { zoo, target, champions, trials, settings } = *asked;
    let held_out = &settings.held_out;
    let fitted: Vec<&Trial> =
        trials.iter().copied().filter(|trial| !held_out.contains(&trial.name)).collect();
    let similarity = similar_with(zoo, target, None, &fitted, champions);
    let population = population(zoo, target);
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
    let is_held = entrant.held_by == HeldBy::Population;
    let population = if is_held { population } else { Vec::new() };
    Ok(Start { entrant, population, settings: winner.settings, similarity, ladder, refinement })
}

/// The models of the first eligible ships; a file that does not read is no source.
fn sources(asked: &Asked<'_>, similarity: &Similarity) -> Vec<Model> {
    let model = |ship: &str, name: &str| match asked.champions.get(ship) {
        Some(champion) => Some(champion.clone()),
        None => asked.zoo.model(name).ok(),
    };
    let named =
        similarity.eligible().filter_map(|ranked| Some((&ranked.ship, ranked.model.as_ref()?)));
    named.filter_map(|(ship, name)| model(ship, name)).take(SEARCH.sources).collect()
}
