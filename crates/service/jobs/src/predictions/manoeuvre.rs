//! Predictions of standard manoeuvres.

use serde::Deserialize;
use serde_json::{Value, json};
use sistership_assessment::uncertainty::{Sampling, UncertaintyBands, uncertainty_bands};
use sistership_model::{Law, Model};
use sistership_simulation::manoeuvre::{
    ManoeuvreSettings, simulate_standard_manoeuvres, simulate_turn, simulate_zigzag,
};
use sistership_simulation::{Ship, SimulationStop};
use utoipa::ToSchema;

use super::track::{STEP_S, check_positive, reserve_steps, track_columns, with_share};
use crate::predictions::error::{PredictionError, Result};
use sistership_request_types::{Angle, Positive, SampleCount};

/// One of `turn_deg`, `zigzag` and `all`.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ManoeuvreRequest {
    /// A turning circle with this rudder angle, positive to starboard.
    #[schema(inline)]
    turn_deg: Option<Angle>,
    /// A zigzag.
    zigzag: Option<ZigzagRequest>,
    /// Turning circles, zigzags and the IMO criteria.
    #[serde(default)]
    all: bool,
    /// Approach speed; by default the model's own.
    #[schema(inline)]
    speed_m_s: Option<Positive>,
    /// Propeller revolutions; by default those of the approach speed.
    n_rps: Option<f64>,
    /// With `all`: confidence bands by models drawn from the posterior of a refined one.
    bands: Option<BandsRequest>,
}

/// Sampling of the posterior.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct BandsRequest {
    /// Number of models drawn; default 100.
    #[schema(inline)]
    samples: Option<SampleCount>,
    /// Seed of the draws; default 1.
    seed: Option<u64>,
}

/// A zigzag.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ZigzagRequest {
    /// Rudder angle, positive if the first execution is to starboard.
    #[schema(inline)]
    rudder_deg: Angle,
    /// Change of heading at which the rudder is reversed.
    #[schema(inline)]
    switch_deg: Angle,
}

impl ManoeuvreRequest {
    pub(super) fn simulate_manoeuvre(
        &self,
        ship: &mut Ship,
        whose: PosteriorSource<'_>,
        most: usize,
    ) -> Result<Value> {
        let settings = self.manoeuvre_settings(ship, most)?;
        // Bands are those of the figures of the standard set.
        if self.bands.is_some() && !self.all {
            return Err(PredictionError::invalid_field(
                "manoeuvre.bands",
                "are available for all standard manoeuvres only: give `all`",
            ));
        }
        match (self.turn_deg, &self.zigzag, self.all) {
            (Some(rudder), None, false) => {
                let sailed =
                    simulate_turn(ship, rudder.get(), &settings).map_err(divergence_error)?;
                let answer = json!({ "metrics": sailed.metrics,
                    "trajectory": track_columns(&sailed.track), "stopped": null,
                    "outside": ship.find_excursion(&sailed.track) });
                Ok(with_share(answer, ship, &sailed.track))
            }
            (None, Some(ZigzagRequest { rudder_deg, switch_deg }), false) => {
                let sailed =
                    simulate_zigzag(ship, rudder_deg.get(), switch_deg.get().abs(), &settings)
                        .map_err(divergence_error)?;
                let answer = json!({ "metrics": sailed.metrics,
                    "trajectory": track_columns(&sailed.track), "stopped": null,
                    "outside": ship.find_excursion(&sailed.track) });
                Ok(with_share(answer, ship, &sailed.track))
            }
            // A failed manoeuvre of the set is a reason in its answer, not an error of the request.
            (None, None, true) => {
                let mut sailed =
                    serde_json::to_value(simulate_standard_manoeuvres(ship, &settings))?;
                if let Some(request) = self.bands {
                    sailed["bands"] = serde_json::to_value(request.draw_bands(whose, &settings)?)?;
                }
                Ok(sailed)
            }
            _ => Err(PredictionError::invalid_field(
                "manoeuvre",
                "give one of `turn_deg`, `zigzag` and `all`",
            )),
        }
    }

    /// Returns the settings. A run is refused if its steps, for 60 ship lengths of travel, exceed
    /// `most`.
    fn manoeuvre_settings(&self, ship: &mut Ship, most: usize) -> Result<ManoeuvreSettings> {
        let speed = check_positive(
            "manoeuvre.speed_m_s",
            self.speed_m_s.map_or(ship.approach_speed_m_s(), Positive::get),
        )?;
        if self.n_rps.is_some_and(|n| !n.is_finite()) {
            return Err(PredictionError::invalid_field("manoeuvre.n_rps", "must be a number"));
        }
        // The step resolves the time of one ship length in at least 50 steps.
        let length_s = ship.lpp_m() / speed;
        let step_s = STEP_S.min(0.02 * length_s);
        reserve_steps("manoeuvre.speed_m_s", 60.0 * length_s / step_s, most)?;
        // The physical range is relative to the approach speed.
        ship.set_envelope_speed(speed);
        let (speed_m_s, n_rps, step_s) =
            (self.speed_m_s.map(Positive::get), self.n_rps, Some(step_s));
        Ok(ManoeuvreSettings { speed_m_s, n_rps, step_s, ..ManoeuvreSettings::default() })
    }
}

/// The simulated model, from whose posterior others are drawn.
#[derive(Clone, Copy)]
pub(super) struct PosteriorSource<'a> {
    pub model: &'a Model,
    pub law: &'a Law,
    pub depth_m: Option<f64>,
}

impl BandsRequest {
    fn draw_bands(
        self,
        whose: PosteriorSource<'_>,
        settings: &ManoeuvreSettings,
    ) -> Result<UncertaintyBands> {
        let default = Sampling::default();
        let samples =
            usize::try_from(self.samples.unwrap_or_default().get()).unwrap_or(default.samples);
        let seed = self.seed.unwrap_or(default.seed);
        let sampling = Sampling { samples, seed };
        let none = || {
            let why = "only a refined model with unchanged coefficients has one";
            PredictionError::invalid_field(
                "manoeuvre.bands",
                format!("the model has no posterior to draw from; {why}"),
            )
        };
        // Only figures are needed of the draws, whose switching times are found within a step: the
        // default step is enough.
        let coarse = ManoeuvreSettings { step_s: None, ..*settings };
        uncertainty_bands(whose.model, whose.law, &coarse, whose.depth_m, sampling).ok_or_else(none)
    }
}

fn divergence_error(stopped: SimulationStop) -> PredictionError {
    PredictionError::invalid_field(
        "manoeuvre",
        format!(
            "the simulation left the physical range, {stopped}; the model is not valid for this \
             manoeuvre"
        ),
    )
}
