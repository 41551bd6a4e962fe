//! Simulation of many sets of coefficients of one law without sensitivities: the tape holds the
//! regressors, the coefficients are data.
//!
//! A population-based search evaluates thousands of sets. Lowering each set to a tape of its own
//! takes longer than simulating it. Here the tape therefore ends at the terms of the law, and
//! forces are sums of them. Terms of a submodel share one condition, and values that depend on
//! recorded inputs alone are calculated once for all sets ([`CandidateSystem::prepared`]). Only the
//! states on which forces depend are simulated: velocities, heading and roll, not the track.

use std::collections::BTreeMap;

use sistership_formula::Expr;
use sistership_model::Model;
use sistership_model::coefficient::{Axis, split_submodel};
use sistership_model::law::{Law, STATES, indicator_name};

use crate::equations::{
    AxesAttitude, EquationLowering, EquationsOfMotion, PlantError, constant_mobility,
    solve_mobility,
};
use crate::integrate::Method;
use crate::plant::check_inputs;
use crate::simd::{SimdKernel, dispatch_simd};
use crate::state::{StateVector, at};
use crate::tape::{LaneValues, Tape, TapeResults};

const STATES_3DOF: [usize; 4] = [at::U, at::V, at::R, at::PSI];
const STATES_4DOF: [usize; 6] = [at::U, at::V, at::R, at::P, at::PHI, at::PSI];
/// States in the order in which the tape takes them.
const TAPE_ORDER: [usize; 6] = [at::U, at::V, at::R, at::P, at::PHI, at::PSI];

/// Law with a model's particulars and parameters, ready for any values of the coefficients that the
/// model has.
#[derive(Debug, Clone)]
pub struct CandidateSystem {
    front: Tape,
    tape: Tape,
    states: &'static [usize],
    axes: Vec<AxisForce>,
    /// Outputs of the mass matrix entries over the axes, row by row.
    mass: Vec<Option<usize>>,
    /// Accelerations per unit force on each axis, where masses do not change.
    constant: Option<Vec<f64>>,
    /// Outputs of the accelerations that effects add.
    additions: Vec<Option<usize>>,
    /// Rates of heading and roll where the law defines them: row among the states, output.
    kinematics: Vec<(usize, usize)>,
    names: Vec<String>,
    input_names: Vec<String>,
}

/// Right-hand side of the equation of one axis.
#[derive(Debug, Clone)]
struct AxisForce {
    scale: usize,
    rest: usize,
    groups: Vec<TermGroup>,
}

/// Terms under one condition.
#[derive(Debug, Clone)]
struct TermGroup {
    /// Output of the condition; `None` for terms without a condition.
    gate: Option<usize>,
    /// Index of each coefficient with the output of its term.
    terms: Vec<(usize, usize)>,
}

impl CandidateSystem {
    /// Prepares a law for the coefficients that a model has; their values are not read.
    ///
    /// # Errors
    /// Returns an error that names what the model does not give, or if the model has effects on
    /// instruments or lags.
    pub fn new(model: &Model, law: &Law) -> Result<Self, PlantError> {
        let equations = EquationsOfMotion::new(model, law)?;
        check_inputs(equations.law())?;
        equations.reject_lags_and_instruments("candidates")?;
        CandidateBuilder {
            equations: &equations,
            lowering: EquationLowering::new(&equations, &equations.tape_input_names()),
            names: Vec::new(),
        }
        .build_system()
    }

    /// Names of the coefficients, in the order in which their values are given.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Places in the state vector of the simulated states.
    pub fn state_places(&self) -> &'static [usize] {
        self.states
    }

    /// Names of the inputs of the law, in order.
    pub fn input_names(&self) -> &[String] {
        &self.input_names
    }

    /// Returns the inputs of a step at an instant: the inputs of the law, followed by the values
    /// that depend on them alone.
    pub fn prepare_inputs(&self, inputs: &[f64]) -> Vec<f64> {
        // The hoisted front depends on no state, so that zeros will do.
        let point: Vec<f64> =
            std::iter::repeat_n(0.0, STATES.len()).chain(inputs.iter().copied()).collect();
        inputs.iter().copied().chain(self.front.evaluate_point(&point)).collect()
    }
}

struct CandidateBuilder<'e> {
    equations: &'e EquationsOfMotion<'e>,
    lowering: EquationLowering<'e>,
    names: Vec<String>,
}

impl CandidateBuilder<'_> {
    fn build_system(mut self) -> Result<CandidateSystem, PlantError> {
        let (equations, order) = (self.equations, self.equations.axes());
        let axes =
            order.iter().map(|&axis| self.build_axis_force(axis)).collect::<Result<_, _>>()?;
        let mass = self.lowering.add_mass_matrix(order)?;
        let additions = self.lowering.add_effect_accelerations(order)?;
        let states: &'static [usize] =
            if equations.law().has_roll() { &STATES_4DOF } else { &STATES_3DOF };
        let kinematics = self.build_kinematics(states)?;
        // The front holds what depends on inputs alone: it is evaluated once for all candidates.
        let (front, tape) = self.lowering.finish_hoisted(STATES.len());
        let constant = constant_mobility(equations, &tape, &mass)?;
        let input_names = equations.law().inputs.keys().cloned().collect();
        let names = self.names;
        Ok(CandidateSystem {
            front,
            tape,
            states,
            axes,
            mass,
            constant,
            additions,
            kinematics,
            names,
            input_names,
        })
    }

    fn build_axis_force(&mut self, axis: Axis) -> Result<AxisForce, PlantError> {
        let equations = self.equations;
        let of_law = &equations.law().axes[&axis];
        let (scale, rest) =
            (self.lowering.add_output(&of_law.scale)?, self.lowering.add_output(&of_law.rest)?);
        // The key `None` collects the shared coefficients, which have no condition.
        let mut groups: BTreeMap<Option<&str>, Vec<(usize, usize)>> = BTreeMap::new();
        for name in equations.axis_coefficients(axis) {
            let (shared, submodel) = split_submodel(name);
            // Checks that the deviation exists; its condition multiplies the sum of all terms under
            // it.
            equations.unscaled_regressor(name)?;
            let entry = (
                self.names.len(),
                self.lowering.add_output(&equations.unscaled_regressor(shared)?)?,
            );
            self.names.push(name.clone());
            groups.entry(submodel).or_default().push(entry);
        }
        let group = |(submodel, terms): (Option<&str>, Vec<(usize, usize)>)| {
            let gate = submodel
                .map(|submodel| self.lowering.add_output(&Expr::Name(indicator_name(submodel))))
                .transpose()?;
            Ok(TermGroup { gate, terms })
        };
        let groups = groups.into_iter().map(group).collect::<Result<_, PlantError>>()?;
        Ok(AxisForce { scale, rest, groups })
    }

    fn build_kinematics(&mut self, states: &[usize]) -> Result<Vec<(usize, usize)>, PlantError> {
        let mut all = Vec::new();
        // The position is left out: no force depends on it.
        for place in [at::PSI, at::PHI] {
            let Some(row) = states.iter().position(|&state| state == place) else { continue };
            all.push((
                row,
                self.lowering
                    .add_output(&self.equations.kinematic_rate(place, AxesAttitude::Upright)?)?,
            ));
        }
        Ok(all)
    }
}

/// Runs of one set of coefficients in lockstep; each lane has its own start and inputs.
#[derive(Debug)]
pub struct CandidateRun<'a, const L: usize> {
    system: &'a CandidateSystem,
    states: Vec<LaneValues<L>>,
    at: Vec<LaneValues<L>>,
    rates: [Vec<LaneValues<L>>; 4],
    inputs: Vec<LaneValues<L>>,
    work: TapeResults<L>,
    forces: Vec<LaneValues<L>>,
}

impl<'a, const L: usize> CandidateRun<'a, L> {
    /// Creates a run without states; every lane must be started.
    pub fn new(system: &'a CandidateSystem) -> Self {
        let states = || vec![[0.0; L]; system.states.len()];
        Self {
            system,
            states: states(),
            at: states(),
            rates: std::array::from_fn(|_| states()),
            inputs: Vec::with_capacity(STATES.len() + system.tape.input_names().len()),
            work: TapeResults::default(),
            forces: vec![[0.0; L]; system.axes.len()],
        }
    }

    /// Starts a lane at a state.
    pub fn start_lane(&mut self, lane: usize, state: &StateVector) {
        self.states
            .iter_mut()
            .zip(self.system.states)
            .for_each(|(lanes, &place)| lanes[lane] = state[place]);
    }

    /// Values of a simulated state in every lane; rows are counted as in
    /// [`CandidateSystem::states`], so that u, v and r come first.
    pub fn state_lanes(&self, row: usize) -> &LaneValues<L> {
        &self.states[row]
    }

    /// Rate of change of a state at the start of the last step, in every lane.
    pub fn rate_lanes(&self, row: usize) -> &LaneValues<L> {
        &self.rates[0][row]
    }

    /// Advances every lane by one step. `inputs` are [prepared](CandidateSystem::prepared) inputs
    /// at the start, middle and end of the step; Euler's method reads the first only.
    pub fn advance_step(
        &mut self,
        method: Method,
        step_s: f64,
        inputs: [&[LaneValues<L>]; 3],
        coefficients: &[f64],
    ) {
        // One dispatch for each step: all of its stages are compiled for the same vector width.
        dispatch_simd(CandidateStep { run: self, method, step_s, inputs, coefficients });
    }

    #[inline(always)]
    fn integrate_step(
        &mut self,
        method: Method,
        h: f64,
        [start, middle, end]: [&[LaneValues<L>]; 3],
        coefficients: &[f64],
    ) {
        // Stage i starts from the state moved along the rate of stage i - 1 (classical Runge-Kutta
        // method).
        self.evaluate_stage(0, 0.0, start, coefficients);
        if method == Method::Rk4 {
            self.evaluate_stage(1, 0.5 * h, middle, coefficients);
            self.evaluate_stage(2, 0.5 * h, middle, coefficients);
            self.evaluate_stage(3, h, end, coefficients);
        }
        // `x + h / 6 (k1 + 2 (k2 + k3) + k4)`
        let [a, b, c, d] = &self.rates;
        for (row, state) in self.states.iter_mut().enumerate() {
            for lane in 0..L {
                state[lane] += match method {
                    Method::Euler => h * a[row][lane],
                    Method::Rk4 => {
                        h / 6.0
                            * (a[row][lane] + 2.0 * (b[row][lane] + c[row][lane]) + d[row][lane])
                    }
                };
            }
        }
    }

    /// Evaluates the rates of one stage at the state moved by `reach` along the rates of the stage
    /// before.
    #[inline(always)]
    fn evaluate_stage(
        &mut self,
        i: usize,
        reach: f64,
        inputs: &[LaneValues<L>],
        coefficients: &[f64],
    ) {
        for (row, at) in self.at.iter_mut().enumerate() {
            *at = self.states[row];
            if i > 0 {
                let rate = &self.rates[i - 1][row];
                (0..L).for_each(|lane| at[lane] += reach * rate[lane]);
            }
        }
        self.inputs.clear();
        // A state that is not simulated (roll of a 3-DOF law) is zero on the tape.
        for place in TAPE_ORDER {
            let row = self.system.states.iter().position(|&state| state == place);
            self.inputs.push(row.map_or([0.0; L], |row| self.at[row]));
        }
        self.inputs.extend_from_slice(inputs);
        // One evaluation of the tape serves all lanes.
        self.system.tape.evaluate(&self.inputs, &mut self.work);
        self.system.axis_forces(&self.work, coefficients, &mut self.forces);
        self.system.state_rates(&self.work, &self.forces, &mut self.rates[i]);
    }
}

struct CandidateStep<'r, 'a, 'i, const L: usize> {
    run: &'r mut CandidateRun<'a, L>,
    method: Method,
    step_s: f64,
    inputs: [&'i [LaneValues<L>]; 3],
    coefficients: &'i [f64],
}

impl<const L: usize> SimdKernel for CandidateStep<'_, '_, '_, L> {
    #[inline(always)]
    fn run(self) {
        self.run.integrate_step(self.method, self.step_s, self.inputs, self.coefficients);
    }
}

impl CandidateSystem {
    #[inline(always)]
    fn axis_forces<const L: usize>(
        &self,
        work: &[LaneValues<L>],
        coefficients: &[f64],
        out: &mut [LaneValues<L>],
    ) {
        for (sum, out) in self.axes.iter().zip(out) {
            let mut total = [0.0; L];
            for TermGroup { gate, terms } in &sum.groups {
                let gate = gate.map_or([1.0; L], |gate| self.tape.output_lanes(gate, work));
                // A submodel whose condition holds in no lane costs nothing.
                if gate.iter().all(|gate| *gate == 0.0) {
                    continue;
                }
                let mut own = [0.0; L];
                for &(coefficient, term) in terms {
                    let (c, term) = (coefficients[coefficient], self.tape.output_ref(term, work));
                    (0..L).for_each(|lane| own[lane] += c * term[lane]);
                }
                (0..L).for_each(|lane| total[lane] += gate[lane] * own[lane]);
            }
            // Force on the axis: scale times the sum of the terms, plus the rest without
            // coefficients.
            let (scale, rest) =
                (self.tape.output_ref(sum.scale, work), self.tape.output_ref(sum.rest, work));
            (0..L).for_each(|lane| out[lane] = scale[lane] * total[lane] + rest[lane]);
        }
    }

    #[inline(always)]
    fn state_rates<const L: usize>(
        &self,
        work: &[LaneValues<L>],
        forces: &[LaneValues<L>],
        out: &mut [LaneValues<L>],
    ) {
        let n = self.axes.len();
        match &self.constant {
            Some(mobility) => {
                for (row, out) in out[..n].iter_mut().enumerate() {
                    *out = [0.0; L];
                    for (force, m) in forces.iter().zip(&mobility[row * n..]) {
                        (0..L).for_each(|lane| out[lane] += m * force[lane]);
                    }
                }
            }
            None => self.solve_accelerations(work, forces, out),
        }
        // Accelerations that effects add follow those of the forces, in the order of the axes.
        for (out, output) in out.iter_mut().zip(&self.additions) {
            if let Some(output) = output {
                let added = self.tape.output_ref(*output, work);
                (0..L).for_each(|lane| out[lane] += added[lane]);
            }
        }
        for &(row, output) in &self.kinematics {
            out[row] = self.tape.output_lanes(output, work);
        }
    }

    /// Accelerations for masses that change with the motion: the mass matrix is solved for each
    /// lane.
    fn solve_accelerations<const L: usize>(
        &self,
        work: &[LaneValues<L>],
        forces: &[LaneValues<L>],
        out: &mut [LaneValues<L>],
    ) {
        let n = self.axes.len();
        // The matrix is solved for one lane at a time.
        for lane in 0..L {
            let entry = |output: Option<usize>| {
                output.map_or(0.0, |output| self.tape.output_ref(output, work)[lane])
            };
            let solved = solve_mobility(n, |i, j| entry(self.mass[i * n + j]));
            for (row, out) in out[..n].iter_mut().enumerate() {
                out[lane] = forces
                    .iter()
                    .enumerate()
                    .map(|(axis, force)| solved[(row, axis)] * force[lane])
                    .sum();
            }
        }
    }
}

#[cfg(test)]
mod tests;
