//! `sistership ships`: search for ships of a store.

use clap::Args;
use serde_json::{Value, json};
use sistership_jobs::Archive;
use sistership_jobs::search::{
    self, FactRange, FoundShip, MAX_RANGES, PageRequest, SearchCriteria, ShipSearch, VectorCache,
};
use sistership_priors::similarity::VectorDefinition;

use super::store::{StoreArguments, with_archive};
use crate::failure::Failure;
use crate::output;
use crate::table::{TextTable, format_number};
use crate::values::definition;

const EXAMPLES: &str = "\
Examples:
  sistership ships --category tanker --tag own-fleet
  sistership ships --particular lpp_m:100..200 --metric turn_35.tactical_diameter_m:..900
  sistership ships --similar-to kvlcc2 --limit 10 --json

Ships are listed by name; with ranges, by the value of the first range (particulars before metrics);
with --similar-to, the most similar first. Values are SI; metrics are those of the champion's
standard manoeuvres, the greater of both sides.";

/// Find ships of a store.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct ShipsArguments {
    #[command(flatten)]
    store: StoreArguments,
    /// Only ships of this category.
    #[arg(long, value_name = "NAME")]
    category: Option<String>,
    /// Only ships with this tag.
    #[arg(long, value_name = "TAG")]
    tag: Option<String>,
    /// Range of a particular; either end may be omitted; repeatable.
    #[arg(long, value_name = "NAME:MIN..MAX", value_parser = search::particular)]
    particular: Vec<FactRange>,
    /// Range of a metric of the champion; either end may be omitted; repeatable.
    #[arg(long, value_name = "NAME:MIN..MAX", value_parser = search::metric)]
    metric: Vec<FactRange>,
    /// Only ships of the category of this ship, the most similar first.
    #[arg(long, value_name = "SHIP")]
    similar_to: Option<String>,
    /// Definition of the characteristic vector; by default mei-2019 if the ship has all of its
    /// components.
    #[arg(long, value_name = "NAME", value_parser = definition, requires = "similar_to")]
    vector: Option<VectorDefinition>,
    /// Largest number of ships to print.
    #[arg(long, value_name = "N", default_value = "100", value_parser = clap::value_parser!(u32).range(1..=1000))]
    limit: u32,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the store does not exist or does not answer, or if the ship of --similar-to
/// is unknown.
pub fn run(ships: &ShipsArguments) -> Result<(), Failure> {
    let ranges: Vec<FactRange> = ships.particular.iter().chain(&ships.metric).cloned().collect();
    if ranges.len() > MAX_RANGES {
        return Err(Failure::Call(format!("at most {MAX_RANGES} ranges can be given at once")));
    }
    let known = ShipSearch { category: ships.category.clone(), tag: ships.tag.clone(), ranges };
    let search =
        SearchCriteria { ships: known, similar_to: ships.similar_to.clone(), vector: ships.vector };
    let found = with_archive(&ships.store, async |archive: &Archive| {
        // Without a server nothing else updates the index.
        search::update_index(archive).await?;
        let page = PageRequest::first_page(i64::from(ships.limit));
        search::search_ships(archive, &VectorCache::default(), &search, &page).await
    })?;
    // No paging on the command line: --limit is raised instead.
    let more = found.next.is_some();
    output::print_result(ships.json, &search_document(&found.items, more), || {
        format_ships(&found.items, more)
    })
}

fn search_document(ships: &[FoundShip], more: bool) -> Value {
    let one = |ship: &FoundShip| {
        let FoundShip { name, title, category, revision, value, .. } = ship;
        json!({ "ship": name, "title": title, "category": category, "revision": revision,
            "value": value })
    };
    json!({ "ships": ships.iter().map(one).collect::<Vec<_>>(), "more": more })
}

fn format_ships(ships: &[FoundShip], more: bool) -> String {
    let mut table = TextTable::new(["ship", "category", "value", "title"]);
    for ship in ships {
        let value = ship.value.map_or_else(|| "-".to_owned(), format_number);
        table.add_row([ship.name.clone(), ship.category.clone(), value, ship.title.clone()]);
    }
    let rest = if more { "more ships match; raise --limit\n" } else { "" };
    format!("{table}{rest}")
}
