//! Predictions: simulation of a manoeuvre, of recorded inputs, over a horizon, or stepwise in a
//! session.

mod error;
mod horizon;
mod inputs;
mod manoeuvre;
mod outside_trials;
pub mod session;
mod track;

use serde::Deserialize;
use serde_json::Value;
use sistership_model::environment::PredictionEnvironment;
use sistership_model::{Law, Model};
use sistership_simulation::Ship;
use utoipa::ToSchema;

pub use error::{PredictionError, Result};
pub use horizon::{HorizonRequest, TimedOrders};
pub use inputs::{InitialState, InputsRequest};
pub use manoeuvre::{BandsRequest, ManoeuvreRequest, ZigzagRequest};

use manoeuvre::PosteriorSource;
use outside_trials::with_outside_trials;
use sistership_request_types::{ModelName, Positive};

/// Request for a simulation: a manoeuvre, recorded inputs, or orders to come.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct PredictionRequest {
    /// `ship` (its champion), `ship/number` or `ship/alias`.
    #[schema(inline)]
    pub model: ModelName,
    /// Water depth for laws with a depth, m; deep water by default.
    #[schema(inline)]
    pub depth_m: Option<Positive>,
    /// A standard manoeuvre; alternative to `inputs` and `horizon`.
    pub manoeuvre: Option<ManoeuvreRequest>,
    /// Recorded inputs; alternative to `manoeuvre` and `horizon`.
    pub inputs: Option<InputsRequest>,
    /// A time from now on with orders; alternative to `manoeuvre` and `inputs`.
    pub horizon: Option<HorizonRequest>,
}

/// Simulates a request; no track has more than `most` samples.
///
/// # Errors
/// Returns an error that names the invalid field of the request, or the missing memory.
pub fn predict(
    request: &PredictionRequest,
    model: &Model,
    law: &Law,
    most: usize,
) -> Result<Value> {
    let mut ship = Ship::new(model, law)
        .map_err(|error| PredictionError::invalid_field("model", error.to_string()))?;
    // A law without a depth ignores it; `uncovered` reports a depth outside the trials.
    if let Some(depth) = request.depth_m {
        ship.set_depth(depth.get());
    }
    let depth_m = request.depth_m.map(Positive::get);
    // Computed for the request as a whole; the horizon has wind and current of its own.
    let uncovered = PredictionEnvironment { depth_m, ..PredictionEnvironment::default() }
        .uncovered_inputs(model);
    match (&request.manoeuvre, &request.inputs, &request.horizon) {
        (Some(manoeuvre), None, None) => {
            let answer = manoeuvre.simulate_manoeuvre(
                &mut ship,
                PosteriorSource { model, law, depth_m },
                most,
            )?;
            Ok(with_outside_trials(answer, &uncovered))
        }
        (None, Some(inputs), None) => {
            Ok(with_outside_trials(inputs.simulate_inputs(&mut ship, most)?, &uncovered))
        }
        (None, None, Some(horizon)) => {
            horizon.simulate_horizon((&request.model, request.depth_m), model, law, most)
        }
        _ => {
            let message = "give either `manoeuvre`, `inputs` or `horizon`";
            Err(PredictionError::invalid_field("manoeuvre", message))
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use serde_json::json;
    use sistership_model::Zoo;
    use sistership_model::posterior::Posterior;
    use sistership_model::validity::Region;

    fn ask(ship: &str, request: Value) -> Result<Value> {
        let zoo = Zoo::load_embedded().unwrap();
        let model = zoo.find_model(ship).unwrap();
        let request: PredictionRequest =
            serde_path_to_error::deserialize(request).map_err(|error| {
                PredictionError::invalid_field(&error.path().to_string(), error.inner().to_string())
            })?;
        predict(&request, &model, zoo.law(&model.law).unwrap(), 100_000)
    }

    fn field(error: PredictionError) -> String {
        match error {
            PredictionError::Field { field, .. } => field,
            other => panic!("{other}"),
        }
    }

    #[test]
    fn manoeuvres_give_tracks_and_figures() {
        let turn = ask("mariner", json!({ "model": "mariner", "manoeuvre": { "turn_deg": -35 } }))
            .unwrap();
        assert!(turn["metrics"]["tactical_diameter_m"].as_f64().unwrap() > 300.0);
        assert_eq!(
            turn["trajectory"]["t_s"].as_array().unwrap().len(),
            turn["trajectory"]["psi_rad"].as_array().unwrap().len()
        );
        let zigzag = json!({ "model": "mariner",
            "manoeuvre": { "zigzag": { "rudder_deg": 10, "switch_deg": 10 } } });
        assert!(ask("mariner", zigzag).unwrap()["metrics"]["first_overshoot_deg"].is_number());
        let all = ask("kvlcc2-7m", json!({ "model": "kvlcc2-7m", "manoeuvre": { "all": true } }))
            .unwrap();
        assert_eq!(all["turns"].as_array().unwrap().len(), 2);
    }

    #[test]
    fn a_refined_model_says_how_sure_it_is_and_when_it_leaves_its_trials() {
        let zoo = Zoo::load_embedded().unwrap();
        let mut model = zoo.find_model("mariner").unwrap();
        let names = vec!["N_delta".to_owned()];
        let value = model.coefficient("N_delta");
        model.posterior = Some(Posterior {
            names,
            values: vec![value],
            deviations: vec![0.05 * value.abs()],
            root_correlation: vec!["1".into()],
        });
        model.validity = Region::from_samples(&[("delta".to_owned(), vec![-0.2, 0.2])].into());
        let sail = |request: Value| {
            predict(
                &serde_json::from_value(request).unwrap(),
                &model,
                zoo.law("abkowitz").unwrap(),
                100_000,
            )
        };
        let asked =
            json!({ "model": "m", "manoeuvre": { "all": true, "bands": { "samples": 10 } } });
        let all = sail(asked.clone()).unwrap();
        let band = &all["bands"]["figures"][2];
        let diameter = all["turns"][0]["tactical_diameter_m"].as_f64().unwrap();
        assert_eq!(band["figure"], "turn 35 deg: tactical diameter");
        assert!(
            band["low"].as_f64().unwrap() < diameter && diameter < band["high"].as_f64().unwrap()
        );
        assert_eq!(all["outside"]["turn 35 deg"]["along"], "delta");
        assert_eq!(sail(asked).unwrap(), all);
        let turn = sail(json!({ "model": "m", "manoeuvre": { "turn_deg": 10 } })).unwrap();
        assert!(turn["outside"].is_null());
        let published =
            ask("mariner", json!({ "model": "m", "manoeuvre": { "all": true, "bands": {} } }));
        assert_eq!(published.map_err(field).unwrap_err(), "manoeuvre.bands");
    }

    #[test]
    fn surroundings_that_no_trial_had_are_named_in_the_answer() {
        let zoo = Zoo::load_embedded().unwrap();
        let mut model = zoo.find_model("mariner").unwrap();
        let delta = [("delta".to_owned(), vec![-0.2, 0.2])].into();
        model.validity = Region::from_samples(&delta);
        let ask = |model: &Model, request: Value| {
            let request = serde_json::from_value(request).unwrap();
            let answer = predict(&request, model, zoo.law("abkowitz").unwrap(), 100_000).unwrap();
            let named = answer["outside_trials"].as_array().cloned().unwrap_or_default();
            named.iter().map(|one| one["message"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
        };
        let storm = json!({ "model": "m", "horizon": { "duration_s": 5,
            "wind": { "speed_m_s": 25, "from_rad": 1.0 },
            "current": { "speed_m_s": 1, "towards_rad": 0 } } });
        let named = ask(&model, storm.clone());
        assert!(named[0].starts_with("wind of 25.0 m/s: no trial"), "{named:?}");
        assert!(named[1].starts_with("current of 1.0 m/s"), "{named:?}");
        let calm = json!({ "model": "m", "horizon": { "duration_s": 5 } });
        assert_eq!(ask(&model, calm), Vec::<String>::new());
        let shallow = json!({ "model": "m", "depth_m": 12, "manoeuvre": { "turn_deg": 10 } });
        assert!(ask(&model, shallow)[0].starts_with("water depth of 12.0 m"));
        let windy = [("wind_speed".to_owned(), [0.0, 30.0])].into();
        model.validity.as_mut().unwrap().environment = windy;
        assert_eq!(ask(&model, storm).len(), 1);
    }

    #[test]
    fn inputs_are_followed() {
        let t: Vec<f64> = (0..100).map(f64::from).collect();
        let request = json!({ "model": "sr108",
            "inputs": { "t_s": t, "delta_rad": vec![0.1; 100], "start": { "u_m_s": 10.0 } } });
        let run = ask("sr108", request).unwrap();
        assert!(run["stopped"].is_null());
        assert!(run["trajectory"]["psi_rad"][99].as_f64().unwrap() > 0.1);
        assert_eq!(run["trajectory"]["t_s"].as_array().unwrap().len(), 100);
    }

    #[test]
    fn a_horizon_has_the_foundation_and_the_band_under_orders_to_come() {
        let orders = json!([{ "t_s": 0, "delta_rad": 0.2 }, { "t_s": 15.0, "delta_rad": -0.2 }]);
        let request = |horizon: Value| json!({ "model": "m", "horizon": horizon });
        let asked =
            json!({ "start": { "u_m_s": 7.0 }, "orders": orders, "duration_s": 30, "dt_s": 1 });
        let ahead = ask("mariner", request(asked)).unwrap();
        let heading = ahead["trajectory"]["psi_rad"].as_array().unwrap();
        let (reached, end) = (heading[15].as_f64().unwrap(), heading[30].as_f64().unwrap());
        assert_eq!(heading.len(), 31);
        assert!(reached > 0.01 && ahead["trajectory"]["delta_rad"][30].as_f64().unwrap() < 0.0);
        assert!(end.is_finite() && ahead["band"].is_null());
        assert_eq!(ahead["foundation"], ahead["trajectory"]);
        let field = |horizon: Value| ask("mariner", request(horizon)).map_err(field).unwrap_err();
        let late = json!([{ "t_s": 3 }, { "t_s": 3 }]);
        assert_eq!(field(json!({ "orders": late, "duration_s": 9 })), "horizon.orders[1].t_s");
        assert_eq!(field(json!({ "duration_s": 1e7 })), "horizon.duration_s");
        assert_eq!(field(json!({ "duration_s": 9, "draws": 10 })), "horizon.draws");
        assert_eq!(field(json!({ "duration_s": 9, "start": { "u_m_s": 1e9 } })), "horizon.start");
    }

    #[test]
    fn impossible_requests_are_refused_by_field() {
        let field = |request: Value| ask("mariner", request).map_err(field).unwrap_err();
        let inputs = |t: Value, delta: Value| {
            json!({ "model": "m",
                "inputs": { "t_s": t, "delta_rad": delta, "start": { "u_m_s": 8.0 } } })
        };
        assert_eq!(field(json!({ "model": "m" })), "manoeuvre");
        assert_eq!(
            field(json!({ "model": "m", "manoeuvre": { "turn_deg": 35, "all": true } })),
            "manoeuvre"
        );
        assert_eq!(
            field(json!({ "model": "m", "manoeuvre": { "turn_deg": 135 } })),
            "manoeuvre.turn_deg"
        );
        assert_eq!(
            field(json!({ "model": "m", "manoeuvre": { "turn_deg": 35, "speed_m_s": 1e-6 } })),
            "manoeuvre.speed_m_s"
        );
        assert_eq!(field(inputs(json!([0, 1, 2]), json!([0, 1]))), "inputs.delta_rad");
        assert_eq!(field(inputs(json!([0, 2, 1]), json!([0, 0, 0]))), "inputs.t_s");
        assert_eq!(field(inputs(json!([0, 1, 2, 3, 9]), json!([0, 0, 0, 0, 0]))), "inputs.t_s");
        assert_eq!(field(inputs(json!([0, 1e9]), json!([0, 0]))), "inputs.t_s");
    }
}
