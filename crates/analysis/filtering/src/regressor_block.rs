//! Forces by which coefficients act, at consecutive samples.

use std::ops::Range;

use sistership_simulation::tape::{LaneValues, Tape, TapeResults};

use super::lanes::LANES;
use super::{NuisanceKind, ResidualSystem};

/// Regressors at up to [`LANES`] samples together: there are hundreds of them, and in lanes they
/// cost little more than at one sample.
pub(super) struct RegressorBlock {
    columns: usize,
    /// Runs of adjacent columns that act on one axis of the filter, with its index; masses and
    /// columns of another axis are excluded.
    alike: Vec<(Range<usize>, usize)>,
    forces: TapeResults<LANES>,
    /// N or N m per unit: sample by sample, column by column.
    by_sample: Vec<f64>,
}

impl RegressorBlock {
    pub fn new(system: &ResidualSystem) -> Self {
        let columns = system.columns.nuisance.len();
        let (forces, by_sample) = (TapeResults::default(), Vec::new());
        Self { columns, alike: find_axis_runs(system), forces, by_sample }
    }

    /// Evaluates the regressors at the points of a block, given as inputs of the tape of motion.
    pub fn run(&mut self, regressors: &Tape, inputs: &[LaneValues<LANES>]) {
        regressors.evaluate(inputs, &mut self.forces);
        // Transposed from columns of lanes to samples, so that the forces of a sample are
        // contiguous.
        self.by_sample.resize(LANES * self.columns, 0.0);
        for column in 0..self.columns {
            let forces = regressors.output_lanes(column, &self.forces);
            (0..LANES).for_each(|k| self.by_sample[k * self.columns + column] = forces[k]);
        }
    }

    /// Runs of columns that act on one axis.
    pub fn axis_runs(&self) -> &[(Range<usize>, usize)] {
        &self.alike
    }

    /// Forces at a sample, by column.
    pub fn sample_forces(&self, lane: usize) -> &[f64] {
        &self.by_sample[lane * self.columns..][..self.columns]
    }
}

fn find_axis_runs(system: &ResidualSystem) -> Vec<(Range<usize>, usize)> {
    let mut alike: Vec<(Range<usize>, usize)> = Vec::new();
    for (column, nuisance) in system.columns.nuisance.iter().enumerate() {
        let place = system.axes.iter().position(|&known| known == nuisance.kind.axis());
        let is_mass = matches!(nuisance.kind, NuisanceKind::Mass(..));
        let Some(axis) = place.filter(|_| !is_mass) else { continue };
        match alike.last_mut() {
            Some((range, last)) if *last == axis && range.end == column => range.end += 1,
            _ => alike.push((column..column + 1, axis)),
        }
    }
    alike
}
