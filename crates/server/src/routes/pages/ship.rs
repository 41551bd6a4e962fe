//! The page of a ship.

use askama::Template;
use axum::extract::State;
use axum::response::Response;
use sistership_store::{Alias, JobFilter, Page, VersionHead};

use super::answer::answer;
use super::rows::{JobRow, TrialRow, date};
use crate::app::App;
use crate::problem::Result;
use crate::web::Place;
use sistership_pipeline::archive::vessel;
use sistership_pipeline::condition::Condition;

/// Lines of each list.
const LINES: i64 = 100;

#[derive(Template)]
#[template(path = "ship.html")]
struct ShipPage {
    name: String,
    title: String,
    category: String,
    revision: i64,
    condition: Condition,
    since: Option<String>,
    particulars: Vec<(String, String)>,
    versions: Vec<VersionRow>,
    trials: Vec<TrialRow>,
    jobs: Vec<JobRow>,
}

struct VersionRow {
    number: i64,
    aliases: String,
    law: String,
    method: String,
    sha256: String,
    created: String,
    report: Option<String>,
}

pub(super) async fn page(State(app): State<App>, Place(name): Place<String>) -> Result<Response> {
    let ship = app.store().ships().get(&name).await?;
    let aliases = app.store().aliases().list(&name, &Page::first(LINES)).await?.items;
    let mut versions = Vec::new();
    for head in app.store().versions().list(&name, &Page::first(LINES)).await?.items {
        versions.push(row(&app, head, &aliases).await?);
    }
    let trials = app.store().trials().list(&name, &Page::first(LINES)).await?;
    let jobs = app
        .store()
        .jobs()
        .list(&JobFilter { ship: Some(name.clone()), state: None }, &Page::first(LINES))
        .await?;
    let condition = Condition::of(app.store(), &name).await?;
    let particulars = vessel(&ship.name, &ship.document)?.particulars;
    answer(&ShipPage {
        name,
        title: ship.title,
        category: ship.category,
        revision: ship.revision,
        since: condition.since.as_ref().map(|since| date(since.at_us)),
        condition,
        particulars: particulars
            .into_iter()
            .map(|(name, quantity)| (name, quantity.value.to_string()))
            .collect(),
        versions,
        trials: trials.items.into_iter().map(TrialRow::of).collect(),
        jobs: jobs.items.into_iter().map(JobRow::of).collect(),
    })
}

async fn row(app: &App, head: VersionHead, aliases: &[Alias]) -> Result<VersionRow> {
    let report =
        app.store().reports().by_version(&head.id, &Page::first(1)).await?.items.into_iter().next();
    let names: Vec<&str> = aliases
        .iter()
        .filter(|alias| alias.version_number == head.number)
        .map(|alias| alias.alias.as_str())
        .collect();
    let VersionHead { number, law, method, sha256, created_us, .. } = head;
    let report = report.map(|report| report.id);
    Ok(VersionRow {
        number,
        aliases: names.join(", "),
        law,
        method,
        sha256,
        created: date(created_us),
        report,
    })
}
