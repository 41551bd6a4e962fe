//! A ship ready to sail: plant, steering gear, envelope and what is held constant around it.

use std::sync::Arc;

use sistership_model::law::Law;
use sistership_model::manifest::VelocityFrame;
use sistership_model::validity::{Excursion, Region};
use sistership_model::{Model, particulars};

use crate::branch::{Instant, LearnedBranch, attached};
use crate::envelope::Envelope;
use crate::equations::{Coefficients, EquationsOfMotion, PlantError};
use crate::gear::Gear;
use crate::instruments::{Instruments, truth};
use crate::integrate::Method;
use crate::plant::{Inputs, MAX_INPUTS, Plant, Work};
use crate::state::{StateVector, States, Trajectory, at, lane_of};
use crate::tape::Lanes;
use crate::validity::leaves;

/// What the bridge orders at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Order {
    /// Rudder, rad, positive turns to starboard.
    pub delta_rad: f64,
    /// Propeller revolutions, 1/s.
    pub n_rps: f64,
}

/// A ship ready to sail.
#[derive(Debug)]
pub struct Ship {
    plant: Plant,
    gear: Gear,
    envelope: Envelope,
    template: Inputs,
    slots: Slots,
    lpp_m: f64,
    approach_speed_m_s: f64,
    approach_n_rps: f64,
    /// For velocities over the ground, and through the water.
    instruments: [Option<Instruments>; 2],
    /// What the model's trials covered.
    validity: Option<Region>,
    /// What was learned beside the law.
    branch: Option<Arc<dyn LearnedBranch>>,
}

/// Places of the velocities that a learned branch changes.
const VELOCITIES: [usize; 3] = [at::U, at::V, at::R];

/// Places of the inputs that change during a run.
#[derive(Debug, Clone, Copy)]
struct Slots {
    delta: Option<usize>,
    n: Option<usize>,
    depth: Option<usize>,
}

impl Ship {
    /// Makes a model ready, with what was learned beside its law.
    ///
    /// # Errors
    /// As [`Plant::new`]; also where the model has no length or no approach speed, or the weights
    /// of its learned branch have not been attached.
    pub fn new(model: &Model, law: &Law) -> Result<Self, PlantError> {
        let branch = attached(model)?;
        let equations = EquationsOfMotion::of_foundation(model, law)?;
        Ok(Self { branch, ..Self::of(&equations, Coefficients::Values)? })
    }

    /// As [`Ship::new`], for sisters whose coefficients are given with each passage: those of the
    /// model are not read.
    ///
    /// # Errors
    /// As [`Ship::new`].
    pub fn sisters(model: &Model, law: &Law) -> Result<Self, PlantError> {
        let branch = attached(model)?;
        let equations = EquationsOfMotion::of_foundation(model, law)?;
        Ok(Self { branch, ..Self::of(&equations, Coefficients::Names)? })
    }

    fn of(
        equations: &EquationsOfMotion<'_>,
        coefficients: Coefficients,
    ) -> Result<Self, PlantError> {
        let plant = Plant::of(equations, coefficients)?;
        let (model, law) = (equations.model(), equations.law());
        let instruments = |frame| Instruments::new(equations, frame);
        let instruments = [instruments(VelocityFrame::Ground)?, instruments(VelocityFrame::Water)?];
        let need = |name: &str, value: Option<f64>| {
            value.ok_or_else(|| PlantError::Missing {
                law: law.name.clone(),
                name: name.into(),
                model: model.name.clone(),
            })
        };
        let lpp_m = need("lpp_m", particulars::value(&model.particulars, "lpp_m"))?;
        let service = particulars::value(&model.particulars, "service_speed_m_s");
        let speed = need("speed_m_s", model.speed_m_s.or(service))?;
        let place = |name: &str| plant.input_names().iter().position(|known| known == name);
        let slots = Slots { delta: place("delta"), n: place("n"), depth: place("depth") };
        let mut template = [0.0; MAX_INPUTS];
        for (value, default) in template.iter_mut().zip(plant.input_defaults()) {
            *value = default.unwrap_or(0.0);
        }
        let envelope = Envelope::new(lpp_m, speed);
        let domain = model.branch.as_ref().map(|branch| &branch.domain);
        let approach_n_rps = model.revolutions_rps.unwrap_or(0.0);
        let of_rudder = |figures: &[(usize, f64)]| {
            let found = figures.iter().find(|(place, _)| Some(*place) == slots.delta);
            found.map_or(0.0, |&(_, figure)| figure)
        };
        let (lag_s, band_rad) = (of_rudder(plant.lags_s()), of_rudder(plant.bands()));
        Ok(Self {
            gear: Gear::new(&model.steering).with_lag(lag_s).with_band(band_rad),
            plant,
            instruments,
            envelope,
            template,
            slots,
            lpp_m,
            approach_speed_m_s: speed,
            approach_n_rps,
            // Where nobody says what the foundation's trials covered, runs tell when the branch
            // fades.
            validity: model.validity.as_ref().or(domain).cloned(),
            branch: None,
        })
    }

    /// What was learned beside the law, if anything was.
    pub fn branch(&self) -> Option<&dyn LearnedBranch> {
        self.branch.as_deref()
    }

    /// Sets the water depth for laws that know it, m.
    pub fn set_depth(&mut self, depth_m: f64) {
        if let Some(slot) = self.slots.depth {
            self.template[slot] = depth_m;
        }
    }

    /// Length between perpendiculars, m.
    pub fn lpp_m(&self) -> f64 {
        self.lpp_m
    }

    /// The approach speed that the model belongs to, m/s.
    pub fn approach_speed_m_s(&self) -> f64 {
        self.approach_speed_m_s
    }

    /// Revolutions for a steady approach at a speed, in proportion to the model's own, 1/s.
    pub fn revolutions_at(&self, speed_m_s: f64) -> f64 {
        self.approach_n_rps * speed_m_s / self.approach_speed_m_s
    }

    /// Whether the law turns revolutions into thrust.
    pub fn has_propeller(&self) -> bool {
        self.slots.n.is_some()
    }

    /// Whether the law takes a rudder angle.
    pub fn has_rudder(&self) -> bool {
        self.slots.delta.is_some()
    }

    /// The place of the rudder angle among the law's inputs.
    pub(crate) fn rudder_place(&self) -> Option<usize> {
        self.slots.delta
    }

    /// Whether the law has roll.
    pub fn has_roll(&self) -> bool {
        self.plant.has_roll()
    }

    /// What the law takes from outside, with what it takes where nothing is given.
    pub fn law_inputs(&self) -> impl Iterator<Item = (&str, Option<f64>)> {
        self.plant
            .input_names()
            .iter()
            .map(String::as_str)
            .zip(self.plant.input_defaults().iter().copied())
    }

    /// A sister's coefficients as passages take them; none where its own are not those of the
    /// others by name.
    pub fn sister(&self, model: &Model) -> Option<Vec<f64>> {
        let names = self.plant.open_coefficients();
        let same = model.coefficients.len() == names.len()
            && model.coefficients.keys().all(|name| names.contains(name));
        same.then(|| names.iter().map(|name| model.coefficient(name)).collect())
    }

    /// How many inputs the law takes.
    pub(crate) fn input_count(&self) -> usize {
        self.plant.input_names().len()
    }

    /// Whether some instrument says something else than the truth.
    pub(crate) fn reads_instruments(&self) -> bool {
        self.instruments.iter().any(Option::is_some)
    }

    /// Inputs that reach the ship through a lag: their place and its time constant, s.
    pub fn lags_s(&self) -> &[(usize, f64)] {
        self.plant.lags_s()
    }

    /// Half widths of the dead bands of inputs, by the input's place.
    pub fn bands(&self) -> &[(usize, f64)] {
        self.plant.bands()
    }

    /// What the instruments say of a state; `inputs` as in [`Ship::rate_with`].
    pub fn says(
        &self,
        frame: VelocityFrame,
        state: &StateVector,
        inputs: &Inputs,
        work: &mut Work,
    ) -> StateVector {
        let Some(instruments) = &self.instruments[frame as usize] else { return *state };
        let rate = self.rate_with(state, inputs, work);
        instruments.read(
            state,
            &rate,
            &inputs[..self.plant.input_names().len()],
            &mut work.instruments,
        )
    }

    /// The state of which the instruments say `said`.
    pub fn truth(
        &self,
        frame: VelocityFrame,
        said: &StateVector,
        inputs: &Inputs,
        work: &mut Work,
    ) -> StateVector {
        if self.instruments[frame as usize].is_none() {
            return *said;
        }
        truth(said, |state| self.says(frame, state, inputs, work))
    }

    /// How a motion leaves what the model's trials covered; none where it stays inside, or where
    /// nobody knows what they did.
    pub fn leaves(&self, track: &Trajectory) -> Option<Excursion> {
        leaves(self.validity.as_ref()?, track)
    }

    /// Leaves out whether motions leave what the model's trials covered.
    pub fn forget_validity(&mut self) {
        self.validity = None;
    }

    /// The range outside which runs are stopped.
    pub fn envelope(&self) -> &Envelope {
        &self.envelope
    }

    /// The steering gear, with the lag that effects put before it.
    pub fn gear(&self) -> Gear {
        self.gear
    }

    /// Widens the range to that of a run at another speed.
    pub fn set_envelope_speed(&mut self, speed_m_s: f64) {
        self.envelope = Envelope::new(self.lpp_m, speed_m_s.abs().max(self.approach_speed_m_s));
    }

    /// The inputs for a rudder angle and revolutions.
    pub fn inputs(&self, delta_rad: f64, n_rps: f64) -> Inputs {
        let mut inputs = self.template;
        for (slot, value) in [(self.slots.delta, delta_rad), (self.slots.n, n_rps)] {
            if let Some(slot) = slot {
                inputs[slot] = value;
            }
        }
        inputs
    }

    /// The rate of change of the state with the steering gear following `order`.
    pub fn rate_under(
        &self,
        state: &StateVector,
        order: Order,
        step_s: f64,
        work: &mut Work,
    ) -> StateVector {
        let inputs = self.inputs(state[at::DELTA], order.n_rps);
        let mut rate = self.rate_with(state, &inputs, work);
        rate[at::DELTA] = self.gear.rate(order.delta_rad, state[at::DELTA], step_s);
        rate
    }

    /// The rate of change of the state at a recorded rudder angle.
    pub fn rate_at(
        &self,
        state: &StateVector,
        delta_rad: f64,
        n_rps: f64,
        work: &mut Work,
    ) -> StateVector {
        self.rate_with(state, &self.inputs(delta_rad, n_rps), work)
    }

    /// The rate of change of the state with every input of the law given, in the order of
    /// [`Ship::law_inputs`].
    pub fn rate_with(&self, state: &StateVector, inputs: &Inputs, work: &mut Work) -> StateVector {
        let mut rate = self.plant.rate(state, inputs, work);
        if let Some(branch) = &self.branch {
            let added = branch.addition(&self.instant(state, &|slot| inputs[slot], &rate));
            VELOCITIES.into_iter().zip(added).for_each(|(place, added)| rate[place] += added);
        }
        rate
    }

    /// What a learned branch sees; `input` is that of the law at its place.
    pub fn instant(
        &self,
        state: &StateVector,
        input: &dyn Fn(usize) -> f64,
        foundation: &StateVector,
    ) -> Instant {
        let at_slot = |slot: Option<usize>| slot.map_or(0.0, input);
        Instant {
            velocities: VELOCITIES.map(|place| state[place]),
            delta_rad: at_slot(self.slots.delta),
            n_rps: at_slot(self.slots.n),
            accelerations: VELOCITIES.map(|place| foundation[place]),
        }
    }

    /// The rates of change of several states, each with every input of the law.
    pub(crate) fn rates<const N: usize>(
        &self,
        states: &States<N>,
        inputs: &[Lanes<N>],
        work: &mut Work<N>,
    ) -> States<N> {
        let mut rates = self.plant.rates(states, inputs, work);
        if let Some(branch) = &self.branch {
            // Each lane by itself: what comes out does not depend on who sails beside.
            for lane in 0..N {
                let input = |slot: usize| inputs[slot][lane];
                let (state, own) = (lane_of(states, lane), lane_of(&rates, lane));
                let added = branch.addition(&self.instant(&state, &input, &own));
                VELOCITIES
                    .into_iter()
                    .zip(added)
                    .for_each(|(place, added)| rates[place][lane] += added);
            }
        }
        rates
    }

    /// How fast the steering gear moves the rudder towards what is ordered, rad/s.
    pub(crate) fn rudder_rate(&self, order_rad: f64, angle_rad: f64, step_s: f64) -> f64 {
        self.gear.rate(order_rad, angle_rad, step_s)
    }
}

/// How to sail.
#[derive(Debug, Clone, Copy)]
pub struct Run {
    /// The state at time zero.
    pub start: StateVector,
    /// How long, s.
    pub duration_s: f64,
    /// Step, s.
    pub step_s: f64,
    /// Integration method.
    pub method: Method,
}
