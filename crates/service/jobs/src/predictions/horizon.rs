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
        let steps = self.count_steps()?;
        let asked = self.session_request(name, depth_m);
        let mut session = PredictionSession::new(&asked, model, law).map_err(in_horizon)?;
        session.reserve_memory(self.dt_s(), steps, most).map_err(in_horizon)?;
        let mut answer = self.simulate_steps(&mut session, steps);
        answer["foundation"] = match model.branch {
            None => answer["trajectory"].clone(),
            Some(_) => {
                let alone = Model { branch: None, ..model.clone() };
                // The foundation is drawn as a line without band.
                let asked = SessionRequest { draws: None, ..asked };
                let mut foundation =
                    PredictionSession::new(&asked, &alone, law).map_err(in_horizon)?;
                self.simulate_steps(&mut foundation, steps)["trajectory"].take()
            }
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
            let message = "must be later than that of the orders before";
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
                    "would take {steps:.0} samples, at most {MAX_SAMPLES} are made: a longer `dt_s`"
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
