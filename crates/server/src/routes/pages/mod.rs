//! Pages for people: what there is, at a glance. They stand alone: no script, nothing from
//! elsewhere.

mod answer;
mod family;
mod index;
mod rows;
mod ship;

pub(super) use answer::POLICY;
use axum::Router;
use axum::routing::get;

use crate::app::App;

pub(super) fn routes() -> Router<App> {
    Router::new()
        .route("/", get(index::page))
        .route("/ships/{ship}", get(ship::page))
        .route("/families/{family}", get(family::page))
}
