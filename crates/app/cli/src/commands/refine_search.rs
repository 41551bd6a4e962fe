//! Model selection of a refinement without source, law and method.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use sistership_identification::refine::{Refinement, RefinementSettings};
use sistership_model::{Law, Model, Vessel, Zoo};
use sistership_model_selection::{Preference, SelectionReport, StartRequest, best_start};
use sistership_priors::source::SimilarityRanking;

use crate::failure::Failure;
use crate::output::print_note;
use crate::trials::{self, ReadTrial};

/// Interval between notes of progress.
const PROGRESS_INTERVAL: Duration = Duration::from_secs(1);
/// Share of the work before which no remaining time is given: the first stage is not
/// representative.
const MIN_EXTRAPOLATED_SHARE: f64 = 0.1;

/// Start of a refinement, with its selection.
pub struct SelectedStart {
    /// The source; a law without coefficients if there is none.
    pub source: Model,
    /// The law to fit; by default the source's.
    pub law: Option<Arc<Law>>,
    /// Ranking of the ships, if they were compared.
    pub similarity: Option<SimilarityRanking>,
    /// Selection report, if there was a model selection.
    pub ladder: Option<SelectionReport>,
    /// The refinement, if the model selection has made it already.
    pub made: Option<Refinement>,
}

impl SelectedStart {
    /// Creates the start that a person named.
    pub fn from_named(source: Model, law: Option<Arc<Law>>) -> Self {
        Self { source, law, similarity: None, ladder: None, made: None }
    }
}

/// Selects the best start, with settings that name its method; held-out trials do not influence it.
///
/// # Errors
/// Returns an error if no candidate could be simulated to the end.
pub fn select_start(
    zoo: &Zoo,
    target: &Vessel,
    (settings, preference): (&RefinementSettings, Preference),
    read: &[ReadTrial],
) -> Result<(SelectedStart, RefinementSettings), Failure> {
    let trials = trials::trial_refs(read);
    let champions = BTreeMap::new();
    let asked =
        StartRequest { zoo, target, champions: &champions, trials: &trials, settings, preference };
    let (begun, last) = (Instant::now(), Mutex::new(None));
    let told = |fraction: f64, what: &str| {
        // Candidates run in parallel and all report their progress here.
        let mut last = last.lock().unwrap_or_else(PoisonError::into_inner);
        if last.is_none_or(|last: Instant| last.elapsed() >= PROGRESS_INTERVAL) {
            *last = Some(Instant::now());
            let left = time_left(begun.elapsed().as_secs_f64(), fraction);
            print_note(&format!("model selection {:3.0} %{left}: {what}", 100.0 * fraction));
        }
        true
    };
    let found = best_start(&asked, &told).map_err(|error| Failure::Refused(error.to_string()))?;
    let (entrant, method) = (found.entrant, found.settings.method.name());
    let source = entrant.source_name().unwrap_or("none").to_owned();
    print_note(&format!("source: {source}, law: {}, method: {method}", entrant.law.name));
    let start = SelectedStart {
        source: entrant.source,
        law: Some(entrant.law),
        similarity: Some(found.similarity),
        ladder: Some(found.ladder),
        made: Some(found.refinement),
    };
    Ok((start, found.settings))
}

/// Extrapolates the remaining time from the work done so far.
fn time_left(elapsed_s: f64, fraction: f64) -> String {
    if fraction < MIN_EXTRAPOLATED_SHARE {
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
