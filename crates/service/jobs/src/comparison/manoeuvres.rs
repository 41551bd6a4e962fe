//! Comparison of the standard manoeuvres.

use serde::Serialize;
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{
    ManoeuvreSettings, NamedFigure, StandardManoeuvres, simulate_standard_manoeuvres,
};
use utoipa::ToSchema;

use super::comparison_model::ComparisonModel;

/// Figure of one model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, ToSchema)]
pub struct FigureValue {
    /// Its value; null if the manoeuvre did not reach it.
    pub value: Option<f64>,
    /// True if the criterion is met; null for a figure that is no criterion, or without a value.
    pub pass: Option<bool>,
}

/// A figure of every model.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct ComparedFigure {
    /// Its name: `turn 35 deg: tactical diameter`, `IMO: advance`.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its value for each model; null if the model's manoeuvre failed.
    pub values: Vec<Option<FigureValue>>,
}

/// Simulates the standard manoeuvres of a model at its own speed and revolutions.
pub fn simulate_standard(one: &ComparisonModel<'_>, ship: &Ship) -> StandardManoeuvres {
    // Without revolutions the propeller would brake the ship, and the figures would mean nothing.
    if ship.follows_revolutions() && ship.revolutions_at(ship.approach_speed_m_s()) == 0.0 {
        let reason = format!(
            "law `{}` needs propeller revolutions and {} gives none",
            one.law.name, one.model.name
        );
        return StandardManoeuvres { failures: vec![reason], ..StandardManoeuvres::default() };
    }
    simulate_standard_manoeuvres(ship, &ManoeuvreSettings::default())
}

/// Lists every figure that at least one model has, in the order of the manoeuvres.
pub fn compare_figures(all: &[StandardManoeuvres]) -> Vec<ComparedFigure> {
    let figures: Vec<Vec<NamedFigure>> = all.iter().map(StandardManoeuvres::list_figures).collect();
    let mut rows: Vec<ComparedFigure> = Vec::new();
    for (place, figure) in
        figures.iter().enumerate().flat_map(|(k, of)| of.iter().map(move |f| (k, f)))
    {
        // Figures are matched by name: laws with fewer outputs have fewer figures.
        let row = rows.iter().position(|row| row.name == figure.name).unwrap_or_else(|| {
            rows.push(ComparedFigure {
                name: figure.name.clone(),
                unit: figure.unit.clone(),
                values: vec![None; all.len()],
            });
            rows.len() - 1
        });
        rows[row].values[place] = Some(FigureValue { value: figure.value, pass: figure.pass });
    }
    rows
}
