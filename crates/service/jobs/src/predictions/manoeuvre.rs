//! Standard manoeuvres.

use serde::Deserialize;
use serde_json::{Value, json};
use sistership_assessment::uncertainty::{Bands, Sampling, bands};
use sistership_model::{Law, Model};
use sistership_simulation::manoeuvre::{ManoeuvreSettings, standard, turn, zigzag};
use sistership_simulation::{Ship, Stopped};
use utoipa::ToSchema;

use super::track::{STEP_S, bounded, columns, positive, with_share};
use crate::predictions::error::{PredictError, Result};
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
    /// Approach speed; the model's own where absent.
    #[schema(inline)]
    speed_m_s: Option<Positive>,
    /// Propeller revolutions; those of the approach speed where absent.
    n_rps: Option<f64>,
    /// With `all`: confidence bands by models drawn from the posterior of a refined one.
    bands: Option<BandsRequest>,
}

/// How a posterior is sampled.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct BandsRequest {
    /// Models drawn; 100 where absent.
    #[schema(inline)]
    samples: Option<SampleCount>,
    /// What the draws follow from; 1 where absent.
    seed: Option<u64>,
}

/// A zigzag.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ZigzagRequest {
    /// Rudder angle, positive where the first execution is to starboard.
    #[schema(inline)]
    rudder_deg: Angle,
    /// Change of heading at which the rudder is reversed.
    #[schema(inline)]
    switch_deg: Angle,
}

impl ManoeuvreRequest {
    pub(super) fn sail(&self, ship: &mut Ship, whose: Whose<'_>, most: usize) -> Result<Value> {
        let settings = self.settings(ship, most)?;
        if self.bands.is_some() && !self.all {
            return Err(PredictError::invalid(
                "manoeuvre.bands",
                "are those of all standard manoeuvres: give `all`",
            ));
        }
        match (self.turn_deg, &self.zigzag, self.all) {
            (Some(rudder), None, false) => {
                let sailed = turn(ship, rudder.get(), &settings).map_err(diverged)?;
                let answer = json!({ "metrics": sailed.metrics,
                    "trajectory": columns(&sailed.track), "stopped": null,
                    "outside": ship.leaves(&sailed.track) });
                Ok(with_share(answer, ship, &sailed.track))
            }
            (None, Some(ZigzagRequest { rudder_deg, switch_deg }), false) => {
                let sailed = zigzag(ship, rudder_deg.get(), switch_deg.get().abs(), &settings)
                    .map_err(diverged)?;
                let answer = json!({ "metrics": sailed.metrics,
                    "trajectory": columns(&sailed.track), "stopped": null,
                    "outside": ship.leaves(&sailed.track) });
                Ok(with_share(answer, ship, &sailed.track))
            }
            (None, None, true) => {
                let mut sailed = serde_json::to_value(standard(ship, &settings))?;
                if let Some(request) = self.bands {
                    sailed["bands"] = serde_json::to_value(request.drawn(whose, &settings)?)?;
                }
                Ok(sailed)
            }
            _ => Err(PredictError::invalid(
                "manoeuvre",
                "give one of `turn_deg`, `zigzag` and `all`",
            )),
        }
    }

    /// The settings; they are refused where the run, of 60 lengths at most, would be out of all
    /// proportion.
    fn settings(&self, ship: &mut Ship, most: usize) -> Result<ManoeuvreSettings> {
        let speed = positive(
            "manoeuvre.speed_m_s",
            self.speed_m_s.map_or(ship.approach_speed_m_s(), Positive::get),
        )?;
        if self.n_rps.is_some_and(|n| !n.is_finite()) {
            return Err(PredictError::invalid("manoeuvre.n_rps", "must be a number"));
        }
        let length_s = ship.lpp_m() / speed;
        let step_s = STEP_S.min(0.02 * length_s);
        bounded("manoeuvre.speed_m_s", 60.0 * length_s / step_s, most)?;
        ship.set_envelope_speed(speed);
        let (speed_m_s, n_rps, step_s) =
            (self.speed_m_s.map(Positive::get), self.n_rps, Some(step_s));
        Ok(ManoeuvreSettings { speed_m_s, n_rps, step_s, ..ManoeuvreSettings::default() })
    }
}

/// The model that sails, for drawing others like it.
#[derive(Clone, Copy)]
pub(super) struct Whose<'a> {
    pub model: &'a Model,
    pub law: &'a Law,
    pub depth_m: Option<f64>,
}

impl BandsRequest {
    fn drawn(self, whose: Whose<'_>, settings: &ManoeuvreSettings) -> Result<Bands> {
        let default = Sampling::default();
        let samples =
            usize::try_from(self.samples.unwrap_or_default().get()).unwrap_or(default.samples);
        let seed = self.seed.unwrap_or(default.seed);
        let sampling = Sampling { samples, seed, within_steps: true, figures_only: true };
        let none = || {
            let why = "only a refined one whose coefficients are those that were estimated has one";
            PredictError::invalid(
                "manoeuvre.bands",
                format!("the model has no posterior to draw from; {why}"),
            )
        };
        let coarse = ManoeuvreSettings { step_s: None, ..*settings };
        bands(whose.model, whose.law, &coarse, whose.depth_m, sampling).ok_or_else(none)
    }
}

fn diverged(stopped: Stopped) -> PredictError {
    PredictError::invalid(
        "manoeuvre",
        format!(
            "the simulation left the physical range, {stopped}; the model does not hold for this \
             manoeuvre"
        ),
    )
}
