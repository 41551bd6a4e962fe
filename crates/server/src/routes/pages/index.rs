//! The front page.

use askama::Template;
use axum::extract::State;
use axum::response::Response;
use serde::Deserialize;
use sistership_store::{FoundShip, JobFilter, Page, ShipSearch};

use super::answer::answer;
use super::rows::JobRow;
use crate::app::App;
use crate::problem::Result;
use crate::web::field::Cursor;
use crate::web::{Params, page};
use sistership_pipeline::line::{CHAMPION, alias};

/// Ships on one page.
const SHIPS: i64 = 100;
/// Jobs on the page.
const JOBS: i64 = 20;
/// Trials that are counted.
const COUNTED: i64 = 1000;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Query {
    after: Option<Cursor>,
}

#[derive(Template)]
#[template(path = "index.html")]
struct Index {
    ships: Vec<ShipRow>,
    next: Option<String>,
    laws: Vec<String>,
    jobs: Vec<JobRow>,
}

struct ShipRow {
    name: String,
    title: String,
    category: String,
    champion: Option<Champion>,
    trials: String,
}

struct Champion {
    number: i64,
    law: String,
    method: String,
}

pub(super) async fn page(State(app): State<App>, Params(query): Params<Query>) -> Result<Response> {
    let page = Page { limit: SHIPS, ..page::page(None, query.after.as_ref())? };
    let ships = app.store().ships().search(&ShipSearch::default(), &page).await?;
    let mut rows = Vec::with_capacity(ships.items.len());
    for ship in ships.items {
        rows.push(row(&app, ship).await?);
    }
    let laws = app
        .store()
        .laws()
        .list(&Page::first(SHIPS))
        .await?
        .items
        .into_iter()
        .map(|law| law.name)
        .collect();
    let jobs = app.store().jobs().list(&JobFilter::default(), &Page::first(JOBS)).await?;
    answer(&Index {
        ships: rows,
        next: ships.next.as_ref().and_then(page::cursor),
        laws,
        jobs: jobs.items.into_iter().map(JobRow::of).collect(),
    })
}

async fn row(app: &App, ship: FoundShip) -> Result<ShipRow> {
    let champion = match alias(app.store(), &ship.name, CHAMPION).await? {
        Some(alias) => Some(champion(app, &ship.name, alias.version_number).await?),
        None => None,
    };
    let trials = app.store().trials().list(&ship.name, &Page::first(COUNTED)).await?;
    let count = trials.items.len();
    let trials =
        if trials.next.is_some() { format!("more than {count}") } else { count.to_string() };
    Ok(ShipRow { name: ship.name, title: ship.title, category: ship.category, champion, trials })
}

async fn champion(app: &App, ship: &str, number: i64) -> Result<Champion> {
    let head = app.store().versions().get(ship, number).await?.head;
    Ok(Champion { number, law: head.law, method: head.method })
}
