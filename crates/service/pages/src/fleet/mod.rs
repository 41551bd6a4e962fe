//! The fleet: a list of the ships, the one that most needs attention first.

mod class_label;
mod drift_trend;
mod first_steps;
mod map;
mod query;
mod recent;

use askama::Template;
use sistership_jobs::Archive;
use sistership_jobs::condition::{Condition, diagnosed_trials};
use sistership_jobs::search::urgency::{
    ERROR_FACT, FLEET_FACT, RESIDUAL_FACT_PREFIX, ShipCollection, UrgencyClass,
};
use sistership_jobs::search::{self, SearchCriteria, VectorCache};
use sistership_store::{FactRange, FoundShip, ListPage, PageRequest, ShipKey, ShipOverview};

pub(crate) use self::class_label::class_label;
use self::drift_trend::drift_trend;
use self::first_steps::FirstSteps;
use self::map::FleetMap;
use self::query::{FleetQuery, SortOrder};
use self::recent::{RecentShip, recent_ships};
use crate::cursor::encode_cursor;
use crate::error::Result;
use crate::form::FormFields;
use crate::language::say;
use crate::numbers::{format_significant, format_stated};
use crate::picture::render_svg;
use crate::shell::PageShell;
use crate::sparkline::sparkline;

/// Number of ships on one page.
const SHIPS_PER_PAGE: i64 = 50;
/// Number of ships that are named as the worst.
const WORST_SHIPS: usize = 5;
/// Number of families named in a row.
const FAMILIES_PER_ROW: usize = 4;

#[derive(Template)]
#[template(path = "fleet.html")]
struct FleetPage {
    shell: PageShell,
    query: FleetQuery,
    particulars: Vec<&'static str>,
    metrics: Vec<&'static str>,
    value: Option<String>,
    ships: Vec<ShipRow>,
    next: Option<String>,
    changing: bool,
    first_steps: Option<FirstSteps>,
    dashboard: Option<FleetDashboard>,
}

/// Overview of the fleet above the list of its ships.
struct FleetDashboard {
    counts: Vec<ConditionCount>,
    /// Ships that most need attention, of a fleet that is longer than a screen.
    worst: Vec<WorstShip>,
    recent: Vec<RecentShip>,
    /// Chart of the drift over the last weeks, SVG.
    drift: Option<String>,
    map: Option<FleetMap>,
}

/// Ship that needs attention, and why.
struct WorstShip {
    name: String,
    why: String,
}

/// Number of ships of the fleet in a condition.
struct ConditionCount {
    class: UrgencyClass,
    ships: i64,
}

struct ShipRow {
    name: String,
    title: String,
    category: String,
    class: &'static str,
    says: String,
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
pub async fn fleet_page(
    archive: &Archive,
    known: &VectorCache,
    shell: PageShell,
    fields: &FormFields,
) -> Result<String> {
    let query = FleetQuery::from_fields(fields)?;
    let found = find_ships(archive, known, &query, query.to_search()?).await?;
    let next = encode_cursor(found.next.as_ref()).map(|next| query.next_address(&next));
    // Read for all rows together: a few statements instead of several for each ship.
    let names: Vec<String> = found.items.iter().map(|ship| ship.name.clone()).collect();
    let mut standings =
        archive.store.ship_overviews(&names, ERROR_FACT, RESIDUAL_FACT_PREFIX).await?;
    let diagnosed = standings.values().flat_map(|standing| diagnosed_trials(&standing.diagnoses));
    let deleted = archive.store.deleted_trials(&diagnosed.collect::<Vec<_>>()).await?;
    let row = |ship: FoundShip| {
        let standing = standings.remove(&ship.name).unwrap_or_default();
        ship_row(ship, standing, &deleted, query.sort)
    };
    let ships: Vec<ShipRow> = found.items.into_iter().map(row).collect::<Result<_>>()?;
    let is_overview = query.collection == Some(ShipCollection::Fleet)
        && !query.has_filter()
        && !query.is_continued();
    let names: Vec<&str> = ships.iter().map(|ship| ship.name.as_str()).collect();
    let page = FleetPage {
        first_steps: match is_overview {
            true => FirstSteps::find(archive, &names).await?,
            false => None,
        },
        dashboard: match is_overview && !ships.is_empty() {
            true => Some(FleetDashboard::read(archive, &ships).await?),
            false => None,
        },
        shell: shell.at_place("/"),
        particulars: search::particular_names().collect(),
        metrics: search::searchable_metrics().collect(),
        value: query.value_name(),
        query,
        ships,
        next,
        changing: !archive.store.search_index().list_stale("", 1).await?.is_empty(),
    };
    Ok(page.render()?)
}

impl FleetDashboard {
    async fn read(archive: &Archive, ships: &[ShipRow]) -> Result<Self> {
        let failing = ships.iter().filter(|ship| ship.class == UrgencyClass::DoesNotHold.name());
        let worst = failing.take(WORST_SHIPS).map(WorstShip::from_row).collect();
        Ok(Self {
            counts: count_conditions(archive).await?,
            // A short list has its worst ships in sight.
            worst: if ships.len() > WORST_SHIPS { worst } else { Vec::new() },
            recent: recent_ships(archive).await?,
            drift: drift_trend(archive).await?.as_ref().map(render_svg).transpose()?,
            map: FleetMap::read(archive).await?,
        })
    }
}

impl WorstShip {
    fn from_row(row: &ShipRow) -> Self {
        let why = match row.why.as_str() {
            "" => say("board-unexplained").into(),
            why => why.to_owned(),
        };
        Self { name: row.name.clone(), why }
    }
}

/// Counts the ships of the fleet by condition, most urgent first.
async fn count_conditions(archive: &Archive) -> Result<Vec<ConditionCount>> {
    let mut counts = Vec::new();
    for class in UrgencyClass::ALL {
        let range = FactRange { fact: FLEET_FACT.to_owned(), ..class.class_range() };
        let ships = archive.store.ships().count_ships(&range).await?;
        counts.push(ConditionCount { class, ships });
    }
    Ok(counts)
}

async fn find_ships(
    archive: &Archive,
    known: &VectorCache,
    query: &FleetQuery,
    search: SearchCriteria,
) -> Result<ListPage<FoundShip, ShipKey>> {
    let page = PageRequest { after: query.start_key()?, limit: SHIPS_PER_PAGE };
    Ok(search::search_ships(archive, known, &search, &page).await?)
}

fn ship_row(
    ship: FoundShip,
    standing: ShipOverview,
    deleted: &[String],
    sort: SortOrder,
) -> Result<ShipRow> {
    let ShipOverview { champion, diagnoses, fact, series, families } = standing;
    let weighed = |champion| Condition::from_diagnoses(&champion, &diagnoses, deleted);
    let condition = champion.map(weighed).unwrap_or_default();
    let class = UrgencyClass::from_condition(&condition);
    // A value is shown only if it sorts the ships.
    let value = ship.value.filter(|_| matches!(sort, SortOrder::Value | SortOrder::Similar));
    // Sparklines of the list mark no trials.
    let trend = sparkline(series.into_iter().map(|left| (left, false)));
    Ok(ShipRow {
        name: ship.name,
        title: ship.title,
        category: ship.category,
        class: class.name(),
        says: class_label(class),
        why: condition_reason(&condition),
        champion: condition.version,
        error: fact.map_or_else(String::new, |error| format_significant(error, 2)),
        trend: trend.as_ref().map(render_svg).transpose()?,
        families: families.into_iter().take(FAMILIES_PER_ROW).collect(),
        value: value.map_or_else(String::new, |value| format_stated(value, 4)),
    })
}

/// Returns the effects that a champion lacks, or that it has drifted.
fn condition_reason(condition: &Condition) -> String {
    match condition.verdict.as_deref() {
        Some("drift") => match &condition.drift {
            Some(drift) => say("condition-drift-times")
                .with("ratio", format_significant(drift.ratio, 2))
                .into(),
            None => say("condition-drift").into(),
        },
        _ => condition.effects.join(", "),
    }
}
