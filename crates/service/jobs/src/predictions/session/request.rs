//! Requests of sessions.

use std::collections::BTreeMap;

use serde::Deserialize;
use sistership_model::environment::PredictionEnvironment;
use sistership_request_types::{
    DrawCount, ModelName, Positive, StepCount, StepLength, WaterSpeed, WindSpeed,
};
use utoipa::ToSchema;

use crate::predictions::inputs::InitialState;

/// Request for a new session.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct SessionRequest {
    /// `ship` (its champion), `ship/number` or `ship/alias`.
    #[schema(inline)]
    pub model: ModelName,
    /// Position and motion over the ground; by default straight ahead to the north at the model's
    /// approach speed.
    pub(crate) start: Option<InitialState>,
    /// Rudder angle at the start, positive to starboard.
    #[serde(default)]
    pub(crate) delta_rad: f64,
    /// Water depth for laws with a depth, m; deep water by default.
    #[schema(inline)]
    pub(crate) depth_m: Option<Positive>,
    /// A steady current.
    pub(crate) current: Option<CurrentRequest>,
    /// A steady wind.
    pub(crate) wind: Option<WindRequest>,
    /// Number of models drawn from the posterior of a refined model, which are simulated in
    /// parallel and give the band; by default none.
    #[schema(inline)]
    pub(crate) draws: Option<DrawCount>,
    /// Seed of the draws; default 1.
    pub(crate) seed: Option<u64>,
}

/// A steady current.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct CurrentRequest {
    #[schema(inline)]
    speed_m_s: WaterSpeed,
    /// Direction to which it flows, clockwise from north.
    towards_rad: f64,
}

/// A steady wind.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct WindRequest {
    #[schema(inline)]
    speed_m_s: WindSpeed,
    /// Direction from which it comes, clockwise from north.
    from_rad: f64,
}

impl SessionRequest {
    /// Wind, current and depth of the request.
    pub(super) fn environment(&self) -> PredictionEnvironment {
        PredictionEnvironment {
            wind_speed_m_s: self.wind.map(|wind| wind.speed_m_s.get()),
            current_speed_m_s: self.current.map(|current| current.speed_m_s.get()),
            depth_m: self.depth_m.map(Positive::get),
        }
    }
}

impl CurrentRequest {
    /// Components to north and east, m/s.
    pub(super) fn components(self) -> [f64; 2] {
        direction_components(self.speed_m_s.get(), self.towards_rad)
    }
}

impl WindRequest {
    /// Components from north and east, m/s.
    pub(super) fn components(self) -> [f64; 2] {
        direction_components(self.speed_m_s.get(), self.from_rad)
    }
}

fn direction_components(speed: f64, direction_rad: f64) -> [f64; 2] {
    let (sin, cos) = direction_rad.sin_cos();
    [speed * cos, speed * sin]
}

/// Steps to simulate.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct StepsRequest {
    /// Orders of the bridge from now on; by default unchanged.
    #[serde(default)]
    pub(super) orders: OrdersRequest,
    /// Length of a step, s; a long one is integrated in several parts.
    #[schema(inline)]
    pub(super) dt_s: StepLength,
    /// Number of steps; default 1.
    #[schema(inline)]
    pub(super) steps: Option<StepCount>,
}

/// Orders; those that are not given stay unchanged.
#[derive(Debug, Default, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct OrdersRequest {
    /// Ordered rudder angle, which the steering gear follows within its limit and at its rate.
    pub(super) delta_rad: Option<f64>,
    /// Propeller revolutions.
    pub(super) n_rps: Option<f64>,
    /// Other inputs of the law by name, such as that of a thruster.
    #[serde(default)]
    pub(super) inputs: BTreeMap<String, f64>,
}

impl StepsRequest {
    /// Number of steps.
    pub(super) fn step_count(&self) -> usize {
        usize::try_from(self.steps.unwrap_or_default().get()).unwrap_or(1)
    }
}
