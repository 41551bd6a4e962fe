//! Start of a session: the model in its environment, and the draws.

use crate::surroundings::steady;
use sistership_assessment::uncertainty::{Sampling, draws};
use sistership_model::{Law, Model};
use sistership_simulation::plant::Work;
use sistership_simulation::state::{at, speed, straight};
use sistership_simulation::{Order, Ship, SideBySide, StateVector};

use super::request::SessionRequest;
use super::under_way::{Beside, Session};
use crate::predictions::error::{PredictError, Result};
use crate::predictions::track::STEP_S;

impl Session {
    /// Creates a session.
    ///
    /// # Errors
    /// Returns an error that names the invalid field of the request.
    pub fn new(request: &SessionRequest, model: &Model, law: &Law) -> Result<Self> {
        // Computed before wind and current are added to the model as effects.
        let uncovered = request.environment().uncovered(model);
        let mut model = model.clone();
        let named = [
            ("current", request.current.map(|current| current.parts())),
            ("wind", request.wind.map(|wind| wind.parts())),
        ];
        for (name, parts) in named {
            let Some(parts) = parts else { continue };
            let none = || PredictError::invalid(name, "the library has no steady form of it");
            model.effects.push(steady(name, parts, "session").ok_or_else(none)?);
        }
        let ship = Ship::new(&model, law).map_err(refused)?;
        let state = request.state(&ship);
        let ship = ready(ship, request, &state)?;
        let beside = request.beside(&model, law, &state)?;
        // The faster of both, so that the step is short enough after an acceleration, too.
        let approach = speed(&state).max(ship.approach_speed_m_s());
        let order =
            Order { delta_rad: request.delta_rad, n_rps: ship.revolutions_at(speed(&state)) };
        Ok(Self {
            // At least 50 steps for the time of one ship length.
            longest_s: STEP_S.min(0.02 * ship.lpp_m() / approach),
            ship,
            beside,
            state,
            order,
            uncovered,
            others: Vec::new(),
            t_s: 0.0,
            stopped: None,
            work: Work::default(),
        })
    }
}

impl SessionRequest {
    fn state(&self, ship: &Ship) -> StateVector {
        let given = self.start.as_ref().map(crate::predictions::inputs::InitialState::state);
        let mut state = given.unwrap_or_else(|| straight(ship.approach_speed_m_s()));
        // The rudder is a state, given apart from the motion.
        state[at::DELTA] = self.delta_rad;
        state
    }

    /// Creates the draws, in the same state.
    fn beside(&self, model: &Model, law: &Law, state: &StateVector) -> Result<Option<Beside>> {
        let Some(count) = self.draws else { return Ok(None) };
        let samples = usize::try_from(count.get()).unwrap_or(2);
        let seed = self.seed.unwrap_or(Sampling::default().seed);
        let none = || {
            PredictError::invalid(
                "draws",
                "the model has no posterior to draw from; only a refined one whose coefficients \
                 are those that were estimated has one",
            )
        };
        let drawn = draws(model, Sampling { samples, seed, ..Sampling::default() });
        let drawn = drawn.ok_or_else(none)?;
        let ship = ready(Ship::sisters(model, law).map_err(refused)?, self, state)?;
        // The draws share the tape of the law; only their coefficients differ.
        let sisters = drawn.iter().map(|one| ship.sister(one)).collect::<Option<Vec<_>>>();
        let sisters = SideBySide::new(&sisters.ok_or_else(none)?, state);
        Ok(Some(Beside { ship, sisters, drawn: drawn.len() }))
    }
}

/// Prepares the ship for its depth and start, and checks these.
fn ready(mut ship: Ship, request: &SessionRequest, state: &StateVector) -> Result<Ship> {
    if let Some(depth) = request.depth_m {
        ship.set_depth(depth.get());
    }
    if request.delta_rad.abs() > ship.gear().limit_rad() {
        let limit = ship.gear().limit_rad();
        let message = format!("is beyond the rudder's limit of {limit:.3} rad");
        return Err(PredictError::invalid("delta_rad", message));
    }
    // The physical range is that of the model: a state outside it is refused, not simulated.
    ship.envelope()
        .check(0.0, state)
        .map_err(|stopped| PredictError::invalid("start", stopped.reason))?;
    ship.set_envelope_speed(speed(state));
    Ok(ship)
}

fn refused(error: sistership_simulation::PlantError) -> PredictError {
    PredictError::invalid("model", error.to_string())
}
