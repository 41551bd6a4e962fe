//! Calls of the program.

use std::path::Path;

use serde_json::Value;
use sistership_tests::binary;

/// Models drawn for the bands.
const DRAWS: &str = "200";

/// Its JSON document, or the last line of what it said.
///
/// # Errors
/// The program refuses.
pub fn asked(words: &[&str]) -> Result<Value, String> {
    let words: Vec<&str> = words.iter().copied().chain(["--json"]).collect();
    let output = binary::run(&words);
    let said = String::from_utf8_lossy(&output.stderr);
    match output.status.success() {
        true => serde_json::from_slice(&output.stdout).map_err(|error| error.to_string()),
        false => Err(said.lines().last().unwrap_or_default().to_owned()),
    }
}

/// Refines a ship on trials and writes the model.
///
/// # Errors
/// It makes none.
pub fn refine(vessel: &Path, trials: &Path, out: &Path) -> Result<(), String> {
    let [vessel, trials, out] = [vessel, trials, out].map(|path| path.display().to_string());
    asked(&["refine", "--ship", &vessel, "--trials", &trials, "--out", &out]).map(|_| ())
}

/// The plan of a model.
///
/// # Errors
/// There is none.
pub fn plan(model: &Path, budget_min: f64) -> Result<Value, String> {
    let (model, budget) = (model.display().to_string(), budget_min.to_string());
    asked(&["plan", "--ship", &model, "--budget-min", &budget])
}

/// The standard manoeuvres of a model with their bands.
///
/// # Errors
/// It has none.
pub fn bands(model: &Path) -> Result<Value, String> {
    let model = model.display().to_string();
    asked(&["manoeuvre", "--model", &model, "--all", "--bands", DRAWS])
}
