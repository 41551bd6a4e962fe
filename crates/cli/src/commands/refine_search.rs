//! The source, law and method of a refinement that names none of them.

use std::collections::BTreeMap;
use std::sync::Arc;

use sistership_choice::{Asked, Ladder, best_start};
use sistership_estimate::refine::{Refinement, Settings};
use sistership_estimate::source::Similarity;
use sistership_model::{Law, Model, Vessel, Zoo};

use crate::failure::Failure;
use crate::output::note;
use crate::trials::{self, ReadTrial};

/// Where a refinement starts, and how that was found.
pub struct Start {
    /// The source; a law without coefficients where there is none.
    pub source: Model,
    /// The law to fit; the source's where absent.
    pub law: Option<Arc<Law>>,
    /// The ranking, where ships were compared.
    pub similarity: Option<Similarity>,
    /// What was tried, where it was searched.
    pub ladder: Option<Ladder>,
    /// The refinement, where the search has made it already.
    pub made: Option<Refinement>,
}

impl Start {
    /// As a person named it.
    pub fn of(source: Model, law: Option<Arc<Law>>) -> Self {
        Self { source, law, similarity: None, ladder: None, made: None }
    }
}

/// The best start, with settings that name its method; trials kept out have no say in it.
///
/// # Errors
/// No entrant could be simulated to its end.
pub fn searched(
    zoo: &Zoo,
    target: &Vessel,
    settings: &Settings,
    read: &[ReadTrial],
) -> Result<(Start, Settings), Failure> {
    let trials = trials::trials(read);
    let champions = BTreeMap::new();
    let asked = Asked { zoo, target, champions: &champions, trials: &trials, settings };
    let told = |fraction: f64, what: &str| {
        note(&format!("search {:3.0} % {what}", 100.0 * fraction));
        true
    };
    let found = best_start(&asked, &told).map_err(|error| Failure::Refused(error.to_string()))?;
    let (entrant, method) = (found.entrant, found.settings.method.name());
    let source = entrant.source_name().unwrap_or("none").to_owned();
    note(&format!("source: {source}, law: {}, method: {method}", entrant.law.name));
    let start = Start {
        source: entrant.source,
        law: Some(entrant.law),
        similarity: Some(found.similarity),
        ladder: Some(found.ladder),
        made: found.refinement,
    };
    Ok((start, found.settings))
}
