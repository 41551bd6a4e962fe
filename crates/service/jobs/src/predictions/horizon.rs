//! Prediction over a horizon from now on: the simulation of the foundation model under given
//! orders, that with the learned correction, and the band of the posterior (Kanazawa 2023, sec.
//! 3.1; the correction is evaluated at every step, where the paper evaluates one network once).

use serde::Deserialize;
use serde_json::Value;
use sistership_model::{Law, Model};
use sistership_request_types::{DrawCount, ModelName, Positive, StepLength};
use utoipa::ToSchema;

use crate::predictions::error::{PredictionError, Result};
use crate::predictions::inputs::InitialState;
use crate::predictions::session::{CurrentRequest, PredictionSession, SessionRequest, WindRequest};
use crate::predictions::track::reserve_steps;

/// Horizon, with the orders within it.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct HorizonRequest {
    /// Position and motion over the ground; by default straight ahead to the north at the model's
    /// approach speed.
    start: Option<InitialState>,
    /// Rudder angle now, positive to starboard.
    #[serde(default)]
    delta_rad: f64,
    /// Orders to come, in order of time. Until the first, the rudder stays and the revolutions are
    /// those of the present speed.
    #[serde(default)]
    #[schema(max_items = 10_000)]
    orders: Vec<TimedOrders>,
    /// Length of the horizon, s.
    #[schema(inline)]
    duration_s: Positive,
    /// Time between samples, s; default 0.5.
    #[schema(inline)]
    dt_s: Option<StepLength>,
    /// A steady current.
    current: Option<CurrentRequest>,
    /// A steady wind.
    wind: Option<WindRequest>,
    /// Number of models drawn from the posterior of a refined model, for the band; by default none.
    #[schema(inline)]
    draws: Option<DrawCount>,
    /// Seed of the draws; default 1.
    seed: Option<u64>,
}

/// Orders from a time on.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct TimedOrders {
    /// Time from now, s.
    t_s: f64,
    /// Ordered rudder angle, which the steering gear follows; by default unchanged.
    delta_rad: Option<f64>,
    /// Propeller revolutions; by default unchanged.
    n_rps: Option<f64>,
}

/// Default time between samples, s.
const DT_S: f64 = 0.5;
/// Largest number of samples of a horizon.
const MAX_SAMPLES: usize = 10_000;

impl HorizonRequest {
    /// Simulates the horizon in at most `most` steps of all models together.
    pub(crate) fn simulate_horizon(
        &self,
        (name, depth_m): (&ModelName, Option<Positive>),
        model: &Model,
        law: &Law,
        most: usize,
    ) -> Result<Value> {
        let (dt_s, steps) = (self.dt_s(), self.count_steps()?);
        let asked = self.session_request(name, depth_m);
        let mut session = PredictionSession::new(&asked, model, law).map_err(in_horizon)?;
        let mut foundation = foundation_session(asked, model, law)?;
        // Before anything is simulated, and of both together: they use the same limits.
        let models = std::iter::once(&session).chain(&foundation);
        let integrated = models.map(|model| model.integration_steps(dt_s, steps)).sum();
        reserve_steps("steps", integrated, most).map_err(in_horizon)?;
        let mut answer = self.simulate_steps(&mut session, steps);
        answer["foundation"] = match &mut foundation {
            None => answer["trajectory"].clone(),
            Some(foundation) => self.simulate_steps(foundation, steps)["trajectory"].take(),
        };
        answer["metrics"] = Value::Null;
        Ok(answer)
    }

    fn dt_s(&self) -> f64 {
        self.dt_s.map_or(DT_S, StepLength::get)
    }

    /// Checks that the orders are in order of time, and returns the number of steps.
    fn count_steps(&self) -> Result<usize> {
        if let Some(at) = self.orders.windows(2).position(|pair| pair[1].t_s <= pair[0].t_s) {
            let message = "must be later than that of the previous orders";
            return Err(PredictionError::invalid_field(
                &format!("horizon.orders[{}].t_s", at + 1),
                message,
            ));
        }
        let steps = (self.duration_s.get() / self.dt_s()).round().max(1.0);
        match steps <= MAX_SAMPLES as f64 {
            true => Ok(steps as usize),
            false => Err(PredictionError::invalid_field(
                "horizon.duration_s",
                format!(
                    "needs {steps:.0} samples, but at most {MAX_SAMPLES} are possible; give a \
                     longer `dt_s`"
                ),
            )),
        }
    }

    fn session_request(&self, name: &ModelName, depth_m: Option<Positive>) -> SessionRequest {
        SessionRequest {
            model: name.clone(),
            start: self.start,
            delta_rad: self.delta_rad,
            depth_m,
            current: self.current,
            wind: self.wind,
            draws: self.draws,
            seed: self.seed,
        }
    }

    /// Simulates the steps, each under the latest orders at its start.
    fn simulate_steps(&self, session: &mut PredictionSession, steps: usize) -> Value {
        let dt_s = self.dt_s();
        let mut samples = vec![session.current_sample()];
        let mut coming = self.orders.iter().peekable();
        for step in 0..steps {
            // The small fraction of a step makes orders at a sample time robust to rounding.
            let now_s = (step as f64 + 1e-9) * dt_s;
            while let Some(one) = coming.next_if(|one| one.t_s <= now_s) {
                session.set_orders(one.delta_rad, one.n_rps);
            }
            // The track ends where the motion leaves the physical range; the answer has the reason.
            let Some(sample) = session.simulate_step(dt_s) else { break };
            samples.push(sample);
        }
        session.samples_to_json(&samples)
    }
}

/// Creates the session of the foundation alone, which is drawn as a line without band; `None` for a
/// model that is its own foundation.
fn foundation_session(
    asked: SessionRequest,
    model: &Model,
    law: &Law,
) -> Result<Option<PredictionSession>> {
    if model.branch.is_none() {
        return Ok(None);
    }
    let alone = Model { branch: None, ..model.clone() };
    let asked = SessionRequest { draws: None, ..asked };
    PredictionSession::new(&asked, &alone, law).map(Some).map_err(in_horizon)
}

/// Prefixes a field with `horizon.`, except for the fields that are not part of the horizon.
fn in_horizon(error: PredictionError) -> PredictionError {
    match error {
        PredictionError::Field { field, message } if field != "model" => {
            let field = if field == "steps" { "duration_s" } else { &field };
            PredictionError::Field { field: format!("horizon.{field}"), message }
        }
        other => other,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::sync::Arc;

    use serde_json::json;
    use sistership_model::Zoo;
    use sistership_model::branch::{CorrectionDocument, CorrectionMode, CorrectionRecipe, Learner};
    use sistership_model::learned::{
        AdditionFormulas, AdditionGradient, AttachedWeights, CorrectionInstant, CorrectionModel,
    };
    use sistership_model::validity::Region;

    use super::*;

    /// A correction that adds nothing.
    #[derive(Debug)]
    struct NoAddition;

    impl CorrectionModel for NoAddition {
        fn rate_additions(&self, _: &CorrectionInstant) -> [f64; 3] {
            [0.0; 3]
        }

        fn addition_gradient(&self, _: &CorrectionInstant) -> AdditionGradient {
            AdditionGradient::default()
        }

        fn addition_formulas(&self) -> AdditionFormulas {
            AdditionFormulas::default()
        }

        fn active_share(&self, _: &CorrectionInstant) -> f64 {
            1.0
        }
    }

    /// The Mariner with that correction.
    fn corrected_model(zoo: &Zoo) -> Model {
        let columns = ["u", "v", "r"].map(|name| (name.to_owned(), vec![-1.0, 1.0]));
        let branch = CorrectionDocument {
            mode: CorrectionMode::Parallel,
            outputs: Vec::new(),
            weights_sha256: String::new(),
            domain: Region::from_samples(&columns.into()).unwrap(),
            fade: 1.0,
            recipe: CorrectionRecipe {
                learner: Learner::KernelRidge { centres: 1, length: 1.0, ridge: 1.0 },
                seed: 1,
                window_s: 1.0,
                hop_s: 1.0,
                trials: Vec::new(),
            },
            learned: AttachedWeights::new(Arc::new(NoAddition)),
        };
        Model { branch: Some(branch), ..zoo.find_model("mariner").unwrap() }
    }

    #[test]
    fn the_foundation_counts_within_the_limit_of_steps() {
        let zoo = Zoo::load_embedded().unwrap();
        let (model, law) = (corrected_model(&zoo), zoo.law("abkowitz").unwrap());
        let horizon: HorizonRequest =
            serde_json::from_value(json!({ "duration_s": 30, "dt_s": 1 })).unwrap();
        let name: ModelName = "mariner".parse().unwrap();
        // 300 steps of 0.1 s for each of the two models.
        let answer = horizon.simulate_horizon((&name, None), &model, law, 600).unwrap();
        assert_eq!(answer["foundation"]["t_s"].as_array().unwrap().len(), 31);
        match horizon.simulate_horizon((&name, None), &model, law, 599) {
            Err(PredictionError::Field { field, .. }) => assert_eq!(field, "horizon.duration_s"),
            other => panic!("{other:?}"),
        }
    }
}
