//! The parts of a regression at every sample of a trial: regressors, masses with the velocities
//! they multiply, and rests.

use std::borrow::Cow;

use nalgebra::DVector;
use sistership_model::trial::Trial;
use sistership_simulation::tape::{LaneValues, TapeResults};

use super::super::blocks::{RegressionBlock, RegressionBlocks};
use super::super::outcome::RefineError;
use super::super::rows::{LANES, RegressionRecord};

/// One regression's columns over the samples of a trial.
pub(super) struct SampledRegression<'a> {
    /// Regressors with scale.
    pub regressors: Vec<Vec<f64>>,
    /// Targets.
    pub targets: Vec<RegressionTarget<'a>>,
}

/// A mass, 1 where absent, with the velocity it multiplies.
pub(super) type InertialTerm<'a> = (Option<Vec<f64>>, Cow<'a, [f64]>);

/// The parts of a target.
pub(super) struct RegressionTarget<'a> {
    /// Masses, 1 where absent, and velocities whose rate of change they multiply.
    pub inertia: Vec<InertialTerm<'a>>,
    /// Known part of the right-hand side.
    pub rest: Vec<f64>,
}

/// Returns the columns of every regression of a law over a trial.
pub(super) fn sample_columns<'a>(
    blocks: &RegressionBlocks,
    trial: &'a Trial,
) -> Result<Vec<SampledRegression<'a>>, RefineError> {
    let record = RegressionRecord::new(blocks, trial)?;
    let mut all: Vec<SampledRegression<'a>> = blocks
        .blocks
        .iter()
        .map(|block| SampledRegression::new(block, &record, trial.len()))
        .collect();
    let mut lanes = vec![[0.0; LANES]; record.columns.len()];
    let mut work = TapeResults::default();
    // The record loads pairs of samples; a pair of the same sample is that sample.
    let samples: Vec<(usize, usize)> = (0..trial.len()).map(|k| (k, k)).collect();
    for chunk in samples.chunks(LANES) {
        record.load_lanes(chunk, &mut lanes);
        blocks.tape.evaluate(&lanes, &mut work);
        for (block, columns) in blocks.blocks.iter().zip(&mut all) {
            columns.append_chunk(blocks, block, &work);
        }
    }
    all.iter_mut().for_each(|columns| columns.truncate(trial.len()));
    Ok(all)
}

impl<'a> SampledRegression<'a> {
    fn new(block: &RegressionBlock, record: &RegressionRecord<'a>, samples: usize) -> Self {
        let velocity = |axis| Cow::Borrowed(record.axis_velocity(axis));
        // The last chunk is appended whole before it is truncated.
        let room = || Vec::with_capacity(samples + LANES);
        let target = |own| RegressionTarget {
            inertia: match block.axes.len() {
                1 => {
                    let with_mass =
                        block.mass[0].iter().zip(&block.columns).filter(|(mass, _)| mass.is_some());
                    with_mass.map(|(_, &axis)| (Some(room()), velocity(axis))).collect()
                }
                _ => vec![(None, velocity(own))],
            },
            rest: room(),
        };
        let targets = block.axes.iter().map(|&axis| target(axis)).collect();
        Self { regressors: vec![room(); block.regressor_count()], targets }
    }

    /// Appends all lanes of a chunk, also those beyond the last sample of a short chunk; `truncate`
    /// removes these.
    fn append_chunk(
        &mut self,
        blocks: &RegressionBlocks,
        block: &RegressionBlock,
        work: &[LaneValues<LANES>],
    ) {
        let read = |output: usize| blocks.tape.output_lanes(output, work);
        let own_mass = if block.is_force() || block.axes.len() > 1 {
            None
        } else {
            block.mass[0][0].map(read)
        };
        let divided = |value: LaneValues<LANES>| -> LaneValues<LANES> {
            own_mass.map_or(value, |mass| std::array::from_fn(|lane| value[lane] / mass[lane]))
        };
        let scale = read(block.scales[0]);
        for (column, &term) in self.regressors.iter_mut().zip(&block.terms) {
            let term = read(term);
            column.extend(divided(std::array::from_fn(|lane| scale[lane] * term[lane])));
        }
        // A regression of one axis keeps mass and velocity apart, since the mass may change during
        // a window.
        if let [target] = self.targets.as_mut_slice() {
            let masses = block.mass[0].iter().flatten();
            for ((column, _), &mass) in target.inertia.iter_mut().zip(masses) {
                column.get_or_insert_default().extend(divided(read(mass)));
            }
            target.rest.extend(divided(read(block.rests[0])));
            return;
        }
        self.append_rests(block, &read);
    }

    /// Truncates every column to the number of samples.
    fn truncate(&mut self, samples: usize) {
        self.regressors.iter_mut().for_each(|column| column.truncate(samples));
        for target in &mut self.targets {
            target.rest.truncate(samples);
            target
                .inertia
                .iter_mut()
                .filter_map(|(mass, _)| mass.as_mut())
                .for_each(|mass| mass.truncate(samples));
        }
    }

    /// Appends the accelerations that the rests of coupled axes cause.
    fn append_rests(&mut self, block: &RegressionBlock, read: &dyn Fn(usize) -> LaneValues<LANES>) {
        let (scales, rests): (Vec<_>, Vec<_>) =
            block.scales.iter().zip(&block.rests).map(|(&s, &r)| (read(s), read(r))).unzip();
        for lane in 0..LANES {
            let unscaled = rests.iter().zip(&scales).map(|(rest, scale)| match rest[lane] {
                0.0 => 0.0,
                rest => rest * scales[0][lane] / scale[lane],
            });
            let caused = &block.mixing * DVector::from_iterator(rests.len(), unscaled);
            self.targets
                .iter_mut()
                .zip(caused.iter())
                .for_each(|(target, value)| target.rest.push(*value));
        }
    }
}
