//! Simulation of a block of lanes with their sensitivities; no step allocates memory.

use super::small::Small;
use super::sums::{Sums, WIDE};
use super::system::{SensitiveSystem, Sloped};
use crate::integrate::Method;
use crate::state::{StateVector, at};
use crate::tape::{Lanes, Slots};
use crate::wide::{Wide, widest};

/// Runs in lockstep, with the states and sensitivities of each lane.
#[derive(Debug)]
pub struct SensitiveRun<'a, const L: usize> {
    system: &'a SensitiveSystem,
    states: Vec<Lanes<L>>,
    /// Sensitivities by lane, state and column: coefficients, then the initial state; followed by
    /// padding for block reads.
    sensitivities: Vec<f64>,
    columns: usize,
    stages: [Stage<L>; 4],
    room: Room<L>,
}

/// Results of one stage of a step.
#[derive(Debug, Clone)]
struct Stage<const L: usize> {
    rate: Vec<Lanes<L>>,
    slopes: Small<L>,
    /// Regressors by lane, followed by padding for block reads.
    regressors: Vec<f64>,
    mobility: Vec<Lanes<L>>,
}

#[derive(Debug)]
struct Room<const L: usize> {
    at: Vec<Lanes<L>>,
    inputs: Vec<Lanes<L>>,
    work: Slots<L>,
    gains: [Small<L>; 4],
    product: Small<L>,
    transition: Small<L>,
    /// Gain times mobility of each stage, state by axis.
    reach: [Vec<Lanes<L>>; 4],
}

impl<'a, const L: usize> SensitiveRun<'a, L> {
    /// Creates a run without states; every lane must be started.
    pub fn new(system: &'a SensitiveSystem) -> Self {
        let (order, axes, count) =
            (system.states.len(), system.axes.len(), system.regressors.len());
        let columns = count + order;
        let stage = || Stage {
            rate: vec![[0.0; L]; order],
            slopes: Small::zeros(order),
            // The padding lets the last block be read at full width.
            regressors: vec![0.0; L * count + WIDE],
            mobility: vec![[0.0; L]; axes * axes],
        };
        let small = || Small::zeros(order);
        let room = Room {
            at: vec![[0.0; L]; order],
            inputs: Vec::with_capacity(6 + system.input_names().len()),
            work: Slots::default(),
            gains: std::array::from_fn(|_| small()),
            product: small(),
            transition: small(),
            reach: std::array::from_fn(|_| vec![[0.0; L]; order * axes]),
        };
        let sensitivities = vec![0.0; L * order * columns + WIDE];
        Self {
            system,
            states: vec![[0.0; L]; order],
            sensitivities,
            columns,
            stages: std::array::from_fn(|_| stage()),
            room,
        }
    }

    /// Starts a lane at a state: sensitivities to coefficients are zero, those to the initial state
    /// are the identity.
    pub fn start(&mut self, lane: usize, state: &StateVector) {
        let order = self.states.len();
        for (row, &place) in self.system.states.iter().enumerate() {
            self.states[row][lane] = state[place];
        }
        let count = self.columns - order;
        let own =
            &mut self.sensitivities[lane * order * self.columns..(lane + 1) * order * self.columns];
        own.fill(0.0);
        (0..order).for_each(|row| own[row * self.columns + count + row] = 1.0);
    }

    /// State of a lane; states that do not move are zero.
    pub fn state(&self, lane: usize) -> StateVector {
        let mut state = StateVector::zeros();
        self.system
            .states
            .iter()
            .zip(&self.states)
            .for_each(|(&place, lanes)| state[place] = lanes[lane]);
        state
    }

    /// Sensitivities of one state of a lane: to each coefficient, then to each initial state. `row`
    /// is counted as in [`SensitiveSystem::states`].
    pub fn sensitivity(&self, lane: usize, row: usize) -> &[f64] {
        let start = (lane * self.states.len() + row) * self.columns;
        &self.sensitivities[start..start + self.columns]
    }

    /// Advances every lane by one step; `inputs` are those of the law at its start, middle and end.
    pub fn step(&mut self, method: Method, step_s: f64, inputs: [&[Lanes<L>]; 3]) {
        match method {
            Method::Euler => self.euler(step_s, inputs[0]),
            Method::Rk4 => self.rk4(step_s, inputs),
        }
    }

    fn euler(&mut self, h: f64, inputs: &[Lanes<L>]) {
        self.stage(0, 0.0, inputs);
        // Euler's method: `P = 1 + h A_1`, and its only gain is `h`.
        self.room.transition.set(1.0, h, &self.stages[0].slopes);
        let Room { gains, product, .. } = &mut self.room;
        product.entries.fill([0.0; L]);
        gains[0].set(h, 0.0, product);
        self.advance_states(|[k, ..]| h * k);
        self.advance_sensitivities(1);
    }

    fn rk4(&mut self, h: f64, [start, middle, end]: [&[Lanes<L>]; 3]) {
        // Reach and inputs of the four stages.
        for (i, (reach, inputs)) in
            [(0.0, start), (0.5 * h, middle), (0.5 * h, middle), (h, end)].into_iter().enumerate()
        {
            self.stage(i, reach, inputs);
        }
        self.advance_states(|[a, b, c, d]| h / 6.0 * (a + 2.0 * (b + c) + d));
        widest(Chain { run: self, step_s: h });
    }

    /// Evaluates the rate, its derivatives and the regressors at the state moved along the rate of
    /// the stage before.
    fn stage(&mut self, i: usize, reach: f64, inputs: &[Lanes<L>]) {
        let Self { system, states, stages, room, .. } = self;
        for (row, at) in room.at.iter_mut().enumerate() {
            *at = states[row];
            if i > 0 {
                let rate = stages[i - 1].rate[row];
                (0..L).for_each(|lane| at[lane] += reach * rate[lane]);
            }
        }
        // States that a 3-DOF law does not have are zero on the tape.
        let place = |wanted: usize| system.states.iter().position(|&place| place == wanted);
        let value = |wanted: usize| place(wanted).map_or([0.0; L], |row| room.at[row]);
        let given = [at::U, at::V, at::R, at::P, at::PHI, at::PSI].map(value);
        room.inputs.clear();
        room.inputs.extend(given);
        room.inputs.extend_from_slice(inputs);
        system.tape.run(&room.inputs, &mut room.work);
        stages[i].read(system, &room.work);
    }

    /// Computes the gains of each stage and the transition of a step of the classical Runge-Kutta
    /// method.
    #[inline(always)]
    fn gains(&mut self, h: f64) {
        let Room { gains, product, transition, .. } = &mut self.room;
        product.entries.fill([0.0; L]);
        transition.set(1.0, 0.0, product);
        let weights = [h / 6.0, h / 3.0, h / 3.0, h / 6.0];
        let reaches = [0.5 * h, 0.5 * h, h, 0.0];
        // Backwards: `G_i = weight_i + reach_i G_{i+1} A_{i+1}`; `product` holds `G_{i+1} A_{i+1}`.
        for i in (0..4).rev() {
            gains[i].set(weights[i], reaches[i], product);
            product.set_product(&gains[i], &self.stages[i].slopes);
            transition.add(product);
        }
    }

    fn advance_states(&mut self, by: impl Fn([f64; 4]) -> f64) {
        for (row, state) in self.states.iter_mut().enumerate() {
            for (lane, value) in state.iter_mut().enumerate() {
                *value += by(std::array::from_fn(|i| self.stages[i].rate[row][lane]));
            }
        }
    }

    #[inline(always)]
    fn advance_sensitivities(&mut self, stages: usize) {
        for i in 0..stages {
            self.reach(i);
        }
        for lane in 0..L {
            self.transport(lane, stages);
        }
    }

    /// Computes the gain times the mobility of a stage.
    #[inline(always)]
    fn reach(&mut self, i: usize) {
        let axes = self.system.axes.len();
        let (gain, mobility) = (&self.room.gains[i], &self.stages[i].mobility);
        for (index, out) in self.room.reach[i].iter_mut().enumerate() {
            let (row, axis) = (index / axes, index % axes);
            *out = [0.0; L];
            for k in 0..axes {
                let (g, m) = (gain.at(row, k), &mobility[k * axes + axis]);
                for lane in 0..L {
                    out[lane] += g[lane] * m[lane];
                }
            }
        }
    }

    /// Computes `P S` and the contributions of the coefficients at each stage, for one lane.
    #[inline(always)]
    fn transport(&mut self, lane: usize, stages: usize) {
        let (order, axes, columns) = (self.states.len(), self.system.axes.len(), self.columns);
        let (size, count) = (order * columns, columns - order);
        let Self { system, sensitivities, stages: pushing, room, .. } = self;
        let own = &mut sensitivities[lane * size..(lane + 1) * size + WIDE];
        let pushing: [&[f64]; 4] = std::array::from_fn(|i| {
            &pushing[i].regressors[lane * count..(lane + 1) * count + WIDE]
        });
        let starting = count..columns;
        for (axis, range) in system.of_axis.iter().chain(std::iter::once(&starting)).enumerate() {
            // Coefficients act through the accelerations of their axis; the initial state has no
            // such term.
            let pushes = if axis < axes { stages } else { 0 };
            let mut sums = Sums::new(order);
            for row in 0..order {
                for k in 0..order {
                    sums.add(row, k, room.transition.at(row, k)[lane]);
                }
                for i in 0..pushes {
                    sums.add(row, order + i, room.reach[i][row * axes + axis][lane]);
                }
            }
            sums.replace(own, columns, &pushing[..pushes], range.clone());
        }
    }
}

/// Chain rule through the stages of a step.
struct Chain<'r, 'a, const L: usize> {
    run: &'r mut SensitiveRun<'a, L>,
    step_s: f64,
}

impl<const L: usize> Wide for Chain<'_, '_, L> {
    #[inline(always)]
    fn go(self) {
        self.run.gains(self.step_s);
        self.run.advance_sensitivities(4);
    }
}

impl<const L: usize> Stage<L> {
    fn read(&mut self, system: &SensitiveSystem, work: &[Lanes<L>]) {
        let (order, axes, count) = (self.rate.len(), system.axes.len(), system.regressors.len());
        let read = |output: usize| system.tape.read(output, work);
        system.mobility(work, &mut self.mobility);
        self.rate.fill([0.0; L]);
        self.slopes.entries.fill([0.0; L]);
        // Rate and derivatives of a force have the same factor, its mobility.
        for (axis, force) in system.forces.iter().enumerate() {
            for row in 0..axes {
                let mobility = self.mobility[row * axes + axis];
                self.add(row, &mobility, force, &read);
            }
        }
        // Accelerations of effects are added without a mobility.
        for (row, addition) in system.additions.iter().enumerate() {
            addition.iter().for_each(|addition| self.add(row, &[1.0; L], addition, &read));
        }
        for (row, kinematic) in (axes..order).zip(&system.kinematics) {
            self.add(row, &[1.0; L], kinematic, &read);
        }
        // Regressors are stored by lane, since a lane is transported at a time.
        for (j, &output) in system.regressors.iter().enumerate() {
            let value = read(output);
            (0..L).for_each(|lane| self.regressors[lane * count + j] = value[lane]);
        }
    }

    /// Adds a multiple of a value and its derivatives to the rate of a state.
    fn add(
        &mut self,
        row: usize,
        factor: &Lanes<L>,
        sloped: &Sloped,
        read: &impl Fn(usize) -> Lanes<L>,
    ) {
        let value = read(sloped.value);
        (0..L).for_each(|lane| self.rate[row][lane] += factor[lane] * value[lane]);
        for &(column, output) in &sloped.slopes {
            let slope = read(output);
            let entry = self.slopes.at_mut(row, column);
            (0..L).for_each(|lane| entry[lane] += factor[lane] * slope[lane]);
        }
    }
}
