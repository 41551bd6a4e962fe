//! Start of a session: the model in its environment, and the draws.

use crate::environment::steady_effect;
use sistership_assessment::uncertainty::{Sampling, draw_from_posterior};
use sistership_model::{Law, Model};
use sistership_simulation::plant::PlantWorkspace;
use sistership_simulation::state::{at, horizontal_speed, straight_state};
use sistership_simulation::{HelmOrder, Ship, ShipEnsemble, StateVector};

use super::request::SessionRequest;
use super::simulation::{PosteriorDraws, PredictionSession};
use crate::predictions::error::{PredictionError, Result};
use crate::predictions::track::STEP_S;

impl PredictionSession {
    /// Creates a session.
    ///
    /// # Errors
    /// Returns an error that names the invalid field of the request.
    pub fn new(request: &SessionRequest, model: &Model, law: &Law) -> Result<Self> {
        // Computed before wind and current are added to the model as effects.
        let uncovered = request.environment().uncovered_inputs(model);
        let mut model = model.clone();
        let named = [
            ("current", request.current.map(|current| current.components())),
            ("wind", request.wind.map(|wind| wind.components())),
        ];
        for (name, parts) in named {
            let Some(parts) = parts else { continue };
            let none = || {
                PredictionError::invalid_field(
                    name,
                    "the library of effects has no steady form of it",
                )
            };
            model.effects.push(steady_effect(name, parts, "session").ok_or_else(none)?);
        }
        let ship = Ship::new(&model, law).map_err(model_error)?;
        let state = request.initial_state(&ship);
        let ship = prepare_ship(ship, request, &state)?;
        let beside = request.create_draws(&model, law, &state)?;
        // The faster of both, so that the step is short enough after an acceleration, too.
        let approach = horizontal_speed(&state).max(ship.approach_speed_m_s());
        let order = HelmOrder {
            delta_rad: request.delta_rad,
            n_rps: ship.revolutions_at(horizontal_speed(&state)),
        };
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
            work: PlantWorkspace::default(),
        })
    }
}

impl SessionRequest {
    fn initial_state(&self, ship: &Ship) -> StateVector {
        let given = self.start.map(crate::predictions::inputs::InitialState::to_state_vector);
        let mut state = given.unwrap_or_else(|| straight_state(ship.approach_speed_m_s()));
        // The rudder is a state, given apart from the motion.
        state[at::DELTA] = self.delta_rad;
        state
    }

    /// Creates the draws, in the same state.
    fn create_draws(
        &self,
        model: &Model,
        law: &Law,
        state: &StateVector,
    ) -> Result<Option<PosteriorDraws>> {
        let Some(count) = self.draws else { return Ok(None) };
        let samples = usize::try_from(count.get()).unwrap_or(2);
        let seed = self.seed.unwrap_or(Sampling::default().seed);
        let none = || {
            PredictionError::invalid_field(
                "draws",
                "the model has no posterior to draw from; only a refined model with unchanged \
                 coefficients has one",
            )
        };
        let drawn = draw_from_posterior(model, Sampling { samples, seed });
        let drawn = drawn.ok_or_else(none)?;
        let ship = prepare_ship(
            Ship::with_open_coefficients(model, law).map_err(model_error)?,
            self,
            state,
        )?;
        // The draws share the tape of the law; only their coefficients differ.
        let sisters =
            drawn.iter().map(|one| ship.open_coefficient_values(one)).collect::<Option<Vec<_>>>();
        let sisters = ShipEnsemble::new(&sisters.ok_or_else(none)?, state);
        Ok(Some(PosteriorDraws { ship, sisters, drawn: drawn.len() }))
    }
}

/// Prepares the ship for its depth and start, and checks these.
fn prepare_ship(mut ship: Ship, request: &SessionRequest, state: &StateVector) -> Result<Ship> {
    if let Some(depth) = request.depth_m {
        ship.set_depth(depth.get());
    }
    if request.delta_rad.abs() > ship.steering_gear().limit_rad() {
        let limit = ship.steering_gear().limit_rad();
        let message = format!("is beyond the rudder's limit of {limit:.3} rad");
        return Err(PredictionError::invalid_field("delta_rad", message));
    }
    // The physical range is that of the model: a state outside it is refused, not simulated.
    ship.envelope()
        .check_state(0.0, state)
        .map_err(|stopped| PredictionError::invalid_field("start", stopped.reason))?;
    ship.set_envelope_speed(horizontal_speed(state));
    Ok(ship)
}

fn model_error(error: sistership_simulation::PlantError) -> PredictionError {
    PredictionError::invalid_field("model", error.to_string())
}
