//! Ship prepared for simulation: plant, steering gear, envelope and constant conditions.

use std::sync::Arc;

use sistership_formula::Expr;
use sistership_model::law::{Law, helm_value, set_actuators};
use sistership_model::manifest::VelocityFrame;
use sistership_model::validity::{Excursion, Region};
use sistership_model::{Model, Trial, particulars};

use crate::branch::{CorrectionInstant, CorrectionModel, attached_correction};
use crate::envelope::MotionEnvelope;
use crate::equations::{CoefficientBinding, EquationsOfMotion, PlantError};
use crate::gear::SteeringGear;
use crate::instruments::{InstrumentModel, invert_readings};
use crate::integrate::Method;
use crate::plant::{LawInputs, MAX_INPUTS, Plant, PlantWorkspace};
use crate::state::{LaneStates, StateVector, Trajectory, at, lane_of};
use crate::tape::LaneValues;
use crate::validity::find_excursion;

/// Order to rudder and propeller at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HelmOrder {
    /// Rudder, rad, positive turns to starboard.
    pub delta_rad: f64,
    /// Propeller revolutions, 1/s.
    pub n_rps: f64,
}

/// Ship prepared for simulation.
#[derive(Debug)]
pub struct Ship {
    plant: Plant,
    gear: SteeringGear,
    envelope: MotionEnvelope,
    template: LawInputs,
    slots: InputSlots,
    /// Places of the inputs that follow helm and revolutions by a formula.
    helm_inputs: Vec<(usize, Expr)>,
    follows_helm: bool,
    follows_revolutions: bool,
    lpp_m: f64,
    approach_speed_m_s: f64,
    approach_n_rps: f64,
    revolutions_loss: f64,
    /// Instruments for velocities over the ground, and through the water.
    instruments: [Option<InstrumentModel>; 2],
    /// Range covered by the model's trials.
    validity: Option<Region>,
    /// Learned correction of the law.
    branch: Option<Arc<dyn CorrectionModel>>,
}

/// Places of the velocities that a learned correction changes.
const VELOCITIES: [usize; 3] = [at::U, at::V, at::R];

/// Places of the inputs that change during a run.
#[derive(Debug, Clone, Copy)]
struct InputSlots {
    delta: Option<usize>,
    n: Option<usize>,
    depth: Option<usize>,
}

impl Ship {
    /// Prepares a model with its learned correction.
    ///
    /// # Errors
    /// The errors of [`Plant::new`]; also an error if the model has no length or no approach speed,
    /// or if the weights of its learned correction have not been attached.
    pub fn new(model: &Model, law: &Law) -> Result<Self, PlantError> {
        let branch = attached_correction(model)?;
        let equations = EquationsOfMotion::from_foundation(model, law)?;
        Ok(Self { branch, ..Self::from_equations(&equations, CoefficientBinding::Values)? })
    }

    /// Prepares a model as [`Ship::new`] does, for ships whose coefficients are given with each
    /// simulation: those of the model are not read.
    ///
    /// # Errors
    /// The errors of [`Ship::new`].
    pub fn with_open_coefficients(model: &Model, law: &Law) -> Result<Self, PlantError> {
        let branch = attached_correction(model)?;
        let equations = EquationsOfMotion::from_foundation(model, law)?;
        Ok(Self { branch, ..Self::from_equations(&equations, CoefficientBinding::Names)? })
    }

    fn from_equations(
        equations: &EquationsOfMotion<'_>,
        coefficients: CoefficientBinding,
    ) -> Result<Self, PlantError> {
        let plant = Plant::from_equations(equations, coefficients)?;
        let (model, law) = (equations.model(), equations.law());
        let instruments = |frame| InstrumentModel::new(equations, frame);
        let instruments = [instruments(VelocityFrame::Ground)?, instruments(VelocityFrame::Water)?];
        let need = |name: &str, value: Option<f64>| {
            value.ok_or_else(|| PlantError::Missing {
                law: law.name.clone(),
                name: name.into(),
                model: model.name.clone(),
            })
        };
        let lpp_m = need("lpp_m", particulars::particular_value(&model.particulars, "lpp_m"))?;
        // The service speed replaces an approach speed that the model does not give.
        let service = particulars::particular_value(&model.particulars, "service_speed_m_s");
        let speed = need("speed_m_s", model.speed_m_s.or(service))?;
        let place = |name: &str| plant.input_names().iter().position(|known| known == name);
        let slots = InputSlots { delta: place("delta"), n: place("n"), depth: place("depth") };
        // Inputs that no run changes keep the defaults of the law.
        let mut template = [0.0; MAX_INPUTS];
        for (value, default) in template.iter_mut().zip(plant.input_defaults()) {
            *value = default.unwrap_or(0.0);
        }
        let envelope = MotionEnvelope::new(lpp_m, speed);
        let domain = model.branch.as_ref().map(|branch| &branch.domain);
        let approach_n_rps = model.revolutions_rps.unwrap_or(0.0);
        // The lag and the dead band of the rudder are part of the steering gear.
        let of_rudder = |figures: &[(usize, f64)]| {
            let found = figures.iter().find(|(place, _)| Some(*place) == slots.delta);
            found.map_or(0.0, |&(_, figure)| figure)
        };
        let (lag_s, band_rad) = (of_rudder(plant.input_lags_s()), of_rudder(plant.dead_bands()));
        Ok(Self {
            gear: SteeringGear::new(&model.steering).with_lag(lag_s).with_band(band_rad),
            plant,
            instruments,
            envelope,
            template,
            slots,
            helm_inputs: law.helm_inputs().map(|(place, _, of)| (place, of.clone())).collect(),
            follows_helm: law.follows_helm(),
            follows_revolutions: law.follows_revolutions(),
            lpp_m,
            approach_speed_m_s: speed,
            approach_n_rps,
            revolutions_loss: model.revolutions_loss.unwrap_or(0.0),
            // If the range of the foundation's trials is unknown, the domain of the correction is
            // used, so that runs report where the correction fades out.
            validity: model.validity.as_ref().or(domain).cloned(),
            branch: None,
        })
    }

    /// Learned correction of the law, if any.
    pub fn learned_correction(&self) -> Option<&dyn CorrectionModel> {
        self.branch.as_deref()
    }

    /// Sets the water depth, m, for laws that have it as an input.
    pub fn set_depth(&mut self, depth_m: f64) {
        if let Some(slot) = self.slots.depth {
            self.template[slot] = depth_m;
        }
    }

    /// Length between perpendiculars, m.
    pub fn lpp_m(&self) -> f64 {
        self.lpp_m
    }

    /// Approach speed of the model, m/s.
    pub fn approach_speed_m_s(&self) -> f64 {
        self.approach_speed_m_s
    }

    /// Greatest speed ahead that the trials cover, at least that of the approach, m/s.
    pub fn greatest_speed_m_s(&self) -> f64 {
        let covered = self.validity.as_ref().and_then(|region| region.ranges.get("u"));
        covered.map_or(self.approach_speed_m_s, |[_, most]| most.max(self.approach_speed_m_s))
    }

    /// Revolutions of a steady approach at a speed, proportional to those of the model, 1/s.
    pub fn revolutions_at(&self, speed_m_s: f64) -> f64 {
        self.approach_n_rps * speed_m_s / self.approach_speed_m_s
    }

    /// Share of the revolutions that the engine loses by the share of the speed that is lost.
    pub fn revolutions_loss(&self) -> f64 {
        self.revolutions_loss
    }

    /// Returns true if the law has revolutions as an input.
    pub fn has_propeller(&self) -> bool {
        self.slots.n.is_some()
    }

    /// Returns true if the law has a rudder angle as an input.
    pub fn has_rudder(&self) -> bool {
        self.slots.delta.is_some()
    }

    /// Returns true if an ordered helm acts on the ship, by a rudder or by other actuators.
    pub fn follows_helm(&self) -> bool {
        self.follows_helm
    }

    /// Returns true if ordered revolutions act on the ship, by one propeller or by several.
    pub fn follows_revolutions(&self) -> bool {
        self.follows_revolutions
    }

    /// Returns true for a 4-DOF law, which has roll.
    pub fn has_roll(&self) -> bool {
        self.plant.has_roll()
    }

    /// Inputs of the law with their defaults.
    pub fn law_inputs(&self) -> impl Iterator<Item = (&str, Option<f64>)> {
        self.plant
            .input_names()
            .iter()
            .map(String::as_str)
            .zip(self.plant.input_defaults().iter().copied())
    }

    /// Coefficients and parameters of another model in the order of the open ones; `None` if its
    /// names are not those of this ship.
    pub fn open_coefficient_values(&self, model: &Model) -> Option<Vec<f64>> {
        let names = self.plant.open_coefficients();
        let is_known = model.coefficients.keys().all(|name| names.contains(name));
        let value = |name: &String| model.named_value(name).map(|quantity| quantity.value);
        is_known.then(|| names.iter().map(value).collect()).flatten()
    }

    /// Number of inputs of the law.
    pub(crate) fn input_count(&self) -> usize {
        self.plant.input_names().len()
    }

    /// Returns true if some instrument differs from the true state.
    pub(crate) fn reads_instruments(&self) -> bool {
        self.instruments.iter().any(Option::is_some)
    }

    /// Inputs with a lag: place among the inputs and time constant, s.
    pub fn input_lags_s(&self) -> &[(usize, f64)] {
        self.plant.input_lags_s()
    }

    /// Half widths of the dead bands of inputs, with the place among the inputs.
    pub fn dead_bands(&self) -> &[(usize, f64)] {
        self.plant.dead_bands()
    }

    /// Readings of the instruments at a state; `inputs` as in [`Ship::rate_with`].
    pub fn instrument_readings(
        &self,
        frame: VelocityFrame,
        state: &StateVector,
        inputs: &LawInputs,
        work: &mut PlantWorkspace,
    ) -> StateVector {
        // Instruments are indexed by the frame: ground, then water.
        let Some(instruments) = &self.instruments[frame as usize] else { return *state };
        let rate = self.rate_with(state, inputs, work);
        instruments.read_state(
            state,
            &rate,
            &inputs[..self.plant.input_names().len()],
            &mut work.instruments,
        )
    }

    /// Returns the true state for the readings `said`.
    pub fn true_state(
        &self,
        frame: VelocityFrame,
        said: &StateVector,
        inputs: &LawInputs,
        work: &mut PlantWorkspace,
    ) -> StateVector {
        if self.instruments[frame as usize].is_none() {
            return *said;
        }
        invert_readings(said, |state| self.instrument_readings(frame, state, inputs, work))
    }

    /// Returns the excursion of a motion from the range covered by the model's trials; `None` if it
    /// stays inside, or if that range is unknown.
    pub fn find_excursion(&self, track: &Trajectory) -> Option<Excursion> {
        find_excursion(self.validity.as_ref()?, track)
    }

    /// Disables the check of excursions from the range covered by the model's trials.
    pub fn disable_excursions(&mut self) {
        self.validity = None;
    }

    /// Limits outside which runs are stopped.
    pub fn envelope(&self) -> &MotionEnvelope {
        &self.envelope
    }

    /// Steering gear, including the lag that effects add.
    pub fn steering_gear(&self) -> SteeringGear {
        self.gear
    }

    /// Widens the limits to those of a run at another speed.
    pub fn set_envelope_speed(&mut self, speed_m_s: f64) {
        self.envelope =
            MotionEnvelope::new(self.lpp_m, speed_m_s.abs().max(self.approach_speed_m_s));
    }

    /// Returns the inputs for a helm angle and revolutions.
    pub fn inputs_for(&self, delta_rad: f64, n_rps: f64) -> LawInputs {
        let mut inputs = self.template;
        self.set_orders(&mut inputs, delta_rad, n_rps);
        inputs
    }

    /// Sets in a record of ordered helm and revolutions the channels of the actuators that follow
    /// them.
    pub fn set_actuators(&self, record: &mut Trial) {
        let names = self.plant.input_names();
        let helms = self.helm_inputs.iter().map(|(place, helm)| (names[*place].as_str(), helm));
        set_actuators(helms, record);
    }

    /// Sets the inputs that follow a helm angle and revolutions; the others stay.
    fn set_orders(&self, inputs: &mut LawInputs, delta_rad: f64, n_rps: f64) {
        for (place, helm) in &self.helm_inputs {
            inputs[*place] = helm_value(helm, delta_rad, n_rps);
        }
        for (slot, value) in [(self.slots.delta, delta_rad), (self.slots.n, n_rps)] {
            if let Some(slot) = slot {
                inputs[slot] = value;
            }
        }
    }

    /// Rate of change of the state with the steering gear following `order`.
    pub fn rate_under(
        &self,
        state: &StateVector,
        order: HelmOrder,
        step_s: f64,
        work: &mut PlantWorkspace,
    ) -> StateVector {
        let inputs = self.inputs_for(state[at::DELTA], order.n_rps);
        let mut rate = self.rate_with(state, &inputs, work);
        rate[at::DELTA] = self.gear.rudder_rate(order.delta_rad, state[at::DELTA], step_s);
        rate
    }

    /// Rate of change of the state at a recorded rudder angle.
    pub fn rate_at(
        &self,
        state: &StateVector,
        delta_rad: f64,
        n_rps: f64,
        work: &mut PlantWorkspace,
    ) -> StateVector {
        self.rate_with(state, &self.inputs_for(delta_rad, n_rps), work)
    }

    /// Rate of change of the state with all inputs of the law, in the order of
    /// [`Ship::law_inputs`].
    pub fn rate_with(
        &self,
        state: &StateVector,
        inputs: &LawInputs,
        work: &mut PlantWorkspace,
    ) -> StateVector {
        let mut rate = self.plant.state_rate(state, inputs, work);
        // A learned correction takes the rates of the foundation as inputs.
        if let Some(branch) = &self.branch {
            let added =
                branch.rate_additions(&self.correction_inputs(state, &|slot| inputs[slot], &rate));
            VELOCITIES.into_iter().zip(added).for_each(|(place, added)| rate[place] += added);
        }
        rate
    }

    /// Returns the inputs of a learned correction; `input` returns the input of the law at a place.
    pub fn correction_inputs(
        &self,
        state: &StateVector,
        input: &dyn Fn(usize) -> f64,
        foundation: &StateVector,
    ) -> CorrectionInstant {
        let at_slot = |slot: Option<usize>| slot.map_or(0.0, input);
        CorrectionInstant {
            velocities: VELOCITIES.map(|place| state[place]),
            delta_rad: at_slot(self.slots.delta),
            n_rps: at_slot(self.slots.n),
            accelerations: VELOCITIES.map(|place| foundation[place]),
        }
    }

    /// Rates of change of several states, each with all inputs of the law.
    pub(crate) fn state_rates<const N: usize>(
        &self,
        states: &LaneStates<N>,
        inputs: &[LaneValues<N>],
        work: &mut PlantWorkspace<N>,
    ) -> LaneStates<N> {
        let mut rates = self.plant.state_rates(states, inputs, work);
        if let Some(branch) = &self.branch {
            // Each lane is evaluated by itself, so that a result does not depend on the other
            // lanes.
            for lane in 0..N {
                let input = |slot: usize| inputs[slot][lane];
                let (state, own) = (lane_of(states, lane), lane_of(&rates, lane));
                let added = branch.rate_additions(&self.correction_inputs(&state, &input, &own));
                VELOCITIES
                    .into_iter()
                    .zip(added)
                    .for_each(|(place, added)| rates[place][lane] += added);
            }
        }
        rates
    }

    /// Rate at which the steering gear moves the rudder towards the order, rad/s.
    pub(crate) fn rudder_rate(&self, order_rad: f64, angle_rad: f64, step_s: f64) -> f64 {
        self.gear.rudder_rate(order_rad, angle_rad, step_s)
    }
}

/// Settings of a run.
#[derive(Debug, Clone, Copy)]
pub struct RunSettings {
    /// State at time zero.
    pub start: StateVector,
    /// Duration, s.
    pub duration_s: f64,
    /// Step, s.
    pub step_s: f64,
    /// Integration method.
    pub method: Method,
}
