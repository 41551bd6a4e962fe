//! `sistership similar`: the zoo ranked by likeness to a ship.

use std::path::PathBuf;

use clap::Args;
use sistership_model::{Vessel, Zoo};
use sistership_priors::similarity::{Definition, RankedSource};
use sistership_priors::source::{Similarity, similar};

use crate::failure::{Failure, both};
use crate::table::{TextTable, number};
use crate::values::definition;
use crate::{named, output, trials};

const EXAMPLES: &str = "\
Examples:
  sistership similar kvlcc2
  sistership similar my-ship.yaml --vector kanazawa-2023 --json
  sistership similar esso-osaka-3m --trials zigzags.yaml";

/// Rank the ships of the zoo by similarity to a ship, and say which may be the source of a
/// refinement.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct SimilarArguments {
    /// The ship: a name in the zoo or a vessel file.
    ship: String,
    /// Definition of the characteristic vector; by default mei-2019 if the ship has all of its
    /// components.
    #[arg(long, value_name = "NAME", value_parser = definition)]
    vector: Option<Definition>,
    /// Trials of the ship, with which source models are compared as well.
    #[arg(long, value_name = "TRIALS", num_args = 1..)]
    trials: Vec<PathBuf>,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// The ship or a trial is refused.
pub fn run(zoo: &Zoo, similar_to: &SimilarArguments) -> Result<(), Failure> {
    let asked = both(named::ship(zoo, &similar_to.ship), trials::read(&similar_to.trials));
    let (target, read) = asked?;
    trials::remark_other_ship(&read, target.name());
    let similarity = similar(zoo, &target, similar_to.vector, &trials::trials(&read));
    output::print(similar_to.json, &similarity, || text(&target, &similarity))
}

fn text(target: &Vessel, similarity: &Similarity) -> String {
    let vector: Vec<String> = similarity
        .vector
        .iter()
        .map(|(name, value)| format!("{name} {}", number(*value)))
        .collect();
    let Vessel { file, .. } = target;
    let head = format!("{} ({}), category {}\n", file.name, file.title, file.category);
    let vector = format!(
        "characteristic vector {}: {}\n\n",
        similarity.definition.name(),
        vector.join(", ")
    );
    format!("{head}{vector}{}", ranking(&similarity.ranking))
}

/// The ranking as a table; each step of eligibility has a line of its own.
pub fn ranking(ranking: &[RankedSource]) -> TextTable {
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
        for reason in &ranked.reasons {
            table.row(std::mem::take(&mut cells).into_iter().chain([reason.clone()]));
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
        let zoo = Zoo::embedded().unwrap();
        let target = zoo.vessel("kvlcc2").unwrap();
        let text = text(target, &similar(&zoo, target, None, &[]));
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
