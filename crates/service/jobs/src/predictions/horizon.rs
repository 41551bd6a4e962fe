//! Over a horizon from now on: what the foundation draws under orders to come, what a learned
//! branch makes of it, and the band of the posterior (Kanazawa 2023, sec. 3.1, with the branch in
//! every step where the paper asks one network once).

use serde::Deserialize;
use serde_json::Value;
use sistership_model::{Law, Model};
use sistership_request_types::{DrawCount, ModelName, Positive, StepLength};
use utoipa::ToSchema;

use crate::predictions::error::{PredictError, Result};
use crate::predictions::inputs::InitialState;
use crate::predictions::session::{CurrentRequest, Session, SessionRequest, WindRequest};

/// A horizon, and the orders within it.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct HorizonRequest {
    /// Where the ship is, and how it moves over the ground; straight ahead to the north at the
    /// model's approach speed where absent.
    start: Option<InitialState>,
    /// Its rudder angle now, positive to starboard.
    #[serde(default)]
    delta_rad: f64,
    /// Orders to come, in time; the rudder as it is and the revolutions of the speed now until the
    /// first.
    #[serde(default)]
    #[schema(max_items = 10_000)]
    orders: Vec<TimedOrders>,
    /// How far ahead, s.
    #[schema(inline)]
    duration_s: Positive,
    /// Time between samples; 0.5 s where absent.
    #[schema(inline)]
    dt_s: Option<StepLength>,
    /// A steady current.
    current: Option<CurrentRequest>,
    /// A steady wind.
    wind: Option<WindRequest>,
    /// Models drawn from the posterior of a refined one, for the band; none where absent.
    #[schema(inline)]
    draws: Option<DrawCount>,
    /// What the draws follow from; 1 where absent.
    seed: Option<u64>,
}

/// Orders from a time on.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct TimedOrders {
    /// Since now.
    t_s: f64,
    /// The rudder angle that the steering gear follows; as before where absent.
    delta_rad: Option<f64>,
    /// Propeller revolutions; as before where absent.
    n_rps: Option<f64>,
}

/// Time between samples where nobody says it, s.
const DT_S: f64 = 0.5;
/// Most samples of a horizon.
const SAMPLES: usize = 10_000;

impl HorizonRequest {
    /// Sails over the horizon; `most` bounds the work.
    pub(crate) fn sail(
        &self,
        (name, depth_m): (&ModelName, Option<Positive>),
        model: &Model,
        law: &Law,
        most: usize,
    ) -> Result<Value> {
        let steps = self.steps()?;
        let asked = self.session(name, depth_m);
        let mut session = Session::new(&asked, model, law).map_err(within)?;
        session.bounded(self.dt_s(), steps, most).map_err(within)?;
        let mut answer = self.sailed(&mut session, steps);
        answer["foundation"] = match model.branch {
            None => answer["trajectory"].clone(),
            Some(_) => {
                let alone = Model { branch: None, ..model.clone() };
                // Its band is not asked for.
                let asked = SessionRequest { draws: None, ..asked };
                let mut foundation = Session::new(&asked, &alone, law).map_err(within)?;
                self.sailed(&mut foundation, steps)["trajectory"].take()
            }
        };
        answer["metrics"] = Value::Null;
        Ok(answer)
    }

    fn dt_s(&self) -> f64 {
        self.dt_s.map_or(DT_S, StepLength::get)
    }

    /// The steps of the horizon, once its orders are in time.
    fn steps(&self) -> Result<usize> {
        if let Some(at) = self.orders.windows(2).position(|pair| pair[1].t_s <= pair[0].t_s) {
            let message = "must be later than that of the orders before";
            return Err(PredictError::invalid(&format!("horizon.orders[{}].t_s", at + 1), message));
        }
        let steps = (self.duration_s.get() / self.dt_s()).round().max(1.0);
        match steps <= SAMPLES as f64 {
            true => Ok(steps as usize),
            false => Err(PredictError::invalid(
                "horizon.duration_s",
                format!(
                    "would take {steps:.0} samples, at most {SAMPLES} are made: a longer `dt_s`"
                ),
            )),
        }
    }

    fn session(&self, name: &ModelName, depth_m: Option<Positive>) -> SessionRequest {
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

    /// Each step under the orders that were given last at its start.
    fn sailed(&self, session: &mut Session, steps: usize) -> Value {
        let dt_s = self.dt_s();
        let mut samples = vec![session.sample()];
        let mut coming = self.orders.iter().peekable();
        for step in 0..steps {
            let now_s = (step as f64 + 1e-9) * dt_s;
            while let Some(one) = coming.next_if(|one| one.t_s <= now_s) {
                session.order(one.delta_rad, one.n_rps);
            }
            let Some(sample) = session.step(dt_s) else { break };
            samples.push(sample);
        }
        session.answer(&samples)
    }
}

/// A fault of a field within `horizon`, but for those that stand beside it.
fn within(error: PredictError) -> PredictError {
    match error {
        PredictError::Field { field, message } if field != "model" => {
            let field = if field == "steps" { "duration_s" } else { &field };
            PredictError::Field { field: format!("horizon.{field}"), message }
        }
        other => other,
    }
}
