//! What enters the search: sources with the laws that can be fitted to what was measured.

use std::sync::Arc;

use sistership_model::trial::{Channel, Trial};
use sistership_model::{Law, Model, Vessel, Zoo};

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
}

impl Entrant {
    /// What it is, for people.
    pub fn name(&self) -> String {
        let source = self.source_name().unwrap_or("no source");
        format!("{source}, {}", self.law.name)
    }

    /// The source's name; none where the trials alone make the model.
    pub fn source_name(&self) -> Option<&str> {
        self.source_law.as_ref().map(|_| self.source.name.as_str())
    }
}

/// Each source with its own law and the general ones, and each general law without a source.
pub fn entrants(zoo: &Zoo, target: &Vessel, sources: &[Model], trials: &[&Trial]) -> Vec<Entrant> {
    let general: Vec<Arc<Law>> = GENERAL
        .iter()
        .filter_map(|name| zoo.law(name).cloned())
        .filter(|law| is_measured(law, trials))
        .collect();
    let with_source = sources.iter().flat_map(|source| of_source(zoo, source, &general, trials));
    let approach = approach_of(trials);
    let alone = general.iter().filter_map(|law| {
        let source = blank(law, target, approach).ok()?;
        Some(Entrant { source, source_law: None, law: law.clone() })
    });
    with_source.chain(alone).collect()
}

fn of_source(zoo: &Zoo, source: &Model, general: &[Arc<Law>], trials: &[&Trial]) -> Vec<Entrant> {
    let Some(own) = zoo.law(&source.law) else { return Vec::new() };
    let others = general.iter().filter(|law| law.name != own.name);
    let laws = std::iter::once(own).filter(|law| is_measured(law, trials)).chain(others);
    let one = |law: &Arc<Law>| Entrant {
        source: source.clone(),
        source_law: Some(own.clone()),
        law: law.clone(),
    };
    laws.map(one).collect()
}

/// Whether roll was recorded throughout where a law has it.
fn is_measured(law: &Law, trials: &[&Trial]) -> bool {
    !law.has_roll() || trials.iter().all(|trial| trial.channel(Channel::Phi).is_some())
}
