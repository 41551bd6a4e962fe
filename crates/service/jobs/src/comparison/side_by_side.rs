//! Models side by side.

use serde::Serialize;
use sistership_model::trial::Trial;
use sistership_simulation::{PlantError, Ship};
use utoipa::ToSchema;

use super::coefficients::{self, ComparedCoefficient};
use super::compared::Compared;
use super::manoeuvres::{self, ComparedFigure};
use super::trials::{self, ComparedTrial};

/// Fewest and most models that are compared at once.
pub const BETWEEN: [usize; 2] = [2, 5];

/// Most trials on which models are compared at once.
pub const MOST_TRIALS: usize = 20;

/// What is the same for a whole column.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct Column {
    /// The name by which the model was asked for.
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
    /// Standard manoeuvres that left the physical range or could not be sailed, with the reason.
    pub failures: Vec<String>,
    /// Standardised mean squared error over all samples of the trials; null where a simulation
    /// stopped, or without trials.
    pub standardised_mse: Option<f64>,
}

/// Models side by side. Every list of values has one for each model, in the order of `models`.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct Comparison {
    /// The models.
    pub models: Vec<Column>,
    /// Every coefficient that one of them has.
    pub coefficients: Vec<ComparedCoefficient>,
    /// Errors on the same trials.
    pub trials: Vec<ComparedTrial>,
    /// Figures of the standard manoeuvres, and the IMO criteria.
    pub figures: Vec<ComparedFigure>,
}

/// Why models cannot be compared.
#[derive(Debug, thiserror::Error)]
pub enum ComparisonError {
    /// Too few or too many.
    #[error("two to five models are compared at once, not {0}")]
    Count(usize),
    /// One of them is named twice.
    #[error("`{0}` is named twice")]
    Twice(String),
    /// One of them cannot sail.
    #[error("{name}: {reason}")]
    Model {
        /// The name by which it was asked for.
        name: String,
        /// Why not.
        reason: PlantError,
    },
}

/// Compares models, and their errors on trials.
///
/// # Errors
/// Says which of them cannot be compared, and why.
pub fn compare(
    compared: &[Compared<'_>],
    trials: &[(&str, &Trial)],
) -> Result<Comparison, ComparisonError> {
    check(&compared.iter().map(|one| one.name).collect::<Vec<_>>())?;
    let ships: Vec<Ship> = compared.iter().map(ready).collect::<Result<_, _>>()?;
    let sailed = trials::errors(compared, &ships, trials);
    let standard: Vec<_> =
        compared.iter().zip(&ships).map(|(one, ship)| manoeuvres::standard_of(one, ship)).collect();
    let columns = compared.iter().zip(&ships).enumerate().map(|(place, (one, ship))| Column {
        name: one.name.to_owned(),
        model: one.model.name.clone(),
        ship: one.model.ship.clone(),
        law: one.law.name.clone(),
        speed_m_s: ship.approach_speed_m_s(),
        lpp_m: ship.lpp_m(),
        failures: standard[place].failures.clone(),
        standardised_mse: trials::over_all(&sailed, place),
    });
    Ok(Comparison {
        models: columns.collect(),
        coefficients: coefficients::side_by_side(compared),
        figures: manoeuvres::side_by_side(&standard),
        trials: sailed,
    })
}

/// Two to five names, each once.
///
/// # Errors
/// Says what is wrong with them.
pub fn check(names: &[&str]) -> Result<(), ComparisonError> {
    if !(BETWEEN[0]..=BETWEEN[1]).contains(&names.len()) {
        return Err(ComparisonError::Count(names.len()));
    }
    match (1..names.len()).find(|&place| names[..place].contains(&names[place])) {
        Some(place) => Err(ComparisonError::Twice(names[place].to_owned())),
        None => Ok(()),
    }
}

fn ready(one: &Compared<'_>) -> Result<Ship, ComparisonError> {
    Ship::new(one.model, one.law)
        .map_err(|reason| ComparisonError::Model { name: one.name.to_owned(), reason })
}
