//! Output document of `sistership manoeuvre`.

use std::collections::BTreeMap;

use serde::Serialize;
use sistership_assessment::uncertainty::UncertaintyBands;
use sistership_model::Model;
use sistership_model::validity::Excursion;
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{FurtherManoeuvres, StandardManoeuvres};
use sistership_simulation::metrics::{ImoCriterion, TurningMetrics, ZigzagMetrics};

/// Output document.
#[derive(Debug, Serialize)]
pub struct ManoeuvreDocument {
    /// The model.
    pub model: String,
    /// Its law.
    pub law: String,
    /// Status of its figures: published, estimated, transferred or refined.
    pub status: sistership_model::vessel::Status,
    /// The approach speed, m/s.
    pub speed_m_s: f64,
    /// Turning circles.
    pub turns: Vec<TurningMetrics>,
    /// Zigzags.
    pub zigzags: Vec<ZigzagMetrics>,
    /// Distance to 10 deg of heading with 10 deg of rudder, the worse side, m.
    pub initial_turning_m: Option<f64>,
    /// Stopping, pull-outs and spirals.
    #[serde(flatten)]
    pub further: FurtherManoeuvres,
    /// The IMO criteria.
    pub imo: Vec<ImoCriterion>,
    /// Manoeuvres that left the physical range.
    pub failures: Vec<String>,
    /// Manoeuvres that left the range covered by the model's trials.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub outside: BTreeMap<String, Excursion>,
    /// Share of the learned correction in each manoeuvre, 0 to 1.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub branch_share: BTreeMap<String, f64>,
    /// Confidence bands, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bands: Option<UncertaintyBands>,
    /// Remarks that are needed to read the figures.
    pub remarks: Vec<String>,
}

impl ManoeuvreDocument {
    /// Combines the results of all manoeuvres.
    pub fn from_results(
        model: &Model,
        ship: &Ship,
        sailed: StandardManoeuvres,
        mut further: FurtherManoeuvres,
        bands: Option<UncertaintyBands>,
        mut remarks: Vec<String>,
    ) -> Self {
        let mut failures = sailed.failures;
        // Failures of all manoeuvres are in one list.
        failures.append(&mut further.failures);
        remarks.extend(further.reader_remarks(ship.lpp_m()));
        let stopping = further.stopping_criterion(ship.lpp_m());
        let mut outside = sailed.outside;
        for (name, track) in &further.tracks {
            outside.extend(ship.find_excursion(track).map(|excursion| (name.clone(), excursion)));
        }
        Self {
            model: model.name.clone(),
            law: model.law.clone(),
            status: model.status,
            speed_m_s: ship.approach_speed_m_s(),
            turns: sailed.turns,
            zigzags: sailed.zigzags,
            initial_turning_m: sailed.initial_turning_m,
            imo: sailed.imo.into_iter().chain(stopping).collect(),
            further,
            failures,
            outside,
            branch_share: sailed.branch_share,
            bands,
            remarks,
        }
    }
}
