//! Candidates of the search: sources with the laws that can be fitted to the measured channels.

use std::sync::Arc;

use sistership_model::trial::{Channel, Trial};
use sistership_model::{Law, Model, Vessel, Zoo};

use sistership_identification::refine::{Prior, RefinementSettings};
use sistership_priors::transfer::{blank_model, trial_approach};

/// General laws, which belong to no ship.
const GENERAL: [&str; 5] =
    ["low-speed", "abkowitz", "abkowitz-roll", "differential-thrust", PHYSICAL_LAW];

/// General law of few physical coefficients and parameters.
pub(super) const PHYSICAL_LAW: &str = "modular";

/// Law of the candidate with a prior from a population: the most general one without roll, on which
/// few ships give information.
pub(super) const POPULATION_LAW: &str = "low-speed";

/// A candidate: a source, or none, with the law to be fitted.
#[derive(Debug, Clone)]
pub struct SelectionCandidate {
    /// Starting point of the fit; without coefficients if there is no source.
    pub source: Model,
    /// Law of the source; none if there is no source.
    pub source_law: Option<Arc<Law>>,
    /// The law to be fitted.
    pub law: Arc<Law>,
    /// Prior of the coefficients.
    pub held_by: CandidatePrior,
}

/// Prior of a candidate's coefficients.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CandidatePrior {
    /// The source.
    Source,
    /// The estimate from the ship's particulars in place of the source ([`Prior::Mixture`] at its
    /// end).
    Estimate,
    /// A population of ships ([`Prior::Population`]).
    Population,
}

impl SelectionCandidate {
    /// Returns the name for reports.
    pub fn name(&self) -> String {
        let source = self.source_name().unwrap_or("no source");
        format!("{source}, {}", self.law.name)
    }

    /// Returns the source's name; `None` if only the trials determine the model.
    pub fn source_name(&self) -> Option<&str> {
        let name = match self.held_by {
            CandidatePrior::Source => &self.source.name,
            CandidatePrior::Estimate => "estimate",
            CandidatePrior::Population => "population",
        };
        self.source_law.as_ref().map(|_| name)
    }

    /// Returns the settings by which it is fitted.
    pub fn candidate_settings(&self, settings: &RefinementSettings) -> RefinementSettings {
        match self.held_by {
            CandidatePrior::Source => settings.clone(),
            CandidatePrior::Estimate => RefinementSettings {
                prior: Prior::Mixture,
                mixture_positions: vec![1.0],
                ..settings.clone()
            },
            CandidatePrior::Population => {
                RefinementSettings { prior: Prior::Population, ..settings.clone() }
            }
        }
    }
}

/// Additional priors besides those of the sources.
#[derive(Debug, Clone, Copy, Default)]
pub struct AdditionalPriors<'a> {
    /// True to add the estimate from the ship's particulars.
    pub estimate: bool,
    /// Model at the states of whose manoeuvres a population is evaluated; none without a
    /// population.
    pub population: Option<&'a Model>,
}

/// Returns the candidates: each source with its own law and the general ones, estimate and
/// population with the general laws if they are requested, and each general law without a source.
pub fn list_candidates(
    zoo: &Zoo,
    target: &Vessel,
    (sources, beside): (&[Model], AdditionalPriors<'_>),
    trials: &[&Trial],
) -> Vec<SelectionCandidate> {
    let general: Vec<Arc<Law>> = GENERAL
        .iter()
        .filter_map(|name| zoo.law(name).cloned())
        .filter(|law| is_measured(law, trials))
        .collect();
    // A typical ship is a better prior of the physical law than the accelerations of another one
    // (docs/evidence/physical_law.md); with few trials there is no candidate without a source.
    let is_regressed = |law: &&Arc<Law>| beside.estimate || law.typical.is_empty();
    let regressed: Vec<Arc<Law>> = general.iter().filter(is_regressed).cloned().collect();
    let with_source =
        sources.iter().flat_map(|source| source_candidates(zoo, source, &regressed, trials));
    let approach = trial_approach(trials);
    // Without a source the trials alone determine the coefficients, from a model without any.
    let alone = general.iter().filter_map(|law| {
        let source = blank_model(law, target, approach).ok()?;
        let held_by = CandidatePrior::Source;
        Some(SelectionCandidate { source, source_law: None, law: law.clone(), held_by })
    });
    // The estimate alone is the end of a mixture, which requires a source of another ship.
    let others = || sources.iter().filter(|source| source.ship != target.name());
    let estimated = others().take(usize::from(beside.estimate)).flat_map(|source| {
        let entrants = source_candidates(zoo, source, &general, trials).into_iter();
        let is_general = |one: &SelectionCandidate| GENERAL.contains(&one.law.name.as_str());
        entrants
            .filter(is_general)
            .map(|one| SelectionCandidate { held_by: CandidatePrior::Estimate, ..one })
    });
    let population = beside.population.into_iter().flat_map(|source| {
        let entrants = source_candidates(zoo, source, &general, trials).into_iter();
        let is_theirs = |one: &SelectionCandidate| one.law.name == POPULATION_LAW;
        entrants
            .filter(is_theirs)
            .map(|one| SelectionCandidate { held_by: CandidatePrior::Population, ..one })
    });
    with_source.chain(estimated).chain(population).chain(alone).collect()
}

/// Candidates of one source: its own law and the general ones, as far as they are measured.
fn source_candidates(
    zoo: &Zoo,
    source: &Model,
    general: &[Arc<Law>],
    trials: &[&Trial],
) -> Vec<SelectionCandidate> {
    let Some(own) = zoo.law(&source.law) else { return Vec::new() };
    // The accelerations of a ship with a rudder are no prior of one without.
    let is_other = |law: &&Arc<Law>| {
        law.name != own.name && law.steers_by_difference() == own.steers_by_difference()
    };
    let others = general.iter().filter(is_other);
    let laws = std::iter::once(own).filter(|law| is_measured(law, trials)).chain(others);
    let one = |law: &Arc<Law>| SelectionCandidate {
        source: source.clone(),
        source_law: Some(own.clone()),
        law: law.clone(),
        held_by: CandidatePrior::Source,
    };
    laws.map(one).collect()
}

/// Returns true if the trials record what a law needs: roll in every trial for a law with roll,
/// revolutions for the slipstream of the physical law, and what steers. A law without a steering
/// angle is one for ships whose trials have none.
fn is_measured(law: &Law, trials: &[&Trial]) -> bool {
    let everywhere = |channel: Channel| trials.iter().all(|trial| trial.channel(channel).is_some());
    let steers = match law.steers_by_difference() {
        true => {
            trials.iter().all(|trial| trial.channel(Channel::Delta).is_none())
                && law
                    .helm_inputs()
                    .filter_map(|(_, name, _)| Channel::by_name(name))
                    .all(everywhere)
        }
        false => !law.follows_helm() || everywhere(Channel::Delta),
    };
    steers
        && (!law.has_roll() || everywhere(Channel::Phi))
        && (law.name != PHYSICAL_LAW || everywhere(Channel::N))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_difference_of_thrusters_is_fitted_where_no_angle_steers() {
        let zoo = Zoo::load_embedded().unwrap();
        let target = zoo.vessel("kcs").unwrap();
        let models = ["mariner", "kvlcc2"].map(|name| zoo.find_model(name).unwrap());
        let mut trial = Trial { t_s: vec![0.0], ..Trial::default() };
        let laws = |trial: &Trial| {
            let beside = AdditionalPriors { estimate: true, population: Some(&models[1]) };
            let all = list_candidates(&zoo, target, (&models[..], beside), &[trial]);
            all.into_iter().map(|one| one.law.name.clone()).collect::<Vec<_>>()
        };
        trial.channels.extend([Channel::NS, Channel::NP].map(|side| (side, vec![1.0])));
        assert_eq!(laws(&trial), ["differential-thrust"], "without a source");
        trial.channels.insert(Channel::Delta, vec![0.1]);
        let steered = laws(&trial);
        assert!(steered.len() > 3 && !steered.contains(&"differential-thrust".to_owned()));
    }

    #[test]
    fn estimate_and_population_enter_beside_a_source_of_another_ship() {
        let zoo = Zoo::load_embedded().unwrap();
        let target = zoo.vessel("kcs").unwrap();
        let models = ["kcs", "mariner"].map(|name| zoo.find_model(name).unwrap());
        let beside = AdditionalPriors { estimate: true, population: Some(&models[1]) };
        let held = |sources: &[Model], beside, by| {
            let all = list_candidates(&zoo, target, (sources, beside), &[]);
            all.into_iter().filter(|one| one.held_by == by).collect::<Vec<_>>()
        };
        for by in [CandidatePrior::Estimate, CandidatePrior::Population] {
            assert!(held(&models, AdditionalPriors::default(), by).is_empty());
            let found = held(&models, beside, by);
            assert!(!found.is_empty() && found.iter().all(|one| one.source.ship == "mariner"));
        }
        assert!(held(&models[..1], beside, CandidatePrior::Estimate).is_empty());
        let estimate = &held(&models, beside, CandidatePrior::Estimate)[0];
        assert!(estimate.name().starts_with("estimate, "), "{}", estimate.name());
        let settings = estimate.candidate_settings(&RefinementSettings::default());
        assert_eq!((settings.prior, settings.mixture_positions), (Prior::Mixture, vec![1.0]));
        let population = held(&models, beside, CandidatePrior::Population);
        assert_eq!(population.iter().map(|one| &*one.law.name).collect::<Vec<_>>(), ["low-speed"]);
        assert_eq!(
            population[0].candidate_settings(&RefinementSettings::default()).prior,
            Prior::Population
        );
    }
}
