//! Along a path, sample by sample.

use nalgebra::DMatrix;
use sistership_dynamics::tape::{Lanes, Slots};
use sistership_model::coefficient::Axis;
use sistership_model::effect::EffectParameter;
use sistership_model::law::STATES;

use super::instruments::{InstrumentJacobian, LANES};
use super::linearised::{Detail, Sizes};
use super::path::RecordedPath;
use super::regressor_block::RegressorBlock;
use super::tangents::{TangentSeed, TangentSweep, place_of, sweeps};
use super::{Linearised, NuisanceKind, ResidualSystem};

/// Where the tapes stand at a sample.
pub(super) struct PathLineariser<'a> {
    system: &'a ResidualSystem,
    path: &'a RecordedPath<'a>,
    detail: Detail,
    sizes: Sizes,
    /// Of each state that laws know, its place among the path's.
    states: Vec<Option<usize>>,
    point: Vec<f64>,
    inputs: Vec<Lanes<1>>,
    primal: Slots<1>,
    regressors: RegressorBlock,
    moved: Vec<Lanes<LANES>>,
    there: Slots<LANES>,
    sweeps: Vec<TangentSweep>,
}

/// The model at a sample.
struct SampleLinearisation {
    rate: Vec<f64>,
    jacobian: Vec<f64>,
    accelerations: Vec<f64>,
}

/// An input of the tape moved, and by how much a column's parameter is moved with it.
struct Secant {
    input: usize,
    moved: f64,
    by: f64,
    column: usize,
}

impl<'a> PathLineariser<'a> {
    pub fn new(system: &'a ResidualSystem, path: &'a RecordedPath<'a>, detail: Detail) -> Self {
        let sizes = Sizes {
            states: system.order(),
            axes: system.axes.len(),
            columns: system.columns.len(),
        };
        let place = |name| system.states.iter().position(|&state| state == place_of(name));
        Self {
            system,
            path,
            detail,
            sizes,
            states: STATES.iter().map(|(name, _)| place(name)).collect(),
            point: Vec::new(),
            inputs: Vec::new(),
            primal: Slots::default(),
            regressors: RegressorBlock::new(system),
            moved: Vec::new(),
            there: Slots::default(),
            sweeps: sweeps(system, detail),
        }
    }

    pub fn walk(mut self, part: &[usize]) -> Linearised {
        let trial = self.path.record.trial;
        let recorded: Vec<usize> =
            (0..self.system.channels.len()).filter(|&c| self.path.said[c].is_some()).collect();
        let channels = recorded.iter().map(|&c| self.system.channels[c]).collect();
        let (Sizes { states, axes, columns }, steps) = (self.sizes, part.len().saturating_sub(1));
        let mut out = Linearised {
            samples: part.to_vec(),
            t_s: part.iter().map(|&k| trial.t_s[k]).collect(),
            sizes: self.sizes,
            // As large as they become: what a vector grows by would stay with it.
            jacobian: Vec::with_capacity(steps * states * states),
            accelerations: Vec::with_capacity(steps * axes * columns),
            defect: Vec::with_capacity(steps * states),
            reading: Vec::with_capacity(part.len() * recorded.len()),
            by_state: (!self.system.says.is_empty()).then(Vec::new),
            by_column: Vec::new(),
            measured: self.measuring(),
            channels,
            every: self.path.record.every,
        };
        let mut before: Option<SampleLinearisation> = None;
        for (i, &k) in part.iter().enumerate() {
            if i.is_multiple_of(LANES) {
                self.next_regressors(&part[i..part.len().min(i + LANES)]);
            }
            let instant = self.instant(k, i % LANES);
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
        let acting = (0..columns.candidates.len())
            .filter(|&c| !columns.candidates[c].form.measures.is_empty());
        let water = self.system.frame == sistership_model::manifest::VelocityFrame::Water;
        let seeing = (0..columns.candidates.len())
            .filter(|&c| water && !columns.candidates[c].form.sees.is_empty());
        acting.chain(seeing).flat_map(|c| columns.places(c)).collect()
    }

    fn load(&mut self, k: usize) {
        self.point.clear();
        for ((name, _), state) in STATES.iter().zip(&self.states) {
            let value = match *state {
                Some(state) => self.path.states[state][k],
                None => self.path.roll(name, k),
            };
            self.point.push(value);
        }
        self.point.extend(self.path.inputs.iter().map(|input| input[k]));
        self.point.extend(self.system.parameters());
    }

    fn run(&mut self) {
        self.inputs.clear();
        self.inputs.extend(self.point.iter().map(|&value| [value]));
        self.system.motion.tape.run(&self.inputs, &mut self.primal);
    }

    /// The regressors of samples that follow each other.
    fn next_regressors(&mut self, samples: &[usize]) {
        if self.system.columns.nuisance.is_empty() {
            return;
        }
        for (lane, &k) in samples.iter().enumerate() {
            self.load(k);
            self.regressors.place(lane, &self.point);
        }
        self.regressors.run(&self.system.regressors);
    }

    fn read(&self, output: usize) -> f64 {
        self.system.motion.tape.read(output, &self.primal)[0]
    }

    /// Accelerations of what a lane holds, by the inverse of the mass matrix.
    fn solve<const N: usize>(
        &self,
        inverse: &DMatrix<f64>,
        work: &Slots<N>,
        lane: usize,
    ) -> Vec<f64> {
        let motion = &self.system.motion;
        let read = |output: usize| motion.tape.read(output, work)[lane];
        let force: Vec<f64> = motion.forces.iter().map(|&output| read(output)).collect();
        let added = |axis: usize| motion.additions[axis].map_or(0.0, read);
        (0..self.sizes.axes)
            .map(|row| {
                (0..self.sizes.axes).map(|c| inverse[(row, c)] * force[c]).sum::<f64>() + added(row)
            })
            .collect()
    }

    fn inverse_mass(&self) -> DMatrix<f64> {
        let axes = self.sizes.axes;
        let entry = |output: &Option<usize>| output.map_or(0.0, |output| self.read(output));
        let mass =
            DMatrix::from_row_iterator(axes, axes, self.system.motion.mass.iter().map(entry));
        mass.try_inverse().unwrap_or_else(|| DMatrix::from_element(axes, axes, f64::NAN))
    }

    /// At a sample, which is one of those whose regressors are there.
    fn instant(&mut self, k: usize, lane: usize) -> SampleLinearisation {
        self.load(k);
        self.run();
        let inverse = self.inverse_mass();
        let mut rate = self.solve(&inverse, &self.primal, 0);
        rate.extend(self.system.motion.kinematics.iter().map(|&output| self.read(output)));
        let Sizes { states, axes, columns } = self.sizes;
        let mut instant = SampleLinearisation {
            rate,
            jacobian: vec![0.0; states * states],
            accelerations: vec![0.0; axes * columns],
        };
        self.differentiate(&inverse, &mut instant);
        self.add_regressors(lane, &inverse, &mut instant);
        self.secants(k, &inverse, &mut instant);
        instant
    }

    fn differentiate(&mut self, inverse: &DMatrix<f64>, instant: &mut SampleLinearisation) {
        let motion = &self.system.motion;
        let Sizes { states, axes, columns } = self.sizes;
        for sweep in &mut self.sweeps {
            motion.tape.tangents_among(
                &sweep.reached,
                &self.primal,
                &sweep.lanes,
                &mut sweep.tangents,
            );
            let read = |output: usize| motion.tape.read(output, &sweep.tangents);
            let forces: Vec<Lanes<LANES>> =
                motion.forces.iter().map(|&output| read(output)).collect();
            for (lane, seed) in sweep.seeds.iter().enumerate() {
                for row in 0..axes {
                    let of_forces: f64 =
                        (0..axes).map(|c| inverse[(row, c)] * forces[c][lane]).sum();
                    let value =
                        of_forces + motion.additions[row].map_or(0.0, |output| read(output)[lane]);
                    match *seed {
                        TangentSeed::State(_, state) => {
                            instant.jacobian[row * states + state] = value
                        }
                        TangentSeed::Parameter(_, column) => {
                            instant.accelerations[row * columns + column] = value
                        }
                    }
                }
                if let TangentSeed::State(_, state) = *seed {
                    for (place, &output) in motion.kinematics.iter().enumerate() {
                        instant.jacobian[(axes + place) * states + state] = read(output)[lane];
                    }
                }
            }
        }
    }

    fn add_regressors(
        &self,
        lane: usize,
        inverse: &DMatrix<f64>,
        instant: &mut SampleLinearisation,
    ) {
        let Sizes { axes, columns, .. } = self.sizes;
        for (range, axis) in self.regressors.alike() {
            let forces = &self.regressors.of_sample(lane)[range.clone()];
            for row in 0..axes {
                let weight = inverse[(row, *axis)];
                let to = &mut instant.accelerations[row * columns..][range.clone()];
                to.iter_mut().zip(forces).for_each(|(to, force)| *to += weight * force);
            }
        }
        for (column, nuisance) in self.system.columns.nuisance.iter().enumerate() {
            let NuisanceKind::Mass(row, other) = nuisance.kind else { continue };
            for (axis, force) in self.heavier((row, other), &instant.rate) {
                let axis = self.system.axes.iter().position(|&known| known == axis);
                let Some(axis) = axis else { continue };
                for row in 0..axes {
                    instant.accelerations[row * columns + column] += inverse[(row, axis)] * force;
                }
            }
        }
    }

    /// The forces that a larger entry of the mass matrix takes.
    fn heavier(&self, (row, column): (Axis, Axis), rate: &[f64]) -> Vec<(Axis, f64)> {
        let place = |axis: Axis| self.system.axes.iter().position(|&known| known == axis);
        let (Some(i), Some(j)) = (place(row), place(column)) else { return Vec::new() };
        let diagonal = |i: usize| {
            self.system.motion.mass[i * (self.sizes.axes + 1)]
                .map_or(0.0, |output| self.read(output))
        };
        let unit = (diagonal(i) * diagonal(j)).sqrt();
        if i == j {
            vec![(row, -unit * rate[i])]
        } else {
            vec![(row, -unit * rate[j]), (column, -unit * rate[i])]
        }
    }

    /// Parameters whose derivative at their absence says nothing, and lags: what they change at a
    /// distance, by it.
    fn secants(&mut self, k: usize, inverse: &DMatrix<f64>, instant: &mut SampleLinearisation) {
        for secants in self.wanted_secants(k).chunks(LANES) {
            self.moved.clear();
            self.moved.extend(self.point.iter().map(|&value| [value; LANES]));
            for (lane, secant) in secants.iter().enumerate() {
                self.moved[secant.input][lane] = secant.moved;
            }
            self.system.motion.tape.run(&self.moved, &mut self.there);
            for (lane, secant) in secants.iter().enumerate() {
                let there = self.solve(inverse, &self.there, lane);
                for (row, there) in there.iter().enumerate() {
                    instant.accelerations[row * self.sizes.columns + secant.column] =
                        (there - instant.rate[row]) / secant.by;
                }
            }
        }
    }

    fn wanted_secants(&self, k: usize) -> Vec<Secant> {
        let first = STATES.len() + self.system.inputs.len();
        let parameters = self
            .system
            .columns
            .candidates
            .iter()
            .flat_map(|c| c.at.iter().zip(c.form.parameters.values()));
        let one = |(j, (&value, parameter)): (usize, (&f64, &EffectParameter))| {
            let (input, moved, by) = match (&self.path.delayed[j], self.system.lagged[j]) {
                (Some((longer, by)), Some(input)) => (STATES.len() + input, longer[k], *by),
                _ if value == parameter.absent && parameter.start != parameter.absent => {
                    (first + j, parameter.start, parameter.start - parameter.absent)
                }
                _ => return None,
            };
            Some(Secant { input, moved, by, column: self.system.columns.nuisance.len() + j })
        };
        parameters.enumerate().filter_map(one).collect()
    }

    /// From a sample to the next, by the mean of both ends.
    fn interval(
        &self,
        before: &SampleLinearisation,
        after: &SampleLinearisation,
        (k, next): (usize, usize),
        out: &mut Linearised,
    ) {
        let dt = self.path.record.trial.t_s[next] - self.path.record.trial.t_s[k];
        out.jacobian.extend(means(&before.jacobian, &after.jacobian));
        out.accelerations.extend(means(&before.accelerations, &after.accelerations));
        for (state, rate) in means(&before.rate, &after.rate).enumerate() {
            let moved = self.path.states[state][next] - self.path.states[state][k];
            out.defect.push(dt * rate - moved);
        }
    }

    fn readings(&mut self, k: usize, rate: &[f64], recorded: &[usize], out: &mut Linearised) {
        let system = self.system;
        let mut says: Vec<f64> =
            system.channels.iter().map(|&(_, place)| self.path.states[place][k]).collect();
        if let Some(by_state) = &mut out.by_state {
            let inputs = self.path.instrument_inputs(system, k, &|state| rate[state]);
            let mut work = Slots::default();
            system.instruments.run(&inputs, &mut work);
            system.says.iter().enumerate().for_each(|(output, &place)| {
                says[place] = system.instruments.read(output, &work)[0]
            });
            let jacobian =
                InstrumentJacobian::new(system, &work, inputs.len(), &out.measured, self.detail);
            for &channel in recorded {
                if self.detail == Detail::Whole {
                    by_state.extend(jacobian.by_state(system, channel));
                }
                out.by_column.extend(jacobian.by_column(system, channel));
            }
        }
        for &channel in recorded {
            let said = self.path.said[channel].map_or(0.0, |said| said[k]);
            out.reading.push(said - says[channel]);
        }
    }
}

fn means<'a>(a: &'a [f64], b: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    a.iter().zip(b).map(|(x, y)| 0.5 * (x + y))
}
