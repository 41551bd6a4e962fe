//! The source, law and method of a refinement that names none of them.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use sistership_identification::refine::{Refinement, Settings};
use sistership_model::{Law, Model, Vessel, Zoo};
use sistership_model_selection::{Asked, Ladder, best_start};
use sistership_priors::source::Similarity;

use crate::failure::Failure;
use crate::output::note;
use crate::trials::{self, ReadTrial};

/// From one note of progress to the next.
const BETWEEN: Duration = Duration::from_secs(1);
/// Share of the work before which the time left is not told: the first rung is not like the others.
const TELLING: f64 = 0.1;

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
    let (begun, last) = (Instant::now(), Mutex::new(None));
    let told = |fraction: f64, what: &str| {
        let mut last = last.lock().unwrap_or_else(PoisonError::into_inner);
        if last.is_none_or(|last: Instant| last.elapsed() >= BETWEEN) {
            *last = Some(Instant::now());
            let left = time_left(begun.elapsed().as_secs_f64(), fraction);
            note(&format!("search {:3.0} %{left}: {what}", 100.0 * fraction));
        }
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
        made: Some(found.refinement),
    };
    Ok((start, found.settings))
}

/// How long it will take, as far as what is done tells.
fn time_left(elapsed_s: f64, fraction: f64) -> String {
    if fraction < TELLING {
        return String::new();
    }
    let left_s = elapsed_s * (1.0 - fraction) / fraction;
    format!(", about {:.0} s left", left_s.ceil())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_left_is_told_once_there_is_something_to_tell_it_by() {
        assert_eq!(time_left(1.0, 0.05), "");
        assert_eq!(time_left(3.0, 0.25), ", about 9 s left");
    }
}
