//! Commands, one file for each, and their common functions.

pub mod backup;
pub mod branch;
mod branch_document;
mod branch_text;
mod channels;
pub mod check;
pub mod compare;
pub mod completions;
mod config_file;
pub mod derive;
pub mod diagnose;
mod diagnose_text;
pub mod estimate;
pub mod export;
pub mod family;
pub mod fsck;
pub mod gc;
pub mod health;
pub mod import;
mod import_bundle;
mod import_files;
mod import_log;
mod import_outcome;
mod import_template;
mod import_text;
pub mod init;
pub mod keys;
mod log;
mod log_format;
pub mod manoeuvre;
mod manoeuvre_document;
mod manoeuvre_further;
mod manoeuvre_text;
pub mod manual;
pub mod plan;
mod plan_text;
pub mod predict;
mod predict_orders;
mod predict_text;
pub mod refine;
mod refine_branch;
mod refine_search;
mod refine_settings;
pub(crate) mod refine_text;
mod requested_manoeuvres;
mod running;
pub mod serve;
pub mod ships;
pub mod similar;
pub mod simulate;
pub(crate) mod store;
mod traces;
mod trial_simulation;
pub mod users;
pub mod validate;
pub mod verify;
pub mod work;
mod written_files;
pub mod zoo;
mod zoo_text;

use sistership_model::vessel::Status;
use sistership_model::{Law, Model, particulars};
use sistership_simulation::Ship;

use crate::failure::Failure;

/// Binds a model to its law for simulation.
///
/// # Errors
/// Returns an error that names what the model lacks.
fn build_ship(model: &Model, law: &Law) -> Result<Ship, Failure> {
    Ship::new(model, law).map_err(|error| Failure::Refused(error.to_string()))
}

/// Sets the water depth.
///
/// # Errors
/// Returns an error if the law has no water depth, or if the water is too shallow for the ship.
fn set_depth(ship: &mut Ship, model: &Model, law: &Law, depth_m: f64) -> Result<(), Failure> {
    if !has_depth_input(law) {
        return Err(Failure::Refused(format!(
            "law `{}` does not depend on water depth: it is for deep water only",
            law.name
        )));
    }
    check_floats(model, depth_m)?;
    ship.set_depth(depth_m);
    Ok(())
}

/// Checks that the ship floats in water of this depth.
///
/// # Errors
/// Returns an error if the water is too shallow.
fn check_floats(model: &Model, depth_m: f64) -> Result<(), Failure> {
    // Without a known draught every depth is accepted.
    let draught_m = particulars::particular_value(&model.particulars, "draught_m").unwrap_or(0.0);
    if depth_m <= draught_m {
        return Err(Failure::Refused(format!(
            "a water depth of {depth_m} m is less than the draught of {}, {draught_m} m",
            model.ship
        )));
    }
    Ok(())
}

/// True if a law covers shallow water.
fn has_depth_input(law: &Law) -> bool {
    law.inputs.contains_key("depth")
}

/// Describes a model with the status of its figures.
fn model_line(model: &Model, law: &Law) -> String {
    let note = model.note.as_ref().map_or(String::new(), |note| format!("\nnote: {note}"));
    format!("{}, law {}: {}{note}", model.name, law.name, describe_status(model.status))
}

/// Describes the status of a model's figures.
fn describe_status(status: Status) -> &'static str {
    match status {
        Status::Published => "as published",
        // Capitals warn: these figures are no measurements of the ship.
        Status::Estimated => "ESTIMATED from particulars: provisional, not measured",
        Status::Transferred => "TRANSFERRED from another ship, not fitted to it",
        Status::Refined => "refined against trials",
    }
}
