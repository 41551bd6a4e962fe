//! Provenance of every figure of a refined model.

use std::collections::BTreeMap;

use serde::Serialize;
use sistership_identification::refine::RefinementSettings;
use sistership_model::estimated_particulars::{EstimatedParticular, SCALED, estimated_particulars};
use sistership_model::law::LawParameter;
use sistership_model::model::DERIVED_SOURCE;
use sistership_model::quantity::Quantity;
use sistership_model::source::Source;
use sistership_model::vessel::{Status, Steering};

use super::input::RefinementInput;
use crate::words;

/// Inputs of the refined model.
#[derive(Debug, Serialize)]
pub(crate) struct ModelProvenance<'a> {
    pub particulars: Vec<StatedQuantity<'a>>,
    pub estimated_particulars: Vec<EstimatedParticular>,
    pub parameters: Vec<StatedQuantity<'a>>,
    pub steering: &'a Steering,
    pub ship_sources: &'a BTreeMap<String, Source>,
    pub model_sources: &'a BTreeMap<String, Source>,
    pub law_sources: &'a BTreeMap<String, Source>,
    pub source_note: Option<&'a str>,
    pub trials: Vec<&'a str>,
    pub remarks: &'a [String],
    pub condition_number: f64,
    pub settings: &'a RefinementSettings,
}

/// Value with its source.
#[derive(Debug, Serialize)]
pub(crate) struct StatedQuantity<'a> {
    pub name: &'a str,
    pub meaning: String,
    pub unit: &'a str,
    #[serde(flatten)]
    pub quantity: &'a Quantity,
    /// Kind of derivation, if the value is not simply stated by a source.
    pub kind: Option<&'static str>,
}

impl<'a> ModelProvenance<'a> {
    pub fn from_input(input: &RefinementInput<'a>) -> Self {
        let (refinement, model) = (input.refinement, &input.refinement.model);
        Self {
            particulars: model
                .particulars
                .iter()
                .map(|(name, quantity)| stated_particular(name, quantity))
                .collect(),
            estimated_particulars: estimated_particulars(&model.particulars),
            parameters: model
                .parameters
                .iter()
                .map(|(name, q)| stated_parameter(name, q, input.law.parameters.get(name)))
                .collect(),
            steering: &model.steering,
            ship_sources: &input.vessel.file.sources,
            model_sources: &refinement.transferred.sources,
            law_sources: &input.law.sources,
            source_note: refinement.transferred.note.as_deref(),
            trials: input.trials.iter().map(|trial| trial.name.as_str()).collect(),
            remarks: &refinement.remarks,
            condition_number: refinement.condition_number,
            settings: &refinement.settings,
        }
    }
}

fn stated_particular<'a>(name: &'a str, quantity: &'a Quantity) -> StatedQuantity<'a> {
    let (meaning, unit) = words::field_words(name);
    StatedQuantity { name, meaning, unit, quantity, kind: derivation_kind(&quantity.source) }
}

fn stated_parameter<'a>(
    name: &'a str,
    quantity: &'a Quantity,
    of: Option<&'a LawParameter>,
) -> StatedQuantity<'a> {
    let (meaning, unit) =
        of.map_or(("", "–"), |parameter| (parameter.meaning.as_str(), parameter.unit.as_str()));
    StatedQuantity {
        name,
        meaning: meaning.to_owned(),
        unit,
        quantity,
        kind: derivation_kind(&quantity.source),
    }
}

/// Kind of derivation of a value, by its source.
fn derivation_kind(source: &str) -> Option<&'static str> {
    match source {
        DERIVED_SOURCE => Some("derived"),
        "approach-speed" => Some("from trials"),
        _ if source.starts_with(SCALED) => Some("scaled"),
        _ if is_estimated(source) => Some("estimated"),
        _ if source.starts_with("mean over a population") => Some("of a population"),
        _ => None,
    }
}

/// True if a source declares its value an estimate.
pub(crate) fn is_estimated(source: &str) -> bool {
    source.to_lowercase().contains("estimat")
}

/// Status of the source model, if it is known from the given documents: a model of the ship itself,
/// or one that was not transferred.
pub(crate) fn source_status(input: &RefinementInput<'_>) -> Option<Status> {
    let refinement = input.refinement;
    // A model that was not transferred keeps its status; otherwise the source's file is needed.
    if refinement.transferred.status != Status::Transferred {
        return Some(refinement.transferred.status);
    }
    let (ship, model) = refinement.source.split_once('/')?;
    let own = input
        .vessel
        .file
        .models
        .iter()
        .find(|file| ship == input.vessel.name() && file.name == model);
    own.map(|file| file.status)
}
