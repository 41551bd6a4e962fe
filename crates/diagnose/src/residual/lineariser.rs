//! Along a path, sample by sample.

use nalgebra::DMatrix;
use sistership_dynamics::state::at;
use sistership_dynamics::tape::{Lanes, Slot, Slots};
use sistership_model::coefficient::Axis;
use sistership_model::law::STATES;

use super::instruments::{InstrumentJacobian, LANES};
use super::linearised::{Detail, Sizes};
use super::path::RecordedPath;
use super::{Linearised, NuisanceKind, ResidualSystem};

/// Where the tapes stand at a sample.
pub(super) struct PathLineariser<'a> {
    system: &'a ResidualSystem,
    path: &'a RecordedPath<'a>,
    detail: Detail,
    sizes: Sizes,
    point: Vec<f64>,
    primal: Slots<1>,
    sweeps: Vec<TangentSweep>,
}

/// What a direction of differentiation moves, and where its derivative goes.
#[derive(Debug, Clone, Copy)]
enum TangentSeed {
    /// Input of the tape; state of the filter.
    State(usize, usize),
    /// Input of the tape; column.
    Parameter(usize, usize),
}

impl TangentSeed {
    fn input(self) -> usize {
        let (Self::State(input, _) | Self::Parameter(input, _)) = self;
        input
    }
}

/// Directions that are differentiated together, with the part of the tape that they reach.
struct TangentSweep {
    seeds: Vec<TangentSeed>,
    lanes: Vec<Lanes<LANES>>,
    reached: Vec<Slot>,
    tangents: Slots<LANES>,
}

impl TangentSweep {
    fn new(system: &ResidualSystem, seeds: &[TangentSeed]) -> Self {
        let tape = &system.motion.tape;
        let mut lanes = vec![[0.0; LANES]; tape.inputs().len()];
        seeds.iter().enumerate().for_each(|(lane, seed)| lanes[seed.input()][lane] = 1.0);
        let inputs: Vec<usize> = seeds.iter().map(|seed| seed.input()).collect();
        Self {
            seeds: seeds.to_vec(),
            lanes,
            reached: tape.depending_on(&inputs),
            tangents: Slots::default(),
        }
    }
}

/// The model at a sample.
struct SampleLinearisation {
    rate: Vec<f64>,
    jacobian: Vec<f64>,
    accelerations: Vec<f64>,
}

impl<'a> PathLineariser<'a> {
    pub fn new(system: &'a ResidualSystem, path: &'a RecordedPath<'a>, detail: Detail) -> Self {
        let sizes = Sizes {
            states: system.order(),
            axes: system.axes.len(),
            columns: system.columns.len(),
        };
        let states = STATES.iter().enumerate().filter_map(|(input, (name, _))| {
            let place = place_of(name);
            Some(TangentSeed::State(input, system.states.iter().position(|&state| state == place)?))
        });
        let states: Vec<TangentSeed> = states.filter(|_| detail == Detail::Whole).collect();
        let first = STATES.len() + system.inputs.len();
        let parameters = (0..system.lagged.len())
            .map(|j| TangentSeed::Parameter(first + j, system.columns.nuisance.len() + j));
        let parameters: Vec<TangentSeed> = parameters.collect();
        let sweeps = states
            .chunks(LANES)
            .chain(parameters.chunks(LANES))
            .map(|seeds| TangentSweep::new(system, seeds))
            .collect();
        Self { system, path, detail, sizes, point: Vec::new(), primal: Slots::default(), sweeps }
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
        let acting = (0..columns.candidates.len())
            .filter(|&c| !columns.candidates[c].form.measures.is_empty());
        let water = self.system.frame == sistership_model::manifest::VelocityFrame::Water;
        let seeing = (0..columns.candidates.len())
            .filter(|&c| water && !columns.candidates[c].form.sees.is_empty());
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

    fn instant(&mut self, k: usize) -> SampleLinearisation {
        self.load(k);
        self.run();
        let inverse = self.inverse_mass();
        let mut rate = self.solve(&inverse);
        rate.extend(self.system.motion.kinematics.iter().map(|&output| self.read(output)));
        let Sizes { states, axes, columns } = self.sizes;
        let mut instant = SampleLinearisation {
            rate,
            jacobian: vec![0.0; states * states],
            accelerations: vec![0.0; axes * columns],
        };
        self.differentiate(&inverse, &mut instant);
        self.regressors(&inverse, &mut instant);
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

    fn regressors(&mut self, inverse: &DMatrix<f64>, instant: &mut SampleLinearisation) {
        if self.system.columns.nuisance.is_empty() {
            return;
        }
        let inputs: Vec<Lanes<1>> = self.point.iter().map(|&value| [value]).collect();
        let mut work = Slots::default();
        self.system.regressors.run(&inputs, &mut work);
        for (column, nuisance) in self.system.columns.nuisance.iter().enumerate() {
            let forces = match nuisance.kind {
                NuisanceKind::Mass(row, other) => self.heavier((row, other), &instant.rate),
                kind => vec![(kind.axis(), self.system.regressors.read(column, &work)[0])],
            };
            for (axis, force) in forces {
                let Some(axis) = self.system.axes.iter().position(|&known| known == axis) else {
                    continue;
                };
                for row in 0..self.sizes.axes {
                    instant.accelerations[row * self.sizes.columns + column] +=
                        inverse[(row, axis)] * force;
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
        let first = STATES.len() + self.system.inputs.len();
        let parameters = self
            .system
            .columns
            .candidates
            .iter()
            .flat_map(|c| c.at.iter().zip(c.form.parameters.values()));
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
                instant.accelerations[row * self.sizes.columns + column] =
                    (there - instant.rate[row]) / by;
            }
        }
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
        let mean = |a: &[f64], b: &[f64]| {
            a.iter().zip(b).map(|(x, y)| 0.5 * (x + y)).collect::<Vec<f64>>()
        };
        out.jacobian.extend(mean(&before.jacobian, &after.jacobian));
        out.accelerations.extend(mean(&before.accelerations, &after.accelerations));
        for (state, rate) in mean(&before.rate, &after.rate).into_iter().enumerate() {
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
