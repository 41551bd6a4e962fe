//! Linearisation along a path, one block of samples after the other.

use sistership_model::coefficient::Axis;
use sistership_model::manifest::VelocityFrame;
use sistership_simulation::instruments::THROUGH_WATER;

use super::instruments::InstrumentBlock;
use super::lanes::LANES;
use super::linearised::{LinearisationDetail, LinearisationSizes};
use super::path::RecordedPath;
use super::regressor_block::RegressorBlock;
use super::sample_block::SampleBlock;
use super::secants::ParameterSecants;
use super::tangents::{DerivativeTarget, TangentDirection, tangents};
use super::{LinearisedPart, NuisanceKind, ResidualSystem};

/// State of the tapes at a block of samples.
pub(super) struct PathLineariser<'a> {
    system: &'a ResidualSystem,
    path: &'a RecordedPath<'a>,
    detail: LinearisationDetail,
    sizes: LinearisationSizes,
    block: SampleBlock<'a>,
    tangents: Vec<TangentDirection>,
    secants: ParameterSecants,
    regressors: RegressorBlock,
}

/// The model at a sample.
#[derive(Debug, Clone)]
struct SampleLinearisation {
    rate: Vec<f64>,
    jacobian: Vec<f64>,
    accelerations: Vec<f64>,
}

impl<'a> PathLineariser<'a> {
    pub fn new(
        system: &'a ResidualSystem,
        path: &'a RecordedPath<'a>,
        detail: LinearisationDetail,
    ) -> Self {
        let sizes = LinearisationSizes {
            states: system.state_count(),
            axes: system.axes.len(),
            columns: system.columns.len(),
        };
        let secants = ParameterSecants::new(system, path);
        Self {
            system,
            path,
            detail,
            sizes,
            block: SampleBlock::new(system, path),
            tangents: tangents(system, detail, |parameter| !secants.covers_parameter(parameter)),
            secants,
            regressors: RegressorBlock::new(system),
        }
    }

    pub fn linearise_part(mut self, part: &[usize]) -> LinearisedPart {
        let recorded: Vec<usize> =
            (0..self.system.channels.len()).filter(|&c| self.path.said[c].is_some()).collect();
        let mut out = self.empty_part(part, &recorded);
        // Without readings that differ from a state, the instruments need no tape.
        let mut instruments = (!self.system.says.is_empty())
            .then(|| InstrumentBlock::new(self.system, &out.measured, self.detail));
        // An interval needs both of its ends: the last sample of a block is kept for the first
        // interval of the next one.
        let mut before: Option<SampleLinearisation> = None;
        let mut here = vec![self.zero_sample(); LANES];
        for (block, samples) in part.chunks(LANES).enumerate() {
            self.linearise_block(samples, &mut here);
            if let Some(instruments) = &mut instruments {
                instruments.evaluate(&self.block);
                // Responses to rates are the same at all samples, so the first block gives them.
                if block == 0 && self.system.expected_rates {
                    out.by_rate = instruments.rate_responses(&self.block, &out, &recorded);
                }
            }
            for (lane, &k) in samples.iter().enumerate() {
                let last = if lane > 0 { Some(&here[lane - 1]) } else { before.as_ref() };
                if let Some(last) = last {
                    let from = part[block * LANES + lane - 1];
                    self.push_interval(last, &here[lane], (from, k), &mut out);
                }
                self.push_readings((k, lane), instruments.as_ref(), &recorded, &mut out);
            }
            // Swapped rather than copied: the buffers of `before` are overwritten by the next
            // block.
            std::mem::swap(before.get_or_insert_with(|| here[0].clone()), &mut here[LANES - 1]);
        }
        out
    }

    fn empty_part(&self, part: &[usize], recorded: &[usize]) -> LinearisedPart {
        let trial = self.path.record.trial;
        let (LinearisationSizes { states, axes, columns }, steps) =
            (self.sizes, part.len().saturating_sub(1));
        LinearisedPart {
            samples: part.to_vec(),
            t_s: part.iter().map(|&k| trial.t_s[k]).collect(),
            sizes: self.sizes,
            // Exact capacities: a vector that grows would keep the memory of its last growth.
            jacobian: Vec::with_capacity(steps * states * states),
            accelerations: Vec::with_capacity(steps * axes * columns),
            defect: Vec::with_capacity(steps * states),
            reading: Vec::with_capacity(part.len() * recorded.len()),
            by_state: (!self.system.says.is_empty()).then(Vec::new),
            by_column: Vec::new(),
            measured: self.measuring_columns(),
            by_rate: Vec::new(),
            channels: recorded.iter().map(|&c| self.system.channels[c]).collect(),
            every: self.path.record.every,
        }
    }

    /// Columns of candidates that act on instruments.
    fn measuring_columns(&self) -> Vec<usize> {
        let columns = &self.system.columns;
        let acting = (0..columns.candidates.len())
            .filter(|&c| !columns.candidates[c].form.measures.is_empty());
        // A candidate that depends on the water acts on readings only where a log measures through
        // the water, or where velocities are relative to it.
        let has_log = THROUGH_WATER.iter().any(|&(log, _)| self.path.record.has_channel(log));
        let water = has_log || self.system.frame == VelocityFrame::Water;
        let seeing = (0..columns.candidates.len())
            .filter(|&c| water && !columns.candidates[c].form.sees.is_empty());
        acting.chain(seeing).flat_map(|c| columns.candidate_columns(c)).collect()
    }

    fn zero_sample(&self) -> SampleLinearisation {
        let LinearisationSizes { states, axes, columns } = self.sizes;
        SampleLinearisation {
            rate: vec![0.0; states],
            jacobian: vec![0.0; states * states],
            accelerations: vec![0.0; axes * columns],
        }
    }

    /// Linearises the model at consecutive samples, one per lane.
    fn linearise_block(&mut self, samples: &[usize], out: &mut [SampleLinearisation]) {
        self.block.evaluate_samples(samples);
        if !self.system.columns.nuisance.is_empty() {
            self.regressors.run(&self.system.regressors, &self.block.inputs);
        }
        for (lane, out) in out.iter_mut().enumerate() {
            out.jacobian.fill(0.0);
            out.accelerations.fill(0.0);
            self.block.rate.iter().zip(&mut out.rate).for_each(|(from, to)| *to = from[lane]);
        }
        self.differentiate_tape(out);
        for (lane, out) in out.iter_mut().enumerate() {
            self.add_regressors(lane, out);
        }
        // Secants replace tangents where the derivative at a parameter's value is no use.
        let columns = self.sizes.columns;
        self.secants.evaluate_secants(&self.block, |column, slopes| {
            for (lane, out) in out.iter_mut().enumerate() {
                for (row, slope) in slopes.iter().enumerate() {
                    out.accelerations[row * columns + column] = slope[lane];
                }
            }
        });
        self.apply_correction(out);
    }

    /// Replaces derivatives of the law's accelerations by those of the ship where a learned
    /// correction is attached.
    fn apply_correction(&self, out: &mut [SampleLinearisation]) {
        let Some(correction) = &self.block.correction else { return };
        let LinearisationSizes { states, columns, .. } = self.sizes;
        for (lane, out) in out.iter_mut().enumerate() {
            correction.apply_chain_rule(lane, &mut out.jacobian, states);
            correction.add_velocity_slopes(lane, &mut out.jacobian, states);
            correction.apply_chain_rule(lane, &mut out.accelerations, columns);
        }
        let first = self.system.columns.nuisance.len();
        // A parameter that acts on an input also changes the correction, if that depends on the
        // input.
        for parameter in 0..self.system.followed.len() {
            let Some((input, moved)) = self.block.moved_input(parameter) else { continue };
            for (lane, out) in out.iter_mut().enumerate() {
                let slopes = correction.input_slopes(lane, input).unwrap_or_default();
                for (axis, slope) in slopes.iter().enumerate() {
                    out.accelerations[axis * columns + first + parameter] += slope * moved[lane];
                }
            }
        }
    }

    fn differentiate_tape(&mut self, out: &mut [SampleLinearisation]) {
        // One forward pass of the tape per direction; accelerations follow from forces by the
        // inverse mass matrix, kinematic rates directly.
        let motion = &self.system.motion;
        let LinearisationSizes { states, axes, columns } = self.sizes;
        for TangentDirection { place, direction } in &mut self.tangents {
            motion.tape.differentiate(direction, &self.block.primal, &self.block.slopes);
            let rows = self.block.accelerations_from(direction.tangents());
            match *place {
                DerivativeTarget::Column(column) => {
                    for (lane, out) in out.iter_mut().enumerate() {
                        for (row, value) in rows.iter().enumerate() {
                            out.accelerations[row * columns + column] = value[lane];
                        }
                    }
                }
                DerivativeTarget::State(state) => {
                    let read =
                        |&output: &usize| motion.tape.output_lanes(output, direction.tangents());
                    let rows = rows.into_iter().chain(motion.kinematics.iter().map(read));
                    for (row, value) in rows.enumerate().take(axes + motion.kinematics.len()) {
                        for (lane, out) in out.iter_mut().enumerate() {
                            out.jacobian[row * states + state] = value[lane];
                        }
                    }
                }
            }
        }
    }

    fn add_regressors(&self, lane: usize, out: &mut SampleLinearisation) {
        let LinearisationSizes { axes, columns, .. } = self.sizes;
        let inverse = |row: usize, axis: usize| self.block.inverse[row * axes + axis][lane];
        // Row by row of the inverse mass matrix: dv/dc = M^-1 dF/dc, for columns of one axis at a
        // time.
        for (range, axis) in self.regressors.axis_runs() {
            let forces = &self.regressors.sample_forces(lane)[range.clone()];
            for row in 0..axes {
                let weight = inverse(row, *axis);
                let to = &mut out.accelerations[row * columns..][range.clone()];
                to.iter_mut().zip(forces).for_each(|(to, force)| *to += weight * force);
            }
        }
        for (column, nuisance) in self.system.columns.nuisance.iter().enumerate() {
            // A larger entry of the mass matrix acts as a force against the acceleration.
            let NuisanceKind::Mass(row, other) = nuisance.kind else { continue };
            for (axis, force) in self.mass_forces((row, other), lane) {
                for row in 0..axes {
                    out.accelerations[row * columns + column] += inverse(row, axis) * force;
                }
            }
        }
    }

    /// Forces by which a larger entry of the mass matrix acts, each with the index of its axis.
    fn mass_forces(&self, (row, column): (Axis, Axis), lane: usize) -> Vec<(usize, f64)> {
        let place = |axis: Axis| self.system.axes.iter().position(|&known| known == axis);
        let (Some(i), Some(j)) = (place(row), place(column)) else { return Vec::new() };
        let rate = |axis: usize| self.block.by_law[axis][lane];
        // The unit of a mass column is the root of the product of the diagonal entries.
        let unit = (self.block.diagonal_mass(i)[lane] * self.block.diagonal_mass(j)[lane]).sqrt();
        if i == j {
            vec![(i, -unit * rate(i))]
        } else {
            // Off-diagonal entries act on both axes, as the matrix is symmetric.
            vec![(i, -unit * rate(j)), (j, -unit * rate(i))]
        }
    }

    /// Appends the interval from a sample to the next, by the mean of both ends.
    fn push_interval(
        &self,
        before: &SampleLinearisation,
        after: &SampleLinearisation,
        (k, next): (usize, usize),
        out: &mut LinearisedPart,
    ) {
        let dt = self.path.record.trial.t_s[next] - self.path.record.trial.t_s[k];
        out.jacobian.extend(means(&before.jacobian, &after.jacobian));
        out.accelerations.extend(means(&before.accelerations, &after.accelerations));
        // The trapezoidal rule for the model's movement, less the recorded one.
        for (state, rate) in means(&before.rate, &after.rate).enumerate() {
            let moved = self.path.states[state][next] - self.path.states[state][k];
            out.defect.push(dt * rate - moved);
        }
    }

    /// Appends the readings at a sample, which is in a lane of the block.
    fn push_readings(
        &self,
        (k, lane): (usize, usize),
        instruments: Option<&InstrumentBlock>,
        recorded: &[usize],
        out: &mut LinearisedPart,
    ) {
        let system = self.system;
        let mut says: Vec<f64> =
            system.channels.iter().map(|&(_, place)| self.path.states[place][k]).collect();
        if let (Some(by_state), Some(instruments)) = (&mut out.by_state, instruments) {
            system.says.iter().enumerate().for_each(|(output, &place)| {
                says[place] = instruments.output_reading(system, output)[lane]
            });
            for &channel in recorded {
                by_state.extend(instruments.state_slopes(system, channel, lane));
                out.by_column.extend(instruments.column_slopes(system, channel, lane));
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
