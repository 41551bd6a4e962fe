//! Evaluation of the equations of motion for a block of ships in lockstep.

use nalgebra::{Matrix4, Vector4};

use super::{LawInputs, Plant};
use crate::state::{LaneStates, StateVector, at, lane_of};
use crate::tape::{LaneValues, TapeResults};

/// States that the tape takes, in order.
const TAPE_STATES: [usize; 6] = [at::U, at::V, at::R, at::P, at::PHI, at::PSI];

/// Workspace of the evaluation, kept from step to step so that the time loop allocates nothing.
#[derive(Debug)]
pub struct PlantWorkspace<const N: usize = 1> {
    /// Inputs of the tape: states, inputs of the law, open coefficients.
    point: Vec<LaneValues<N>>,
    work: TapeResults<N>,
    coefficients: Vec<LaneValues<N>>,
    pub(crate) instruments: crate::instruments::InstrumentWorkspace,
}

impl<const N: usize> Default for PlantWorkspace<N> {
    fn default() -> Self {
        Self {
            point: Vec::new(),
            work: TapeResults::default(),
            coefficients: Vec::new(),
            instruments: crate::instruments::InstrumentWorkspace::default(),
        }
    }
}

impl<const N: usize> PlantWorkspace<N> {
    /// Sets the open coefficients of the ship in a lane.
    pub fn set_coefficients(&mut self, lane: usize, values: &[f64]) {
        self.coefficients.resize(values.len(), [0.0; N]);
        self.coefficients.iter_mut().zip(values).for_each(|(lanes, value)| lanes[lane] = *value);
        // Forces `fill` to rebuild the point with the new coefficients.
        self.point.clear();
    }

    fn fill_point(&mut self, states: &LaneStates<N>, inputs: &[LaneValues<N>]) {
        let fixed = TAPE_STATES.len() + inputs.len();
        // The point is rebuilt when the number of inputs or coefficients has changed.
        if self.point.len() != fixed + self.coefficients.len() {
            self.point.clear();
            self.point.resize(fixed, [0.0; N]);
            self.point.extend_from_slice(&self.coefficients);
        }
        self.point.iter_mut().zip(TAPE_STATES).for_each(|(lanes, place)| *lanes = states[place]);
        self.point[TAPE_STATES.len()..fixed].copy_from_slice(inputs);
    }
}

impl Plant {
    /// Rate of change of the state; that of the rudder is zero, because the steering gear
    /// determines it.
    pub fn state_rate(
        &self,
        state: &StateVector,
        inputs: &LawInputs,
        work: &mut PlantWorkspace,
    ) -> StateVector {
        let states = std::array::from_fn(|place| [state[place]]);
        let inputs = inputs.map(|value| [value]);
        lane_of(&self.state_rates(&states, &inputs, work), 0)
    }

    /// Rates of change of the states of several ships, each with its own inputs and open
    /// coefficients. `inputs` has at least as many entries as the law has inputs.
    pub fn state_rates<const N: usize>(
        &self,
        states: &LaneStates<N>,
        inputs: &[LaneValues<N>],
        room: &mut PlantWorkspace<N>,
    ) -> LaneStates<N> {
        room.fill_point(states, &inputs[..self.input_names.len()]);
        self.tape.evaluate(&room.point, &mut room.work);
        let mut rates = [[0.0; N]; 9];
        self.set_accelerations(&room.work, &mut rates);
        self.set_kinematic_rates(states, &room.work, &mut rates);
        rates
    }

    fn set_accelerations<const N: usize>(&self, work: &[LaneValues<N>], rates: &mut LaneStates<N>) {
        let read = |output: Option<usize>| {
            output.map_or([0.0; N], |output| self.tape.output_lanes(output, work))
        };
        // `M (nu' - a) = F`: forces times the inverse mass matrix, plus the accelerations of
        // effects.
        let forces = self.layout.forces.map(read);
        let accelerations = match &self.mobility {
            Some(mobility) => matrix_vector_product(mobility, &forces),
            None => self.solve_accelerations(work, &forces),
        };
        for ((place, acceleration), output) in [at::U, at::V, at::P, at::R]
            .into_iter()
            .zip(accelerations)
            .zip(self.layout.accelerations)
        {
            let added = read(output);
            rates[place] = std::array::from_fn(|lane| acceleration[lane] + added[lane]);
        }
    }

    /// Accelerations for masses that change with the motion: the mass matrix is solved for each
    /// ship.
    fn solve_accelerations<const N: usize>(
        &self,
        work: &[LaneValues<N>],
        forces: &[LaneValues<N>; 4],
    ) -> [LaneValues<N>; 4] {
        let mut out = [[0.0; N]; 4];
        for lane in 0..N {
            let entry = |row: usize, column: usize| {
                let output = self.layout.mass[row][column];
                output.map_or(f64::from(u8::from(row == column)), |output| {
                    self.tape.output_ref(output, work)[lane]
                })
            };
            // A singular matrix gives NaN, which the check of the envelope reports.
            let own = Vector4::from_fn(|row, _| forces[row][lane]);
            let solved = Matrix4::from_fn(entry)
                .lu()
                .solve(&own)
                .unwrap_or_else(|| Vector4::repeat(f64::NAN));
            out.iter_mut().zip(solved.iter()).for_each(|(out, value)| out[lane] = *value);
        }
        out
    }

    /// Sets the rates of position and attitude.
    fn set_kinematic_rates<const N: usize>(
        &self,
        states: &LaneStates<N>,
        work: &[LaneValues<N>],
        rates: &mut LaneStates<N>,
    ) {
        let (u, v) = (&states[at::U], &states[at::V]);
        // Default: motion in the horizontal plane; rates that the law defines replace it below.
        for lane in 0..N {
            let (sin, cos) = states[at::PSI][lane].sin_cos();
            rates[at::X][lane] = u[lane] * cos - v[lane] * sin;
            rates[at::Y][lane] = u[lane] * sin + v[lane] * cos;
        }
        rates[at::PSI] = states[at::R];
        if self.has_roll() {
            rates[at::PHI] = states[at::P];
        }
        for (place, output) in
            [at::X, at::Y, at::PSI, at::PHI].into_iter().zip(self.layout.kinematics)
        {
            output
                .into_iter()
                .for_each(|output| rates[place] = self.tape.output_lanes(output, work));
        }
    }
}

fn matrix_vector_product<const N: usize>(
    matrix: &Matrix4<f64>,
    vectors: &[LaneValues<N>; 4],
) -> [LaneValues<N>; 4] {
    let mut out = [[0.0; N]; 4];
    for (row, out) in out.iter_mut().enumerate() {
        for (column, vector) in vectors.iter().enumerate() {
            let factor = matrix[(row, column)];
            // Skips axes that the law does not have, whose force may be NaN.
            if factor != 0.0 {
                (0..N).for_each(|lane| out[lane] += factor * vector[lane]);
            }
        }
    }
    out
}
