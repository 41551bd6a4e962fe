//! A model linearised along a recorded motion.

use nalgebra::DMatrix;
use sistership_dynamics::interpolate::lagged;
use sistership_dynamics::state::at;
use sistership_dynamics::tape::Lanes;
use sistership_model::law::STATES;
use sistership_model::trial::Channel;

use super::record::smoothed;
use super::{Record, System};
use crate::refine::RefineError;

/// Directions differentiated at a time.
const LANES: usize = 8;

/// One gap-free part of a trial: how deviations from the recorded path go from sample to sample, and how they are read.
/// All matrices row by row, sample after sample.
#[derive(Debug, Clone)]
pub struct Linearised {
    /// Samples of the trial.
    pub samples: Vec<usize>,
    /// Time of each, s.
    pub t_s: Vec<f64>,
    /// Number of states, accelerations, columns.
    pub sizes: Sizes,
    /// Rate of change of deviations with deviations: states by states.
    pub jacobian: Vec<f64>,
    /// Accelerations by columns.
    pub accelerations: Vec<f64>,
    /// What the model moves more than the recorded path from a sample to the next, by state.
    pub defect: Vec<f64>,
    /// Readings less what instruments would say on the path, by recorded channel.
    pub reading: Vec<f64>,
    /// What instruments say more by deviations: channels by states; absent where they say the state itself.
    pub by_state: Option<Vec<f64>>,
    /// What instruments say more by those columns that act on them: channels by `measured` columns.
    pub by_column: Vec<f64>,
    /// Those columns.
    pub measured: Vec<usize>,
    /// The recorded channels with their places among the states.
    pub channels: Vec<(Channel, usize)>,
}

/// Numbers of things.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sizes {
    /// States.
    pub states: usize,
    /// Accelerations.
    pub axes: usize,
    /// Columns.
    pub columns: usize,
}

/// Linearises a model along each gap-free part of a trial.
///
/// # Errors
/// Names the channel that the trial lacks.
pub fn linearise(system: &System, record: &Record<'_>) -> Result<Vec<Linearised>, RefineError> {
    let path = Path::new(system, record)?;
    Ok(record.parts.iter().map(|part| Walker::new(system, &path).walk(part)).collect())
}

/// The recorded motion and inputs over the samples of a trial.
struct Path<'a> {
    record: &'a Record<'a>,
    /// By state of the filter.
    states: Vec<Vec<f64>>,
    /// What the instruments said, by channel of the system; absent where nothing was recorded.
    said: Vec<Option<&'a [f64]>>,
    inputs: Vec<Vec<f64>>,
    /// For each parameter that acts through a lag: the delayed input with a slightly (or first) longer lag, and by how much.
    delayed: Vec<Option<(Vec<f64>, f64)>>,
}

impl<'a> Path<'a> {
    fn new(system: &System, record: &'a Record<'a>) -> Result<Self, RefineError> {
        for channel in [Channel::U, Channel::V, Channel::R] {
            record.need(channel)?;
        }
        if system.axes.len() > 3 {
            record.need(Channel::Phi)?;
            record.need(Channel::P)?;
        }
        let said: Vec<Option<&[f64]>> = system.channels.iter().map(|&(channel, _)| record.trial.channel(channel)).collect();
        let mut states = vec![vec![0.0; record.trial.len()]; system.order()];
        for (&(_, place), said) in system.channels.iter().zip(&said) {
            if let Some(said) = said {
                states[place] = smoothed(said);
            }
        }
        let mut inputs = Vec::new();
        for (name, default) in &system.inputs {
            inputs.push(record.input(name, *default)?);
        }
        let delayed = delayed(system, record, &mut inputs);
        Ok(Self { record, states, said, inputs, delayed })
    }
}

impl Path<'_> {
    /// Roll of a law without it is what was recorded, if anything was.
    fn roll(&self, name: &str, k: usize) -> f64 {
        let channel = Channel::by_name(name).and_then(|channel| self.record.trial.channel(channel));
        channel.map_or(0.0, |values| values[k])
    }
}

/// Puts lags into effect and prepares their derivatives.
fn delayed(system: &System, record: &Record<'_>, inputs: &mut [Vec<f64>]) -> Vec<Option<(Vec<f64>, f64)>> {
    let t_s = &record.trial.t_s;
    let parameters = system.columns.candidates.iter().flat_map(|c| c.at.iter().copied().zip(c.form.parameters.values()));
    let mut derivatives = Vec::new();
    for ((value, parameter), input) in parameters.zip(&system.lagged) {
        let Some(input) = *input else {
            derivatives.push(None);
            continue;
        };
        let more = if value > 0.0 { 0.05 * value + 0.01 } else { parameter.start.max(0.01) };
        let longer = lagged(t_s, &inputs[input], value + more);
        if value > 0.0 {
            inputs[input] = lagged(t_s, &inputs[input], value);
        }
        derivatives.push(Some((longer, more)));
    }
    derivatives
}

/// Where the tapes stand at a sample.
struct Walker<'a> {
    system: &'a System,
    path: &'a Path<'a>,
    sizes: Sizes,
    point: Vec<f64>,
    primal: Vec<Lanes<1>>,
    tangents: Vec<Lanes<LANES>>,
    /// Inputs of the motion's tape that are differentiated: the filter's states that a law knows, then parameters.
    seeds: Vec<Seed>,
}

/// What a direction of differentiation moves, and where its derivative goes.
#[derive(Debug, Clone, Copy)]
enum Seed {
    /// Input of the tape; state of the filter.
    State(usize, usize),
    /// Input of the tape; column.
    Parameter(usize, usize),
}

/// The model at a sample.
struct Instant {
    rate: Vec<f64>,
    jacobian: Vec<f64>,
    accelerations: Vec<f64>,
}

impl<'a> Walker<'a> {
    fn new(system: &'a System, path: &'a Path<'a>) -> Self {
        let sizes = Sizes { states: system.order(), axes: system.axes.len(), columns: system.columns.len() };
        let states = STATES.iter().enumerate().filter_map(|(input, (name, _))| {
            let place = place_of(name);
            Some(Seed::State(input, system.states.iter().position(|&state| state == place)?))
        });
        let first = STATES.len() + system.inputs.len();
        let count = system.lagged.len();
        let parameters = (0..count).map(|j| Seed::Parameter(first + j, system.columns.nuisance.len() + j));
        let seeds = states.chain(parameters).collect();
        Self { system, path, sizes, point: Vec::new(), primal: Vec::new(), tangents: Vec::new(), seeds }
    }

    fn walk(mut self, part: &[usize]) -> Linearised {
        let trial = self.path.record.trial;
        let recorded: Vec<usize> = (0..self.system.channels.len()).filter(|&c| self.path.said[c].is_some()).collect();
        let channels = recorded.iter().map(|&c| self.system.channels[c]).collect();
        let mut out = Linearised {
            samples: part.to_vec(),
            t_s: part.iter().map(|&k| trial.t_s[k]).collect(),
            sizes: self.sizes,
            jacobian: Vec::new(),
            accelerations: Vec::new(),
            defect: Vec::new(),
            reading: Vec::new(),
            by_state: (!self.system.says.is_empty()).then(Vec::new),
            by_column: Vec::new(),
            measured: self.measuring(),
            channels,
        };
        let mut before: Option<Instant> = None;
        for (i, &k) in part.iter().enumerate() {
            let instant = self.instant(k);
            if let Some(before) = before {
                self.interval(&before, &instant, (part[i - 1], k), &mut out);
            }
            self.readings(k, &instant.rate, &recorded, &mut out);
            before = Some(instant);
        }
        out
    }

    /// Columns of candidates that act on instruments.
    fn measuring(&self) -> Vec<usize> {
        let columns = &self.system.columns;
        let acting = (0..columns.candidates.len()).filter(|&c| !columns.candidates[c].form.measures.is_empty());
        let water = self.system.frame == sistership_model::manifest::VelocityFrame::Water;
        let seeing = (0..columns.candidates.len()).filter(|&c| water && !columns.candidates[c].form.sees.is_empty());
        acting.chain(seeing).flat_map(|c| columns.places(c)).collect()
    }

    fn load(&mut self, k: usize) {
        self.point.clear();
        for (name, _) in STATES {
            let place = place_of(name);
            let state = self.system.states.iter().position(|&state| state == place);
            let value = match state {
                Some(state) => self.path.states[state][k],
                None => self.path.roll(name, k),
            };
            self.point.push(value);
        }
        self.point.extend(self.path.inputs.iter().map(|input| input[k]));
        self.point.extend(self.system.parameters());
    }

    fn run(&mut self) {
        let inputs: Vec<Lanes<1>> = self.point.iter().map(|&value| [value]).collect();
        self.system.motion.tape.run(&inputs, &mut self.primal);
    }

    fn read(&self, output: usize) -> f64 {
        self.system.motion.tape.read(output, &self.primal)[0]
    }

    /// Accelerations of what the tape holds, by the inverse of the mass matrix.
    fn solve(&self, inverse: &DMatrix<f64>) -> Vec<f64> {
        let motion = &self.system.motion;
        let force: Vec<f64> = motion.forces.iter().map(|&output| self.read(output)).collect();
        let added = |axis: usize| motion.additions[axis].map_or(0.0, |output| self.read(output));
        (0..self.sizes.axes)
            .map(|row| (0..self.sizes.axes).map(|c| inverse[(row, c)] * force[c]).sum::<f64>() + added(row))
            .collect()
    }

    fn inverse_mass(&self) -> DMatrix<f64> {
        let axes = self.sizes.axes;
        let entry = |output: &Option<usize>| output.map_or(0.0, |output| self.read(output));
        let mass = DMatrix::from_row_iterator(axes, axes, self.system.motion.mass.iter().map(entry));
        mass.try_inverse().unwrap_or_else(|| DMatrix::from_element(axes, axes, f64::NAN))
    }

    fn instant(&mut self, k: usize) -> Instant {
        self.load(k);
        self.run();
        let inverse = self.inverse_mass();
        let mut rate = self.solve(&inverse);
        rate.extend(self.system.motion.kinematics.iter().map(|&output| self.read(output)));
        let Sizes { states, axes, columns } = self.sizes;
        let mut instant = Instant { rate, jacobian: vec![0.0; states * states], accelerations: vec![0.0; axes * columns] };
        self.differentiate(&inverse, &mut instant);
        self.regressors(&inverse, &mut instant);
        self.secants(k, &inverse, &mut instant);
        instant
    }

    fn differentiate(&mut self, inverse: &DMatrix<f64>, instant: &mut Instant) {
        let motion = &self.system.motion;
        let Sizes { states, axes, columns } = self.sizes;
        for chunk in self.seeds.chunks(LANES) {
            let mut seeds = vec![[0.0; LANES]; self.point.len()];
            for (lane, seed) in chunk.iter().enumerate() {
                let (Seed::State(input, _) | Seed::Parameter(input, _)) = *seed;
                seeds[input][lane] = 1.0;
            }
            motion.tape.tangents(&self.primal, &seeds, &mut self.tangents);
            let read = |output: usize| motion.tape.read(output, &self.tangents);
            let forces: Vec<Lanes<LANES>> = motion.forces.iter().map(|&output| read(output)).collect();
            for (lane, seed) in chunk.iter().enumerate() {
                for row in 0..axes {
                    let of_forces: f64 = (0..axes).map(|c| inverse[(row, c)] * forces[c][lane]).sum();
                    let value = of_forces + motion.additions[row].map_or(0.0, |output| read(output)[lane]);
                    match *seed {
                        Seed::State(_, state) => instant.jacobian[row * states + state] = value,
                        Seed::Parameter(_, column) => instant.accelerations[row * columns + column] = value,
                    }
                }
                if let Seed::State(_, state) = *seed {
                    for (place, &output) in motion.kinematics.iter().enumerate() {
                        instant.jacobian[(axes + place) * states + state] = read(output)[lane];
                    }
                }
            }
        }
    }

    fn regressors(&mut self, inverse: &DMatrix<f64>, instant: &mut Instant) {
        let inputs: Vec<Lanes<1>> = self.point.iter().map(|&value| [value]).collect();
        let mut work = Vec::new();
        self.system.regressors.run(&inputs, &mut work);
        for (column, nuisance) in self.system.columns.nuisance.iter().enumerate() {
            let value = self.system.regressors.read(column, &work)[0];
            let Some(axis) = self.system.axes.iter().position(|&axis| axis == nuisance.axis) else { continue };
            for row in 0..self.sizes.axes {
                instant.accelerations[row * self.sizes.columns + column] = inverse[(row, axis)] * value;
            }
        }
    }

    /// Parameters whose derivative at their absence says nothing, and lags: what they change at a distance, by it.
    fn secants(&mut self, k: usize, inverse: &DMatrix<f64>, instant: &mut Instant) {
        let first = STATES.len() + self.system.inputs.len();
        let parameters = self.system.columns.candidates.iter().flat_map(|c| c.at.iter().zip(c.form.parameters.values()));
        for (j, (&value, parameter)) in parameters.enumerate() {
            let (input, moved, by) = match (&self.path.delayed[j], self.system.lagged[j]) {
                (Some((longer, by)), Some(input)) => (STATES.len() + input, longer[k], *by),
                _ if value == parameter.absent && parameter.start != parameter.absent => {
                    (first + j, parameter.start, parameter.start - parameter.absent)
                }
                _ => continue,
            };
            let kept = std::mem::replace(&mut self.point[input], moved);
            self.run();
            self.point[input] = kept;
            let there = self.solve(inverse);
            let column = self.system.columns.nuisance.len() + j;
            for (row, there) in there.iter().enumerate() {
                instant.accelerations[row * self.sizes.columns + column] = (there - instant.rate[row]) / by;
            }
        }
    }

    /// From a sample to the next, by the mean of both ends.
    fn interval(&self, before: &Instant, after: &Instant, (k, next): (usize, usize), out: &mut Linearised) {
        let dt = self.path.record.trial.t_s[next] - self.path.record.trial.t_s[k];
        let mean = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| 0.5 * (x + y)).collect::<Vec<f64>>();
        out.jacobian.extend(mean(&before.jacobian, &after.jacobian));
        out.accelerations.extend(mean(&before.accelerations, &after.accelerations));
        for (state, rate) in mean(&before.rate, &after.rate).into_iter().enumerate() {
            let moved = self.path.states[state][next] - self.path.states[state][k];
            out.defect.push(dt * rate - moved);
        }
    }

    fn readings(&mut self, k: usize, rate: &[f64], recorded: &[usize], out: &mut Linearised) {
        let system = self.system;
        let mut says: Vec<f64> = system.channels.iter().map(|&(_, place)| self.path.states[place][k]).collect();
        if let Some(by_state) = &mut out.by_state {
            let inputs = self.instrument_inputs(k, rate);
            let mut work = Vec::new();
            system.instruments.run(&inputs, &mut work);
            system.says.iter().enumerate().for_each(|(output, &place)| says[place] = system.instruments.read(output, &work)[0]);
            let jacobian = InstrumentJacobian::new(system, &work, inputs.len(), &out.measured);
            for &channel in recorded {
                by_state.extend(jacobian.by_state(system, channel));
                out.by_column.extend(jacobian.by_column(system, channel));
            }
        }
        for &channel in recorded {
            let said = self.path.said[channel].map_or(0.0, |said| said[k]);
            out.reading.push(said - says[channel]);
        }
    }

    fn instrument_inputs(&self, k: usize, rate: &[f64]) -> Vec<Lanes<1>> {
        let by_place = |values: &dyn Fn(usize) -> f64| {
            let places = [at::U, at::V, at::R, at::P, at::PHI, at::PSI, at::X, at::Y];
            let of = |place: usize| self.system.states.iter().position(|&s| s == place).map_or(0.0, values);
            places.map(of).map(|value| [value])
        };
        let mut inputs: Vec<Lanes<1>> = by_place(&|state| self.path.states[state][k]).to_vec();
        inputs.extend(by_place(&|state| rate[state]));
        inputs.extend(self.path.inputs.iter().map(|input| [input[k]]));
        inputs.extend(self.system.parameters().map(|value| [value]));
        inputs
    }
}

/// Derivatives of what instruments say, by output: states, then columns.
struct InstrumentJacobian {
    outputs: Vec<Vec<f64>>,
    states: usize,
    columns: usize,
}

impl InstrumentJacobian {
    fn new(system: &System, primal: &[Lanes<1>], inputs: usize, measured: &[usize]) -> Self {
        let places = [at::U, at::V, at::R, at::P, at::PHI, at::PSI, at::X, at::Y];
        let of_state = |state: &usize| places.iter().position(|place| place == state).unwrap_or(0);
        let first = inputs - system.lagged.len();
        let of_column = |column: &usize| first + column - system.columns.nuisance.len();
        let seeds: Vec<usize> = system.states.iter().map(of_state).chain(measured.iter().map(of_column)).collect();
        let mut outputs = vec![Vec::new(); system.says.len()];
        let mut work = Vec::new();
        for chunk in seeds.chunks(LANES) {
            let mut moved = vec![[0.0; LANES]; inputs];
            chunk.iter().enumerate().for_each(|(lane, &input)| moved[input][lane] = 1.0);
            system.instruments.tangents(primal, &moved, &mut work);
            for (output, row) in outputs.iter_mut().enumerate() {
                row.extend(&system.instruments.read(output, &work)[..chunk.len()]);
            }
        }
        Self { outputs, states: system.order(), columns: measured.len() }
    }

    fn by_state(&self, system: &System, channel: usize) -> Vec<f64> {
        match system.says.iter().position(|&place| place == channel) {
            Some(output) => self.outputs[output][..self.states].to_vec(),
            None => (0..self.states).map(|state| f64::from(u8::from(state == system.channels[channel].1))).collect(),
        }
    }

    fn by_column(&self, system: &System, channel: usize) -> Vec<f64> {
        match system.says.iter().position(|&place| place == channel) {
            Some(output) => self.outputs[output][self.states..].to_vec(),
            None => vec![0.0; self.columns],
        }
    }
}

/// The place in the state vector of a state that laws know.
fn place_of(name: &str) -> usize {
    match name {
        "u" => at::U,
        "v" => at::V,
        "r" => at::R,
        "p" => at::P,
        "phi" => at::PHI,
        _ => at::PSI,
    }
}
