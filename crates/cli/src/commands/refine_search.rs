//! The source, law and method of a refinement that names none of them.

use std::sync::Arc;

use sistership_estimate::auto::{Ladder, Search, entrants, search};
use sistership_estimate::refine::Settings;
use sistership_estimate::source::{Similarity, eligible_sources, similar};
use sistership_model::trial::Trial;
use sistership_model::{Law, Model, Vessel, Zoo};

use crate::failure::Failure;
use crate::output::note;
use crate::trials::{self, ReadTrial};

/// Most sources that enter, by rank of correlation.
const SOURCES: usize = 5;

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
}

impl Start {
    /// As a person named it.
    pub fn of(source: Model, law: Option<Arc<Law>>) -> Self {
        Self { source, law, similarity: None, ladder: None }
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
    let all = trials::trials(read).into_iter();
    let fitted: Vec<&Trial> =
        all.filter(|trial| !settings.held_out.contains(&trial.name)).collect();
    let similarity = similar(zoo, target, None, &fitted);
    let sources = eligible_sources(zoo, &similarity, SOURCES).map_err(Failure::Refused)?;
    let entrants = entrants(zoo, target, &sources, &fitted);
    let open = Settings { held_out: Vec::new(), ..settings.clone() };
    let asked = Search { target, entrants: &entrants, trials: &fitted, settings: &open };
    let told = |fraction: f64, what: &str| {
        note(&format!("search {:3.0} % {what}", 100.0 * fraction));
        true
    };
    let winner = search(&asked, &told).map_err(|error| Failure::Refused(error.to_string()))?;
    let entrant = &entrants[winner.entrant];
    note(&format!(
        "source: {}, law: {}",
        entrant.source_name().unwrap_or("none"),
        entrant.law.name
    ));
    let start = Start {
        source: entrant.source.clone(),
        law: Some(entrant.law.clone()),
        similarity: Some(similarity),
        ladder: Some(winner.ladder),
    };
    Ok((start, Settings { held_out: settings.held_out.clone(), ..winner.settings }))
}
