//! Documents that the server takes, to be sent as they are or spoiled.

use std::sync::OnceLock;

use serde_json::{Value, json};
use sistership_cli::sea_trials::{TrialManoeuvre, record_programme};
use sistership_model::{Trial, Zoo};
use sistership_simulation::Ship;
use sistership_trials::samples::to_csv;

use crate::attack::Failure;

/// The ship whose model and trials are used for all.
pub const PATTERN: &str = "sr108";

/// A container ship of which nobody has a model.
pub fn ship(name: &str) -> String {
    format!(
        "kind: vessel\nname: {name}\ntitle: A ship of the battery\ncategory: dry-cargo\n\
         sources: {{ yard: {{ citation: the yard }} }}\nparticulars:\n  source: yard\n  values: {{ \
         lpp_m: 175.0, beam_m: 25.4, draught_m: 8.5, displacement_m3: 21222.0, rudder_area_m2: \
         33.04, rudder_aspect_ratio: 1.82, propeller_diameter_m: 6.533, service_speed_m_s: 10.47, \
         x_g_m: 0.0, yaw_gyradius_ratio: 0.24 }}\n"
    )
}

/// The text of a law of the program.
pub const LAW: &str = include_str!("../../../models/laws/polynomial.yaml");

/// A law under another name.
pub fn law(name: &str) -> String {
    LAW.replacen("name: polynomial", &format!("name: {name}"), 1)
}

/// A law whose speed is another formula.
pub fn law_of(name: &str, formula: &str) -> String {
    law(name).replacen("max(sqrt(u^2 + v^2), 1e-4*sqrt(g*lpp_m))", formula, 1)
}

/// A law that other ships can be refined in, with another formula for the apparent wind speed.
pub fn low_speed_law(name: &str, formula: &str) -> String {
    let law = include_str!("../../../models/laws/low-speed.yaml").replacen(
        "name: low-speed",
        &format!("name: {name}"),
        1,
    );
    law.replacen("sqrt(u_A^2 + v_A^2 + 1e-6)", formula, 1)
}

/// A model for a ship, to be registered; its origin tells it from others.
///
/// # Errors
/// The zoo has none.
pub fn version(ship: &str, origin: &str) -> Result<Value, Failure> {
    static MODEL: OnceLock<Value> = OnceLock::new();
    let mut model = match MODEL.get() {
        Some(model) => model.clone(),
        None => {
            let made = serde_json::to_value(
                Zoo::load_embedded()?.find_model(PATTERN).map_err(|error| error.to_string())?,
            )?;
            MODEL.get_or_init(|| made).clone()
        }
    };
    model["ship"] = json!(ship);
    Ok(json!({ "model": model, "origin": origin }))
}

/// A trial of a few rows, unlike that of any other number.
pub fn rows(number: u64) -> String {
    let rows: String = (0..4).map(|row| format!("{row},{row}.{number:09}\n")).collect();
    format!("t_s,u_m_s\n{rows}")
}

/// Trials that a refinement learns from: names and CSV files.
///
/// # Errors
/// The pattern ship does not sail them.
pub fn trials() -> Result<Vec<(String, Vec<u8>)>, Failure> {
    let zoo = Zoo::load_embedded()?;
    let model = zoo.find_model(PATTERN).map_err(|error| error.to_string())?;
    let ship = Ship::new(&model, zoo.law(&model.law).ok_or("no law")?)
        .map_err(|error| error.to_string())?;
    let programme = [
        TrialManoeuvre::Zigzag(10.0, 10.0),
        TrialManoeuvre::Zigzag(20.0, 20.0),
        TrialManoeuvre::Turn(12.0),
        TrialManoeuvre::Turn(-20.0),
    ];
    let trials: Vec<Trial> =
        record_programme(&ship, 10.47, &programme, 3).map_err(|stopped| stopped.to_string())?;
    let csv = |trial: &Trial| -> Result<_, Failure> {
        let mut bytes = Vec::new();
        to_csv(&mut bytes, trial).map_err(|error| error.to_string())?;
        Ok((trial.name.clone(), bytes))
    };
    trials.iter().map(csv).collect()
}
