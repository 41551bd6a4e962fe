//! The fleet: a list of the ships, the one that most needs attention first.

mod query;

use askama::Template;
use sistership_jobs::Archive;
use sistership_jobs::condition::{Condition, trials_of};
use sistership_jobs::search::standing::{Class, ERROR, LEFT};
use sistership_jobs::search::{self, KnownVectors, Search};
use sistership_report::numbers::{significant, stated};
use sistership_store::{FoundShip, List, Page, ShipKey, ShipStanding};

use self::query::{FleetQuery, Sort};
use crate::cursor::cursor;
use crate::error::Result;
use crate::form::Fields;
use crate::picture::svg;
use crate::shell::Shell;
use crate::sparkline::sparkline;

/// Number of ships on one page.
const SHIPS: i64 = 50;
/// Number of families named in a row.
const FAMILIES: usize = 4;

#[derive(Template)]
#[template(path = "fleet.html")]
struct FleetPage {
    shell: Shell,
    query: FleetQuery,
    particulars: Vec<&'static str>,
    metrics: Vec<&'static str>,
    value: Option<String>,
    ships: Vec<ShipRow>,
    next: Option<String>,
    changing: bool,
}

struct ShipRow {
    name: String,
    title: String,
    category: String,
    class: &'static str,
    says: &'static str,
    why: String,
    champion: Option<i64>,
    error: String,
    trend: Option<String>,
    families: Vec<String>,
    value: String,
}

/// Returns the ships that a query finds.
///
/// # Errors
/// Returns an error if a field of the query is wrong or the store fails.
pub async fn page(
    archive: &Archive,
    known: &KnownVectors,
    shell: Shell,
    fields: &Fields,
) -> Result<String> {
    let query = FleetQuery::read(fields)?;
    let found = found(archive, known, &query, query.search()?).await?;
    let next = cursor(found.next.as_ref()).map(|next| query.address(&next));
    // Read for all rows together: a few statements instead of several for each ship.
    let names: Vec<String> = found.items.iter().map(|ship| ship.name.clone()).collect();
    let mut standings = archive.store.standings(&names, ERROR, LEFT).await?;
    let diagnosed = standings.values().flat_map(|standing| trials_of(&standing.diagnoses));
    let deleted = archive.store.deleted_trials(&diagnosed.collect::<Vec<_>>()).await?;
    let row = |ship: FoundShip| {
        let standing = standings.remove(&ship.name).unwrap_or_default();
        row(ship, standing, &deleted, query.sort)
    };
    let ships = found.items.into_iter().map(row).collect::<Result<_>>()?;
    let page = FleetPage {
        shell: shell.at("/"),
        particulars: search::particulars().collect(),
        metrics: search::metrics().collect(),
        value: query.value_name(),
        query,
        ships,
        next,
        changing: !archive.store.search_index().waiting("", 1).await?.is_empty(),
    };
    Ok(page.render()?)
}

async fn found(
    archive: &Archive,
    known: &KnownVectors,
    query: &FleetQuery,
    search: Search,
) -> Result<List<FoundShip, ShipKey>> {
    let page = Page { after: query.after()?, limit: SHIPS };
    Ok(search::ships(archive, known, &search, &page).await?)
}

fn row(ship: FoundShip, standing: ShipStanding, deleted: &[String], sort: Sort) -> Result<ShipRow> {
    let ShipStanding { champion, diagnoses, fact, series, families } = standing;
    let weighed = |champion| Condition::weighed(&champion, &diagnoses, deleted);
    let condition = champion.map(weighed).unwrap_or_default();
    let class = Class::of(&condition);
    // A value is shown only if it sorts the ships.
    let value = ship.value.filter(|_| matches!(sort, Sort::Value | Sort::Similar));
    // Sparklines of the list mark no trials.
    let trend = sparkline(series.into_iter().map(|left| (left, false)));
    Ok(ShipRow {
        name: ship.name,
        title: ship.title,
        category: ship.category,
        class: class.name(),
        says: says(class),
        why: why(&condition),
        champion: condition.version,
        error: fact.map_or_else(String::new, |error| significant(error, 2)),
        trend: trend.as_ref().map(svg).transpose()?,
        families: families.into_iter().take(FAMILIES).collect(),
        value: value.map_or_else(String::new, |value| stated(value, 4)),
    })
}

/// Returns the effects that a champion lacks, or that it has drifted.
fn why(condition: &Condition) -> String {
    match condition.verdict.as_deref() {
        Some("drift") => "drift".to_owned(),
        _ => condition.effects.join(", "),
    }
}

/// Returns a class of condition in words.
pub(crate) fn says(class: Class) -> &'static str {
    match class {
        Class::DoesNotHold => "does not hold",
        Class::Unknown => "cannot tell",
        Class::NoModel => "no model",
        Class::Holds => "holds",
    }
}
