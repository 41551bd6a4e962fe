//! The form of a new ship.

use axum::extract::State;
use axum::response::Response;
use sistership_model::Vessel;
use sistership_model::vessel::VesselFile;
use sistership_pages::new_ship;

use super::super::ship_changes::kept;
use super::answer::{answer, then};
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::form::{PageForm, shell};

pub(super) async fn form(State(app): State<App>) -> Result<Response> {
    Ok(answer(new_ship::page(&shell(&app))?))
}

pub(super) async fn create(State(app): State<App>, PageForm(form): PageForm) -> Result<Response> {
    let document = new_ship::document(&form)?;
    let file: VesselFile = serde_json::from_value(document)
        .map_err(|error| Problem::invalid("form", error.to_string()))?;
    let vessel = Vessel::from_file("form", file)?;
    Ok(then(&format!("/ships/{}", kept(&app, &vessel).await?.name)))
}
