//! A model at consecutive samples, one per lane.

use nalgebra::DMatrix;
use sistership_model::law::STATES;
use sistership_simulation::tape::{LaneValues, LocalSlopes, TapeResults};

use super::ResidualSystem;
use super::correction::CorrectionBlock;
use super::lanes::{LANES, fill_lanes};
use super::path::RecordedPath;
use super::tangents::state_index;

/// The model on the path at up to [`LANES`] samples.
pub(super) struct SampleBlock<'a> {
    pub system: &'a ResidualSystem,
    path: &'a RecordedPath<'a>,
    /// Path of each state that laws know, if any.
    states: Vec<Option<&'a [f64]>>,
    /// Sample of each lane; lanes after the last sample of a part repeat the first one.
    samples: [usize; LANES],
    /// Inputs of the tape of motion.
    pub inputs: Vec<LaneValues<LANES>>,
    pub primal: TapeResults<LANES>,
    pub slopes: LocalSlopes<LANES>,
    /// Inverse of the mass matrix, row by row.
    pub inverse: Vec<LaneValues<LANES>>,
    /// Rates of the filter's states.
    pub rate: Vec<LaneValues<LANES>>,
    /// Accelerations by the law alone.
    pub by_law: Vec<LaneValues<LANES>>,
    /// Learned correction, if any.
    pub correction: Option<CorrectionBlock<'a>>,
}

impl<'a> SampleBlock<'a> {
    pub fn new(system: &'a ResidualSystem, path: &'a RecordedPath<'a>) -> Self {
        let of = |name: &str| {
            let place = system.states.iter().position(|&state| state == state_index(name));
            place.map_or_else(|| path.recorded_roll(name), |state| Some(&path.states[state][..]))
        };
        Self {
            system,
            path,
            states: STATES.iter().map(|(name, _)| of(name)).collect(),
            samples: [0; LANES],
            inputs: Vec::new(),
            primal: TapeResults::default(),
            slopes: LocalSlopes::default(),
            inverse: Vec::new(),
            rate: Vec::new(),
            by_law: Vec::new(),
            correction: system.correction.as_ref().map(CorrectionBlock::new),
        }
    }

    /// Evaluates the model at samples of the path.
    pub fn evaluate_samples(&mut self, samples: &[usize]) {
        self.samples = std::array::from_fn(|k| *samples.get(k).unwrap_or(&samples[0]));
        let of = |values: &[f64]| fill_lanes(|k| values[self.samples[k]]);
        let states = self.states.iter().map(|values| values.map_or([0.0; LANES], of));
        self.inputs.clear();
        self.inputs.extend(states.chain(self.path.inputs.iter().map(|input| of(input))));
        self.inputs.extend(self.system.parameter_values().map(|value| [value; LANES]));
        let motion = &self.system.motion;
        motion.tape.evaluate(&self.inputs, &mut self.primal);
        motion.tape.compute_slopes(&self.primal, &mut self.slopes);
        self.invert_masses();
        self.rate = self.accelerations_from(&self.primal);
        // Kept before the correction: secants and mass columns belong to the law alone.
        self.by_law.clone_from(&self.rate);
        if let Some(correction) = &mut self.correction {
            let velocities = [self.inputs[0], self.inputs[1], self.inputs[2]];
            let inputs = &self.inputs[STATES.len()..];
            correction.add_to_rates(velocities, inputs, &mut self.rate);
        }
        let kinematics = motion.kinematics.iter();
        self.rate.extend(kinematics.map(|&output| motion.tape.output_lanes(output, &self.primal)));
    }

    fn invert_masses(&mut self) {
        let (motion, axes) = (&self.system.motion, self.system.axes.len());
        self.inverse.resize(axes * axes, [0.0; LANES]);
        for lane in 0..LANES {
            let entry = |output: &Option<usize>| {
                output.map_or(0.0, |output| motion.tape.output_lanes(output, &self.primal)[lane])
            };
            let mass = DMatrix::from_row_iterator(axes, axes, motion.mass.iter().map(entry));
            let inverse = mass.try_inverse();
            for (place, to) in self.inverse.iter_mut().enumerate() {
                let (row, column) = (place / axes, place % axes);
                // A singular mass matrix gives not-a-number instead of an error.
                to[lane] = inverse.as_ref().map_or(f64::NAN, |inverse| inverse[(row, column)]);
            }
        }
    }

    /// Accelerations, or their derivatives, from values (or tangents) of the tape of motion: by
    /// axis.
    pub fn accelerations_from(&self, held: &[LaneValues<LANES>]) -> Vec<LaneValues<LANES>> {
        let (motion, axes) = (&self.system.motion, self.system.axes.len());
        let row = |row: usize| {
            // Sums of floating-point numbers begin with -0.0, as `Iterator::sum` does.
            let mut sum = [-0.0; LANES];
            for (c, &output) in motion.forces.iter().enumerate() {
                let (inverse, force) =
                    (&self.inverse[row * axes + c], motion.tape.output_lanes(output, held));
                (0..LANES).for_each(|k| sum[k] += inverse[k] * force[k]);
            }
            let added = motion.additions[row].map(|output| motion.tape.output_lanes(output, held));
            let added = added.unwrap_or([0.0; LANES]);
            fill_lanes(|k| sum[k] + added[k])
        };
        (0..axes).map(row).collect()
    }

    /// Input that a parameter of a response moves, and the derivative of the input with the
    /// parameter.
    pub fn moved_input(&self, parameter: usize) -> Option<(usize, LaneValues<LANES>)> {
        let input = self.system.followed[parameter]?.input;
        let (larger, by) = self.path.followed[parameter].as_ref()?;
        let here = self.inputs[STATES.len() + input];
        Some((input, fill_lanes(|k| (larger[self.samples[k]] - here[k]) / by)))
    }

    /// Input with a larger figure of a parameter's response.
    pub fn moved_input_values(&self, parameter: usize) -> LaneValues<LANES> {
        let larger = self.path.followed[parameter].as_ref();
        larger.map_or([0.0; LANES], |(larger, _)| fill_lanes(|k| larger[self.samples[k]]))
    }

    /// Entry of the diagonal of the mass matrix.
    pub fn diagonal_mass(&self, axis: usize) -> LaneValues<LANES> {
        let motion = &self.system.motion;
        let output = motion.mass[axis * (self.system.axes.len() + 1)];
        output.map_or([0.0; LANES], |output| motion.tape.output_lanes(output, &self.primal))
    }

    /// Inputs of the instruments' tape at the samples.
    pub fn instrument_inputs(&self) -> Vec<LaneValues<LANES>> {
        self.path.instrument_inputs(self.system, &self.samples, &|state| self.rate[state])
    }
}
