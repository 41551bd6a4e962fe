//! What is asked of a session.

use std::collections::BTreeMap;

use serde::Deserialize;
use sistership_model::environment::Environment;
use sistership_request_types::{
    DrawCount, ModelName, Positive, StepCount, StepLength, WaterSpeed, WindSpeed,
};
use utoipa::ToSchema;

use crate::predictions::inputs::InitialState;

/// A ship that is to be under way.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct SessionRequest {
    /// `ship` (its champion), `ship/number` or `ship/alias`.
    #[schema(inline)]
    pub model: ModelName,
    /// Where it is, and how it moves over the ground; straight ahead to the north at the model's
    /// approach speed where absent.
    pub(crate) start: Option<InitialState>,
    /// Its rudder angle at the start, positive to starboard.
    #[serde(default)]
    pub(crate) delta_rad: f64,
    /// Water depth for laws that know it, m; deep where absent.
    #[schema(inline)]
    pub(crate) depth_m: Option<Positive>,
    /// A steady current.
    pub(crate) current: Option<CurrentRequest>,
    /// A steady wind.
    pub(crate) wind: Option<WindRequest>,
    /// Models drawn from the posterior of a refined one, which sail beside it and give the band;
    /// none where absent.
    #[schema(inline)]
    pub(crate) draws: Option<DrawCount>,
    /// What the draws follow from; 1 where absent.
    pub(crate) seed: Option<u64>,
}

/// A steady current.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct CurrentRequest {
    #[schema(inline)]
    speed_m_s: WaterSpeed,
    /// Where it goes, clockwise from north.
    towards_rad: f64,
}

/// A steady wind.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct WindRequest {
    #[schema(inline)]
    speed_m_s: WindSpeed,
    /// Where it comes from, clockwise from north.
    from_rad: f64,
}

impl SessionRequest {
    /// The surroundings that are asked for.
    pub(super) fn environment(&self) -> Environment {
        Environment {
            wind_speed_m_s: self.wind.map(|wind| wind.speed_m_s.get()),
            current_speed_m_s: self.current.map(|current| current.speed_m_s.get()),
            depth_m: self.depth_m.map(Positive::get),
        }
    }
}

impl CurrentRequest {
    /// To north and east, m/s.
    pub(super) fn parts(self) -> [f64; 2] {
        parts(self.speed_m_s.get(), self.towards_rad)
    }
}

impl WindRequest {
    /// From north and east, m/s.
    pub(super) fn parts(self) -> [f64; 2] {
        parts(self.speed_m_s.get(), self.from_rad)
    }
}

fn parts(speed: f64, direction_rad: f64) -> [f64; 2] {
    let (sin, cos) = direction_rad.sin_cos();
    [speed * cos, speed * sin]
}

/// Steps to sail.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct StepsRequest {
    /// What the bridge orders from now on; as before where absent.
    #[serde(default)]
    pub(super) orders: OrdersRequest,
    /// The length of a step, s; a long one is integrated in parts.
    #[schema(inline)]
    pub(super) dt_s: StepLength,
    /// How many; 1 where absent.
    #[schema(inline)]
    pub(super) steps: Option<StepCount>,
}

/// Orders; what is not given stays as it is.
#[derive(Debug, Default, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct OrdersRequest {
    /// The rudder angle that the steering gear follows, within its limit and at its rate.
    pub(super) delta_rad: Option<f64>,
    /// Propeller revolutions.
    pub(super) n_rps: Option<f64>,
    /// Other inputs of the law by their names, such as a thruster's.
    #[serde(default)]
    pub(super) inputs: BTreeMap<String, f64>,
}

impl StepsRequest {
    /// How many steps.
    pub(super) fn count(&self) -> usize {
        usize::try_from(self.steps.unwrap_or_default().get()).unwrap_or(1)
    }
}
