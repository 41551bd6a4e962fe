//! Appraisal of one model by published trials.

use serde::Serialize;
use sistership_model::law::Law;
use sistership_model::vessel::Status;
use sistership_model::{FileError, Model, Vessel, Zoo};
use sistership_simulation::manoeuvre::{
    ManoeuvreSettings, StandardManoeuvres, simulate_standard_manoeuvres,
};
use sistership_simulation::metrics::TurningMetrics;
use sistership_simulation::{PlantError, Ship};

use crate::validation::comparison::{FigureComparison, compare_published};
use crate::validation::validation_status::ValidationStatus;

/// A model's standard manoeuvres, the published trials of its ship, and what follows.
#[derive(Debug, Clone, Serialize)]
pub struct ModelAppraisal {
    /// `ship/model`.
    pub model: String,
    /// The law of motion.
    pub law: String,
    /// Origin of its figures.
    pub origin: Status,
    /// Validation status.
    pub standing: ValidationStatus,
    /// Length between perpendiculars, m.
    pub lpp_m: f64,
    /// Approach speed, m/s.
    pub speed_m_s: f64,
    /// Keys of the sources of its coefficients and parameters.
    pub sources: Vec<String>,
    /// Published figures compared with the model's.
    pub comparisons: Vec<FigureComparison>,
    /// The standard manoeuvres.
    pub manoeuvres: StandardManoeuvres,
}

impl ModelAppraisal {
    /// Returns a length of the turn to starboard, in ship lengths.
    pub fn turn_lengths(&self, of: impl Fn(&TurningMetrics) -> Option<f64>) -> Option<f64> {
        let starboard = self.manoeuvres.turns.iter().find(|turn| turn.rudder_deg > 0.0)?;
        Some(of(starboard)? / self.lpp_m)
    }

    /// Returns the first overshoot of the zigzag that begins to starboard with this rudder angle,
    /// deg.
    pub fn first_overshoot_deg(&self, rudder_deg: f64) -> Option<f64> {
        let mut zigzags = self.manoeuvres.zigzags.iter();
        zigzags.find(|zigzag| zigzag.rudder_deg == rudder_deg)?.first_overshoot_deg
    }
}

/// Simulates a model's standard manoeuvres and those of its ship's published trials.
///
/// # Errors
/// Returns an error with the quantity that the model lacks.
pub fn appraise_model(
    vessel: &Vessel,
    model: &Model,
    law: &Law,
) -> Result<ModelAppraisal, PlantError> {
    let ship = Ship::new(model, law)?;
    let comparisons = compare_published(&ship, &vessel.file.free_running);
    Ok(ModelAppraisal {
        model: model.name.clone(),
        law: model.law.clone(),
        origin: model.status,
        standing: ValidationStatus::from_comparisons(model.status, &comparisons),
        lpp_m: ship.lpp_m(),
        speed_m_s: ship.approach_speed_m_s(),
        sources: cited_sources(model),
        comparisons,
        manoeuvres: simulate_standard_manoeuvres(&ship, &ManoeuvreSettings::default()),
    })
}

/// Appraises every model of a vessel.
///
/// # Errors
/// Returns an error with the model and the quantity that it lacks.
pub fn appraise_vessel(zoo: &Zoo, vessel: &Vessel) -> Result<Vec<ModelAppraisal>, FileError> {
    let one = |name: &str| {
        let model = zoo.published_model(vessel, Some(name))?;
        let refused = |message: String| FileError {
            file: vessel.name().to_owned(),
            line: None,
            field: format!("models.{name}"),
            message,
            further: Vec::new(),
        };
        let law = zoo.law(&model.law).ok_or_else(|| refused("its law is not in the zoo".into()))?;
        appraise_model(vessel, &model, law).map_err(|error| refused(error.to_string()))
    };
    vessel.file.models.iter().map(|model| one(&model.name)).collect()
}

/// The sources of coefficients and parameters that are in the vessel's list.
fn cited_sources(model: &Model) -> Vec<String> {
    let values = model.coefficients.values().chain(model.parameters.values());
    let mut keys: Vec<String> = values
        .map(|quantity| quantity.source.clone())
        .filter(|key| model.sources.contains_key(key))
        .collect();
    keys.sort();
    keys.dedup();
    keys
}
