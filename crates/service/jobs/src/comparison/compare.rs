//! Comparison of models.

use serde::Serialize;
use sistership_model::trial::Trial;
use sistership_simulation::{PlantError, Ship};
use utoipa::ToSchema;

use super::coefficients::{self, ComparedCoefficient};
use super::comparison_model::ComparisonModel;
use super::manoeuvres::{self, ComparedFigure};
use super::trials::{self, ComparedTrial};

/// Smallest and largest number of models in a comparison.
pub const MODEL_COUNT_LIMITS: [usize; 2] = [2, 5];

/// Largest number of trials in a comparison.
pub const MOST_TRIALS: usize = 20;

/// Model of a comparison, with figures that concern it as a whole.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct Column {
    /// Name of the model in the request.
    pub name: String,
    /// The model's own name.
    pub model: String,
    /// Its ship.
    pub ship: String,
    /// Its law.
    pub law: String,
    /// The approach speed of its standard manoeuvres, m/s.
    pub speed_m_s: f64,
    /// Its length between perpendiculars, m.
    pub lpp_m: f64,
    /// Standard manoeuvres that left the physical range or could not be simulated, with the reason.
    pub failures: Vec<String>,
    /// Standardised mean squared error over all samples of the trials; null if a simulation
    /// stopped, or without trials.
    pub standardised_mse: Option<f64>,
}

/// Comparison of models. Every list of values has one for each model, in the order of `models`.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct Comparison {
    /// The models.
    pub models: Vec<Column>,
    /// Every coefficient that at least one of them has.
    pub coefficients: Vec<ComparedCoefficient>,
    /// Errors on the same trials.
    pub trials: Vec<ComparedTrial>,
    /// Figures of the standard manoeuvres, and the IMO criteria.
    pub figures: Vec<ComparedFigure>,
}

/// Error of a comparison.
#[derive(Debug, thiserror::Error)]
pub enum ComparisonError {
    /// Too few or too many models.
    #[error("two to five models can be compared, not {0}")]
    Count(usize),
    /// A model is named twice.
    #[error("`{0}` is listed twice")]
    Twice(String),
    /// A model cannot be simulated.
    #[error("{name}: {reason}")]
    Model {
        /// Name of the model in the request.
        name: String,
        /// The reason.
        reason: PlantError,
    },
}

/// Compares models, including their errors on trials.
///
/// # Errors
/// Returns an error that names the model that cannot be compared, and the reason.
pub fn compare(
    compared: &[ComparisonModel<'_>],
    trials: &[(&str, &Trial)],
) -> Result<Comparison, ComparisonError> {
    check_names(&compared.iter().map(|one| one.name).collect::<Vec<_>>())?;
    let ships: Vec<Ship> = compared.iter().map(build_ship).collect::<Result<_, _>>()?;
    // Each model is simulated once on each trial; the totals below use these results.
    let sailed = trials::simulation_errors(compared, &ships, trials);
    let standard: Vec<_> = compared
        .iter()
        .zip(&ships)
        .map(|(one, ship)| manoeuvres::simulate_standard(one, ship))
        .collect();
    let columns = compared.iter().zip(&ships).enumerate().map(|(place, (one, ship))| Column {
        name: one.name.to_owned(),
        model: one.model.name.clone(),
        ship: one.model.ship.clone(),
        law: one.law.name.clone(),
        speed_m_s: ship.approach_speed_m_s(),
        lpp_m: ship.lpp_m(),
        failures: standard[place].failures.clone(),
        standardised_mse: trials::mean_over_trials(&sailed, place),
    });
    Ok(Comparison {
        models: columns.collect(),
        coefficients: coefficients::compare_coefficients(compared),
        figures: manoeuvres::compare_figures(&standard),
        trials: sailed,
    })
}

/// Checks that there are two to five names and no duplicates.
///
/// # Errors
/// Returns an error if the number of names is wrong or one is repeated.
pub fn check_names(names: &[&str]) -> Result<(), ComparisonError> {
    if !(MODEL_COUNT_LIMITS[0]..=MODEL_COUNT_LIMITS[1]).contains(&names.len()) {
        return Err(ComparisonError::Count(names.len()));
    }
    // A pairwise search is enough for five names.
    match (1..names.len()).find(|&place| names[..place].contains(&names[place])) {
        Some(place) => Err(ComparisonError::Twice(names[place].to_owned())),
        None => Ok(()),
    }
}

fn build_ship(one: &ComparisonModel<'_>) -> Result<Ship, ComparisonError> {
    Ship::new(one.model, one.law)
        .map_err(|reason| ComparisonError::Model { name: one.name.to_owned(), reason })
}
