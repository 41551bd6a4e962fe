//! Sufficient statistics of each regression from a trial: one-step differences against regressors.

use std::borrow::Cow;

use sistership_model::coefficient::Axis;
use sistership_model::trial::{Channel, Trial};
use sistership_model::trial_input::{TrialInput, find_input};
use sistership_simulation::tape::{LaneValues, TapeResults};

use super::blocks::{RegressionBlock, RegressionBlocks};
use super::outcome::RefineError;
use sistership_numerics::RegressionMoments;

/// Samples that the tape evaluates together.
pub(super) const LANES: usize = 8;

/// Returns the statistics of one trial, one set for each regression. Accelerations are forward
/// differences over `difference_s` (one sampling interval if it is `None`); no difference crosses a
/// gap.
///
/// # Errors
/// Returns an error with the channel that the trial lacks.
pub fn trial_moments(
    blocks: &RegressionBlocks,
    trial: &Trial,
    difference_s: Option<f64>,
) -> Result<Vec<RegressionMoments>, RefineError> {
    let tables = trial_tables(blocks, trial, difference_s, &|_, _| 0.0)?;
    let pairs = blocks.blocks.iter().zip(&tables);
    Ok(pairs
        .map(|(block, table)| RegressionMoments::from_columns(table, block.regressor_count()))
        .collect())
}

/// Columns of a regression over the samples of a trial: regressors, then targets.
pub type RegressionTable = Vec<Vec<f64>>;

/// Returns the rows behind [`trial_moments`], less accelerations that have a cause outside the law:
/// `known` gives those of an axis at a sample, m/s2 (rad/s2).
///
/// # Errors
/// As [`trial_moments`].
pub fn trial_tables(
    blocks: &RegressionBlocks,
    trial: &Trial,
    difference_s: Option<f64>,
    known: &dyn Fn(Axis, usize) -> f64,
) -> Result<Vec<RegressionTable>, RefineError> {
    let record = RegressionRecord::new(blocks, trial)?;
    let left = |axis: Axis, pair: (usize, usize)| {
        record.axis_acceleration(axis, pair) - known(axis, pair.0)
    };
    Ok(build_tables(blocks, &record, &difference_pairs(trial, difference_s), &left))
}

/// Returns the rows of each regression over the samples of a trial for given accelerations; `known`
/// has those of an axis.
///
/// # Errors
/// As [`trial_moments`].
pub(super) fn known_tables<'k>(
    blocks: &RegressionBlocks,
    trial: &Trial,
    known: &dyn Fn(Axis) -> &'k [f64],
) -> Result<Vec<RegressionTable>, RefineError> {
    let record = RegressionRecord::new(blocks, trial)?;
    let samples: Vec<(usize, usize)> = (0..trial.len()).map(|k| (k, k)).collect();
    Ok(build_tables(blocks, &record, &samples, &|axis, (k, _)| known(axis)[k]))
}

/// The acceleration of an axis at a pair of samples.
type AccelerationFn<'a> = &'a dyn Fn(Axis, (usize, usize)) -> f64;

/// The rows of each regression over pairs of samples; regressors are evaluated at the first of a
/// pair.
fn build_tables(
    blocks: &RegressionBlocks,
    record: &RegressionRecord<'_>,
    pairs: &[(usize, usize)],
    acceleration: AccelerationFn<'_>,
) -> Vec<RegressionTable> {
    // The tape evaluates a chunk of samples in the lanes of a vector.
    let mut tables: Vec<RegressionTable> = blocks
        .blocks
        .iter()
        .map(|b| vec![Vec::with_capacity(pairs.len()); b.column_count()])
        .collect();
    let mut work = TapeResults::default();
    let mut lanes = vec![[0.0; LANES]; record.columns.len()];
    for chunk in pairs.chunks(LANES) {
        record.load_lanes(chunk, &mut lanes);
        blocks.tape.evaluate(&lanes, &mut work);
        for (block, table) in blocks.blocks.iter().zip(&mut tables) {
            append_rows(blocks, block, acceleration, chunk, &work, table);
        }
    }
    tables
}

/// Pairs of samples for differences: each sample with the one `difference_s` later in the same
/// part.
fn difference_pairs(trial: &Trial, difference_s: Option<f64>) -> Vec<(usize, usize)> {
    // At least one sampling interval, whatever the time is.
    let stride = difference_s.map_or(1, |s| (s / trial.interval_s()).round().max(1.0) as usize);
    let within = |segment: std::ops::Range<usize>| {
        (segment.start..segment.end.saturating_sub(stride)).map(move |k| (k, k + stride))
    };
    trial.segments().into_iter().flat_map(within).collect()
}

/// The channels of a trial that regressions read.
pub(super) struct RegressionRecord<'a> {
    t_s: &'a [f64],
    /// Inputs of the tape.
    pub(super) columns: Vec<TrialInput<'a>>,
    /// Velocities by axis.
    velocities: [Option<&'a [f64]>; 4],
}

impl<'a> RegressionRecord<'a> {
    /// Reads the channels that the regressions of a law need: velocities always, roll for laws with
    /// roll, inputs as recorded or at their defaults.
    pub(super) fn new(blocks: &RegressionBlocks, trial: &'a Trial) -> Result<Self, RefineError> {
        let need = |channel: Channel| {
            trial
                .channel(channel)
                .ok_or_else(|| RefineError::Channel { trial: trial.name.clone(), channel })
        };
        let recorded = |column: &'a [f64]| TrialInput::Samples(Cow::Borrowed(column));
        let mut columns = vec![
            recorded(need(Channel::U)?),
            recorded(need(Channel::V)?),
            recorded(need(Channel::R)?),
        ];
        // Roll and heading are zero where a law does not need them; laws with roll check them
        // below.
        let or_zero =
            |channel: Channel| trial.channel(channel).map_or(TrialInput::Constant(0.0), recorded);
        columns.extend([Channel::P, Channel::Phi, Channel::Psi].map(or_zero));
        for (name, default) in &blocks.inputs {
            columns.push(find_input(trial, name, *default)?);
        }
        let roll = blocks.blocks.iter().any(|block| block.columns.contains(&Axis::K));
        if roll {
            need(Channel::P)?;
            need(Channel::Phi)?;
        }
        let velocities =
            [Channel::U, Channel::V, Channel::P, Channel::R].map(|channel| trial.channel(channel));
        Ok(Self { t_s: &trial.t_s, columns, velocities })
    }

    /// Loads the first samples of a chunk of pairs into lanes; a short chunk repeats its last
    /// sample.
    pub(super) fn load_lanes(&self, chunk: &[(usize, usize)], lanes: &mut [LaneValues<LANES>]) {
        for (lane, column) in lanes.iter_mut().zip(&self.columns) {
            *lane = std::array::from_fn(|i| {
                let (k, _) = chunk[i.min(chunk.len() - 1)];
                match column {
                    TrialInput::Samples(samples) => samples[k],
                    TrialInput::Constant(value) => *value,
                }
            });
        }
    }

    /// The velocity of an axis; empty if it is not recorded.
    pub(super) fn axis_velocity(&self, axis: Axis) -> &'a [f64] {
        self.velocities[axis as usize].unwrap_or_default()
    }

    /// The acceleration of an axis between two samples, m/s2 (rad/s2); 0 if the velocity is not
    /// recorded.
    fn axis_acceleration(&self, axis: Axis, (k, later): (usize, usize)) -> f64 {
        let velocity = self.velocities[axis as usize].unwrap_or_default();
        match (velocity.get(later), velocity.get(k)) {
            (Some(after), Some(before)) => (after - before) / (self.t_s[later] - self.t_s[k]),
            _ => 0.0,
        }
    }
}

/// Appends the rows of a chunk to a block's table.
fn append_rows(
    blocks: &RegressionBlocks,
    block: &RegressionBlock,
    acceleration: AccelerationFn<'_>,
    chunk: &[(usize, usize)],
    work: &[LaneValues<LANES>],
    table: &mut [Vec<f64>],
) {
    let read = |output: usize| blocks.tape.output_lanes(output, work);
    // A single uncoupled axis is divided by its mass, so that its target is an acceleration.
    let own_mass =
        if block.is_force() || block.axes.len() > 1 { None } else { block.mass[0][0].map(read) };
    let scale = read(block.scales[0]);
    let divided = |value: f64, lane: usize| own_mass.map_or(value, |mass| value / mass[lane]);
    for (column, &term) in table.iter_mut().zip(&block.terms) {
        let term = read(term);
        column.extend((0..chunk.len()).map(|lane| divided(scale[lane] * term[lane], lane)));
    }
    let targets = &mut table[block.terms.len()..];
    for (lane, &pair) in chunk.iter().enumerate() {
        let values = target_values(blocks, block, acceleration, pair, work, lane);
        for (column, value) in targets.iter_mut().zip(values.iter()) {
            column.push(divided(*value, lane));
        }
    }
}

/// The targets at a sample: mass times acceleration less the rest; for axes that are solved
/// together, accelerations less those that the rests cause.
fn target_values(
    blocks: &RegressionBlocks,
    block: &RegressionBlock,
    acceleration: AccelerationFn<'_>,
    pair: (usize, usize),
    work: &[LaneValues<LANES>],
    lane: usize,
) -> nalgebra::DVector<f64> {
    let read = |output: usize| blocks.tape.output_lanes(output, work)[lane];
    let q = block.axes.len();
    let added = |place: usize| block.additions[place].map_or(0.0, read);
    let moved = |place: usize| acceleration(block.columns[place], pair) - added(place);
    let rests = nalgebra::DVector::from_iterator(q, block.rests.iter().map(|&rest| read(rest)));
    if q == 1 {
        let inertia: f64 = block.mass[0]
            .iter()
            .enumerate()
            .filter_map(|(place, mass)| Some(read((*mass)?) * moved(place)))
            .sum();
        return nalgebra::DVector::from_element(1, inertia - rests[0]);
    }
    let accelerations = nalgebra::DVector::from_iterator(q, (0..q).map(moved));
    // Without rests no scale is divided by, which may be zero at rest.
    if rests.iter().all(|rest| *rest == 0.0) {
        return accelerations;
    }
    // `M^-1 rest` from the mixing matrix `M^-1 diag(scale_k / scale_0)`: rests are divided by the
    // ratios first.
    let ratios: Vec<f64> =
        block.scales.iter().map(|&scale| read(scale) / read(block.scales[0])).collect();
    let unscaled = nalgebra::DVector::from_iterator(
        q,
        rests.iter().zip(&ratios).map(|(rest, ratio)| rest / ratio),
    );
    accelerations - &block.mixing * unscaled
}
