//! The form of a new ship.

use axum::extract::State;
use axum::response::Response;
use sistership_model::Vessel;
use sistership_model::vessel::VesselFile;
use sistership_pages::new_ship;

use super::super::ship_changes::store_ship;
use super::answer::{page_response, redirect_to};
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::form::{PageForm, page_shell};

pub(super) async fn new_ship_form(State(app): State<App>) -> Result<Response> {
    Ok(page_response(new_ship::new_ship_page(&page_shell(&app))?))
}

pub(super) async fn create_ship(
    State(app): State<App>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let document = new_ship::vessel_document(&form)?;
    let file: VesselFile = serde_json::from_value(document)
        .map_err(|error| Problem::invalid("form", error.to_string()))?;
    let vessel = Vessel::from_file("form", file)?;
    Ok(redirect_to(&format!("/ships/{}", store_ship(&app, &vessel).await?.name)))
}
