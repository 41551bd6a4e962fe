//! What enters the search: sources with the laws that can be fitted to what was measured.

use std::sync::Arc;

use sistership_model::trial::{Channel, Trial};
use sistership_model::{Law, Model, Vessel, Zoo};

use sistership_estimate::refine::{Prior, Settings};
use sistership_sources::transfer::{approach_of, blank};

/// Laws that belong to no ship.
const GENERAL: [&str; 3] = ["low-speed", "abkowitz", "abkowitz-roll"];

/// A source, or none, with the law to be fitted.
#[derive(Debug, Clone)]
pub struct Entrant {
    /// Where the fit starts; without coefficients where there is no source.
    pub source: Model,
    /// The law of the source; none where there is no source.
    pub source_law: Option<Arc<Law>>,
    /// The law to be fitted.
    pub law: Arc<Law>,
    /// Whether the estimate from the ship's particulars stands in the source's place
    /// ([`Prior::Mixture`] at its end).
    pub is_estimate: bool,
}

/// What the estimate is called where sources are named.
const ESTIMATE: &str = "estimate";

impl Entrant {
    /// What it is, for people.
    pub fn name(&self) -> String {
        let source = self.source_name().unwrap_or("no source");
        format!("{source}, {}", self.law.name)
    }

    /// The source's name; none where the trials alone make the model.
    pub fn source_name(&self) -> Option<&str> {
        let name = if self.is_estimate { ESTIMATE } else { &self.source.name };
        self.source_law.as_ref().map(|_| name)
    }

    /// Settings by which it is fitted.
    pub fn settings(&self, settings: &Settings) -> Settings {
        match self.is_estimate {
            true => {
                Settings { prior: Prior::Mixture, mixture_positions: vec![1.0], ..settings.clone() }
            }
            false => settings.clone(),
        }
    }
}

/// Each source with its own law and the general ones, the estimate with the general ones where it
/// is asked for, and each general law without a source.
pub fn entrants(
    zoo: &Zoo,
    target: &Vessel,
    (sources, with_estimate): (&[Model], bool),
    trials: &[&Trial],
) -> Vec<Entrant> {
    let general: Vec<Arc<Law>> = GENERAL
        .iter()
        .filter_map(|name| zoo.law(name).cloned())
        .filter(|law| is_measured(law, trials))
        .collect();
    let with_source = sources.iter().flat_map(|source| of_source(zoo, source, &general, trials));
    let approach = approach_of(trials);
    let alone = general.iter().filter_map(|law| {
        let source = blank(law, target, approach).ok()?;
        Some(Entrant { source, source_law: None, law: law.clone(), is_estimate: false })
    });
    // What an order names beside the estimate is a source of another ship.
    let other = sources.iter().find(|source| source.ship != target.name() && with_estimate);
    let estimated = other.into_iter().flat_map(|source| {
        let entrants = of_source(zoo, source, &general, trials).into_iter();
        let is_general = |one: &Entrant| GENERAL.contains(&one.law.name.as_str());
        entrants.filter(is_general).map(|one| Entrant { is_estimate: true, ..one })
    });
    with_source.chain(estimated).chain(alone).collect()
}

fn of_source(zoo: &Zoo, source: &Model, general: &[Arc<Law>], trials: &[&Trial]) -> Vec<Entrant> {
    let Some(own) = zoo.law(&source.law) else { return Vec::new() };
    let others = general.iter().filter(|law| law.name != own.name);
    let laws = std::iter::once(own).filter(|law| is_measured(law, trials)).chain(others);
    let one = |law: &Arc<Law>| Entrant {
        source: source.clone(),
        source_law: Some(own.clone()),
        law: law.clone(),
        is_estimate: false,
    };
    laws.map(one).collect()
}

/// Whether roll was recorded throughout where a law has it.
fn is_measured(law: &Law, trials: &[&Trial]) -> bool {
    !law.has_roll() || trials.iter().all(|trial| trial.channel(Channel::Phi).is_some())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_estimate_enters_beside_a_source_of_another_ship() {
        let zoo = Zoo::embedded().unwrap();
        let target = zoo.vessel("kcs").unwrap();
        let models = ["kcs", "mariner"].map(|name| zoo.model(name).unwrap());
        let estimates = |sources: &[Model], asked| {
            let all = entrants(&zoo, target, (sources, asked), &[]);
            all.into_iter().filter(|one| one.is_estimate).collect::<Vec<_>>()
        };
        assert!(estimates(&models, false).is_empty() && estimates(&models[..1], true).is_empty());
        let found = estimates(&models, true);
        assert!(!found.is_empty() && found.iter().all(|one| one.source.ship == "mariner"));
        assert!(found[0].name().starts_with("estimate, "), "{}", found[0].name());
        let settings = found[0].settings(&Settings::default());
        assert_eq!((settings.prior, settings.mixture_positions), (Prior::Mixture, vec![1.0]));
    }
}
