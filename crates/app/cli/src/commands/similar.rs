//! `sistership similar`: ranking of the ships of the zoo or of a store by similarity to a ship.

use std::path::PathBuf;

use clap::Args;
use sistership_jobs::Archive;
use sistership_jobs::archive::parse_vessel;
use sistership_jobs::catalogue::{MAX_COMPARED_SHIPS, ZooCache};
use sistership_jobs::champions::SourceModels;
use sistership_model::{Vessel, Zoo};
use sistership_priors::similarity::{RankedSource, VectorDefinition};
use sistership_priors::source::{SimilarityRanking, rank_similar};
use sistership_store::StoreError;

use super::store::{StoreArguments, with_archive};
use crate::failure::{Failure, combine_results};
use crate::table::{TextTable, format_number};
use crate::values::definition;
use crate::{output, resolve, trials};

const EXAMPLES: &str = "\
Examples:
  sistership similar kvlcc2
  sistership similar my-ship.yaml --vector kanazawa-2023 --json
  sistership similar esso-osaka-3m --trials zigzags.yaml
  sistership similar my-ship --data-dir sistership-data

With a store, its ships are ranked instead of those of the zoo; the source model of a ship is its
champion, if that is eligible.";

/// Rank the ships of the zoo or of a store by similarity to a ship, and say which may be the source
/// of a refinement.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct SimilarArguments {
    /// The ship: a name in the zoo or the store, or a vessel file.
    ship: String,
    /// Definition of the characteristic vector; by default mei-2019 if the ship has all of its
    /// components.
    #[arg(long, value_name = "NAME", value_parser = definition)]
    vector: Option<VectorDefinition>,
    /// Trials of the ship, with which source models are compared as well.
    #[arg(long, value_name = "TRIALS", num_args = 1..)]
    trials: Vec<PathBuf>,
    #[command(flatten)]
    store: StoreArguments,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the ship or a trial is refused.
pub fn run(zoo: &Zoo, similar_to: &SimilarArguments) -> Result<(), Failure> {
    if similar_to.store.is_named() {
        return rank_store(zoo, similar_to);
    }
    let asked = combine_results(
        resolve::resolve_ship(zoo, &similar_to.ship),
        trials::read_trials(&similar_to.trials),
    );
    let (target, read) = asked?;
    trials::remark_other_ship(&read, target.name());
    let similarity = rank_similar(zoo, &target, similar_to.vector, &trials::trial_refs(&read));
    output::print_result(similar_to.json, &similarity, || format_similarity(&target, &similarity))
}

/// Ranks the ships of a store.
fn rank_store(zoo: &Zoo, similar_to: &SimilarArguments) -> Result<(), Failure> {
    let read = trials::read_trials(&similar_to.trials)?;
    let fitted = trials::trial_refs(&read);
    let (target, similarity) = with_archive(&similar_to.store, async |archive| {
        let target = stored_ship(zoo, archive, &similar_to.ship).await?;
        // A limited number of ships: a store may have thousands.
        let near = ZooCache::default()
            .zoo_for_target(archive, &target, MAX_COMPARED_SHIPS)
            .await
            .map_err(error_text)?;
        let models = SourceModels::for_zoo(archive, &near).await.map_err(error_text)?;
        let similarity = models.rank_sources(&near, &target, similar_to.vector, &fitted);
        Ok::<_, String>((target, similarity))
    })?;
    trials::remark_other_ship(&read, target.name());
    output::print_result(similar_to.json, &similarity, || format_similarity(&target, &similarity))
}

/// Returns the ship of a store, else of the zoo or a file.
async fn stored_ship(zoo: &Zoo, archive: &Archive, name: &str) -> Result<Vessel, String> {
    match archive.store.ships().get(name).await {
        Ok(ship) => parse_vessel(&ship.name, &ship.document).map_err(error_text),
        // A ship that is not in the store may be compared with those that are.
        Err(StoreError::NotFound { .. }) => resolve::resolve_ship(zoo, name)
            .map(|vessel| Vessel::clone(&vessel))
            .map_err(|failure| failure.message().unwrap_or_default().to_owned()),
        Err(error) => Err(error_text(error)),
    }
}

fn error_text(error: impl std::fmt::Display) -> String {
    error.to_string()
}

fn format_similarity(target: &Vessel, similarity: &SimilarityRanking) -> String {
    let vector: Vec<String> = similarity
        .vector
        .iter()
        .map(|(name, value)| format!("{name} {}", format_number(*value)))
        .collect();
    let Vessel { file, .. } = target;
    let head = format!("{} ({}), category {}\n", file.name, file.title, file.category);
    let vector = format!(
        "characteristic vector {}: {}\n\n",
        similarity.definition.name(),
        vector.join(", ")
    );
    format!("{head}{vector}{}", ranking_table(&similarity.ranking))
}

/// Formats the ranking as a table; each reason of eligibility has its own line.
pub fn ranking_table(ranking: &[RankedSource]) -> TextTable {
    let mut table = TextTable::new(["ship", "model", "correlation", "eligible", "why"]);
    for ranked in ranking {
        let correlation =
            ranked.correlation.map_or_else(|| "-".to_owned(), |value| format!("{value:.3}"));
        let model = ranked
            .model
            .as_deref()
            .map_or("-", |model| model.split_once('/').map_or(model, |(_, name)| name));
        let eligible = if ranked.eligible { "yes" } else { "no" };
        let mut cells = [ranked.ship.as_str(), model, &correlation, eligible].map(str::to_owned);
        // `take` leaves empty cells: only the first line of a ship names it.
        for reason in &ranked.reasons {
            table.add_row(std::mem::take(&mut cells).into_iter().chain([reason.clone()]));
        }
    }
    table
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_published_correlations_are_printed() {
        let zoo = Zoo::load_embedded().unwrap();
        let target = zoo.vessel("kvlcc2").unwrap();
        let text = format_similarity(target, &rank_similar(&zoo, target, None, &[]));
        for figures in [
            ["mariner", "-0.576"],
            ["esso-tanker", "0.851"],
            ["sr108", "-0.887"],
            ["pcc", "-0.723"],
        ] {
            assert!(
                text.lines().any(|line| figures.iter().all(|part| line.contains(part))),
                "{figures:?} in\n{text}"
            );
        }
    }
}
