//! Simulation of a block of lanes with their sensitivities; no step allocates memory.

use super::row_sums::{COLUMN_BLOCK, RowSums};
use super::small_matrix::SmallMatrix;
use super::system::{SensitiveSystem, WithGradient};
use crate::integrate::Method;
use crate::simd::{SimdKernel, dispatch_simd};
use crate::state::{StateVector, at};
use crate::tape::{LaneValues, TapeResults};

/// Runs in lockstep, with the states and sensitivities of each lane.
#[derive(Debug)]
pub struct SensitiveRun<'a, const L: usize> {
    system: &'a SensitiveSystem,
    states: Vec<LaneValues<L>>,
    /// Sensitivities by lane, state and column: coefficients, parameters by axis, then the initial
    /// state; followed by padding for block reads.
    sensitivities: Vec<f64>,
    columns: usize,
    stages: [StageResult<L>; 4],
    room: StepWorkspace<L>,
}

/// Results of one stage of a step.
#[derive(Debug, Clone)]
struct StageResult<const L: usize> {
    rate: Vec<LaneValues<L>>,
    slopes: SmallMatrix<L>,
    /// Regressors by lane, followed by padding for block reads.
    regressors: Vec<f64>,
    mobility: Vec<LaneValues<L>>,
}

#[derive(Debug)]
struct StepWorkspace<const L: usize> {
    at: Vec<LaneValues<L>>,
    inputs: Vec<LaneValues<L>>,
    work: TapeResults<L>,
    gains: [SmallMatrix<L>; 4],
    product: SmallMatrix<L>,
    transition: SmallMatrix<L>,
    /// Gain times mobility of each stage, state by axis.
    reach: [Vec<LaneValues<L>>; 4],
}

impl<'a, const L: usize> SensitiveRun<'a, L> {
    /// Creates a run without states; every lane must be started.
    pub fn new(system: &'a SensitiveSystem) -> Self {
        let (order, axes, count) =
            (system.states.len(), system.axes.len(), system.regressors.len());
        let columns = count + order;
        let stage = || StageResult {
            rate: vec![[0.0; L]; order],
            slopes: SmallMatrix::zeros(order),
            // The padding lets the last block be read at full width.
            regressors: vec![0.0; L * count + COLUMN_BLOCK],
            mobility: vec![[0.0; L]; axes * axes],
        };
        let small = || SmallMatrix::zeros(order);
        let room = StepWorkspace {
            at: vec![[0.0; L]; order],
            inputs: Vec::with_capacity(
                6 + system.input_names().len() + system.parameter_values.len(),
            ),
            work: TapeResults::default(),
            gains: std::array::from_fn(|_| small()),
            product: small(),
            transition: small(),
            reach: std::array::from_fn(|_| vec![[0.0; L]; order * axes]),
        };
        let sensitivities = vec![0.0; L * order * columns + COLUMN_BLOCK];
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

    /// Sensitivities of one state of a lane: to each coefficient, through each axis to each
    /// parameter ([`SensitiveSystem::gather_sensitivities`] adds these up), then to each initial
    /// state. `row` is counted as in [`SensitiveSystem::state_places`].
    pub fn state_sensitivities(&self, lane: usize, row: usize) -> &[f64] {
        let start = (lane * self.states.len() + row) * self.columns;
        &self.sensitivities[start..start + self.columns]
    }

    /// Advances every lane by one step; `inputs` are those of the law at its start, middle and end.
    pub fn advance_step(&mut self, method: Method, step_s: f64, inputs: [&[LaneValues<L>]; 3]) {
        match method {
            Method::Euler => self.step_euler(step_s, inputs[0]),
            Method::Rk4 => self.step_rk4(step_s, inputs),
        }
    }

    fn step_euler(&mut self, h: f64, inputs: &[LaneValues<L>]) {
        self.evaluate_stage(0, 0.0, inputs);
        // Euler's method: `P = 1 + h A_1`, and its only gain is `h`.
        self.room.transition.set_scaled(1.0, h, &self.stages[0].slopes);
        let StepWorkspace { gains, product, .. } = &mut self.room;
        product.entries.fill([0.0; L]);
        gains[0].set_scaled(h, 0.0, product);
        self.advance_states(|[k, ..]| h * k);
        self.advance_sensitivities(1);
    }

    fn step_rk4(&mut self, h: f64, [start, middle, end]: [&[LaneValues<L>]; 3]) {
        // Reach and inputs of the four stages.
        for (i, (reach, inputs)) in
            [(0.0, start), (0.5 * h, middle), (0.5 * h, middle), (h, end)].into_iter().enumerate()
        {
            self.evaluate_stage(i, reach, inputs);
        }
        self.advance_states(|[a, b, c, d]| h / 6.0 * (a + 2.0 * (b + c) + d));
        dispatch_simd(ChainRule { run: self, step_s: h });
    }

    /// Evaluates the rate, its derivatives and the regressors at the state moved along the rate of
    /// the stage before.
    fn evaluate_stage(&mut self, i: usize, reach: f64, inputs: &[LaneValues<L>]) {
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
        room.inputs.extend(system.parameter_values.iter().map(|value| [*value; L]));
        system.tape.evaluate(&room.inputs, &mut room.work);
        stages[i].read_tape(system, &room.work);
    }

    /// Computes the gains of each stage and the transition of a step of the classical Runge-Kutta
    /// method.
    #[inline(always)]
    fn compute_gains(&mut self, h: f64) {
        let StepWorkspace { gains, product, transition, .. } = &mut self.room;
        product.entries.fill([0.0; L]);
        transition.set_scaled(1.0, 0.0, product);
        let weights = [h / 6.0, h / 3.0, h / 3.0, h / 6.0];
        let reaches = [0.5 * h, 0.5 * h, h, 0.0];
        // Backwards: `G_i = weight_i + reach_i G_{i+1} A_{i+1}`; `product` holds `G_{i+1} A_{i+1}`.
        for i in (0..4).rev() {
            gains[i].set_scaled(weights[i], reaches[i], product);
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
            self.compute_reach(i);
        }
        for lane in 0..L {
            self.transport_sensitivities(lane, stages);
        }
    }

    /// Computes the gain times the mobility of a stage.
    #[inline(always)]
    fn compute_reach(&mut self, i: usize) {
        let axes = self.system.axes.len();
        let (gain, mobility) = (&self.room.gains[i], &self.stages[i].mobility);
        for (index, out) in self.room.reach[i].iter_mut().enumerate() {
            let (row, axis) = (index / axes, index % axes);
            *out = [0.0; L];
            for k in 0..axes {
                let (g, m) = (gain.entry(row, k), &mobility[k * axes + axis]);
                for lane in 0..L {
                    out[lane] += g[lane] * m[lane];
                }
            }
        }
    }

    /// Computes `P S` and the contributions of the coefficients at each stage, for one lane.
    #[inline(always)]
    fn transport_sensitivities(&mut self, lane: usize, stages: usize) {
        let (order, axes, columns) = (self.states.len(), self.system.axes.len(), self.columns);
        let (size, count) = (order * columns, columns - order);
        let Self { system, sensitivities, stages: pushing, room, .. } = self;
        let own = &mut sensitivities[lane * size..(lane + 1) * size + COLUMN_BLOCK];
        let pushing: [&[f64]; 4] = std::array::from_fn(|i| {
            &pushing[i].regressors[lane * count..(lane + 1) * count + COLUMN_BLOCK]
        });
        // Coefficients act through the accelerations of their axis; the initial state has no such
        // term.
        let pushed = system.of_axis.iter().map(|(axis, range)| (*axis, range.clone(), stages));
        for (axis, range, pushes) in pushed.chain(std::iter::once((0, count..columns, 0))) {
            let mut sums = RowSums::new(order);
            for row in 0..order {
                for k in 0..order {
                    sums.add_term(row, k, room.transition.entry(row, k)[lane]);
                }
                for i in 0..pushes {
                    sums.add_term(row, order + i, room.reach[i][row * axes + axis][lane]);
                }
            }
            sums.replace_rows(own, columns, &pushing[..pushes], range);
        }
    }
}

/// Chain rule through the stages of a step.
struct ChainRule<'r, 'a, const L: usize> {
    run: &'r mut SensitiveRun<'a, L>,
    step_s: f64,
}

impl<const L: usize> SimdKernel for ChainRule<'_, '_, L> {
    #[inline(always)]
    fn run(self) {
        self.run.compute_gains(self.step_s);
        self.run.advance_sensitivities(4);
    }
}

impl<const L: usize> StageResult<L> {
    fn read_tape(&mut self, system: &SensitiveSystem, work: &[LaneValues<L>]) {
        let (order, axes, count) = (self.rate.len(), system.axes.len(), system.regressors.len());
        let read = |output: usize| system.tape.output_lanes(output, work);
        system.evaluate_mobility(work, &mut self.mobility);
        self.rate.fill([0.0; L]);
        self.slopes.entries.fill([0.0; L]);
        // Rate and derivatives of a force have the same factor, its mobility.
        for (axis, force) in system.forces.iter().enumerate() {
            for row in 0..axes {
                let mobility = self.mobility[row * axes + axis];
                self.add_to_rate(row, &mobility, force, &read);
            }
        }
        // Accelerations of effects are added without a mobility.
        for (row, addition) in system.additions.iter().enumerate() {
            addition.iter().for_each(|addition| self.add_to_rate(row, &[1.0; L], addition, &read));
        }
        for (row, kinematic) in (axes..order).zip(&system.kinematics) {
            self.add_to_rate(row, &[1.0; L], kinematic, &read);
        }
        // Regressors are stored by lane, since a lane is transported at a time.
        for (j, &output) in system.regressors.iter().enumerate() {
            let value = read(output);
            (0..L).for_each(|lane| self.regressors[lane * count + j] = value[lane]);
        }
    }

    /// Adds a multiple of a value and its derivatives to the rate of a state.
    fn add_to_rate(
        &mut self,
        row: usize,
        factor: &LaneValues<L>,
        sloped: &WithGradient,
        read: &impl Fn(usize) -> LaneValues<L>,
    ) {
        let value = read(sloped.value);
        (0..L).for_each(|lane| self.rate[row][lane] += factor[lane] * value[lane]);
        for &(column, output) in &sloped.slopes {
            let slope = read(output);
            let entry = self.slopes.entry_mut(row, column);
            (0..L).for_each(|lane| entry[lane] += factor[lane] * slope[lane]);
        }
    }
}
