//! The filter and the smoother against the joint normal distribution of all states and readings of
//! a short record, conditioned densely: no recursion, and none of the filter's own arithmetic.
#![allow(clippy::unwrap_used)]

use std::ops::AddAssign;

use nalgebra::{DMatrix, DVector};
use sistership_model::trial::Channel;
use sistership_model::uncertainty::Discrepancy;

use super::super::filter::{column_responses, prediction_errors, whiten_part};
use super::super::filter_gains::FilterGains;
use super::super::likelihood::part_deviances;
use super::super::linearised::{LinearisationSizes, RateResponse};
use super::super::noise::NoiseLevel;
use super::super::thresholds::RESIDUAL;
use super::*;

const STATES: usize = 3;
const AXES: usize = 2;
const COLUMNS: usize = 2;
const ORDER: usize = STATES + AXES;

/// Numbers between -1 and 1 that look random (Knuth, The Art of Computer Programming 2, 3.3.4).
fn numbers(count: usize, size: f64, seed: u64) -> Vec<f64> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..count).map(|_| size * next()).collect()
}

/// A record of so many samples, of which some are missing: from the fourth to the fifth it is three
/// times as long as between the others.
fn record(samples: usize, every: usize, channels: &[(Channel, usize)]) -> LinearisedPart {
    let (readings, seed) = (samples * channels.len(), 11 + samples as u64);
    LinearisedPart {
        samples: (0..samples).collect(),
        t_s: (0..samples).map(|k| 0.5 * k as f64 + if k > 3 { 1.0 } else { 0.0 }).collect(),
        sizes: LinearisationSizes { states: STATES, axes: AXES, columns: COLUMNS },
        jacobian: numbers(STATES * STATES * samples, 0.3, seed),
        accelerations: numbers(AXES * COLUMNS * samples, 0.5, seed + 1),
        defect: numbers(STATES * samples, 0.1, seed + 2),
        reading: numbers(readings, 0.5, seed + 3),
        by_state: None,
        by_column: numbers(readings, 0.4, seed + 4),
        measured: vec![1],
        by_rate: Vec::new(),
        channels: channels.to_vec(),
        every,
    }
}

/// The same by instruments that say mixtures of states.
fn mixed(part: LinearisedPart) -> LinearisedPart {
    LinearisedPart { by_state: Some(numbers(STATES * part.reading.len(), 1.0, 5)), ..part }
}

fn noise() -> InstrumentNoise {
    let instrument = |deviation: f64, drift: f64| NoiseLevel { deviation, drift };
    let all = [
        (Channel::U, instrument(0.2, 0.02)),
        (Channel::V, instrument(0.3, 0.05)),
        (Channel::R, instrument(0.1, 0.04)),
    ];
    all.into_iter().collect()
}

fn discrepancies() -> AxisDiscrepancies {
    vec![
        Discrepancy { deviation: 0.3, time_s: 2.0, white: 0.1 },
        Discrepancy { deviation: 0.2, time_s: 5.0, white: 0.05 },
    ]
}

const BOTH: [(Channel, usize); 3] = [(Channel::U, 0), (Channel::V, 1), (Channel::R, 2)];

/// Records with missing samples, with readings at every third sample, with a state that is not
/// read, and with mixed readings.
fn records() -> Vec<LinearisedPart> {
    vec![
        record(7, 1, &BOTH),
        record(10, 3, &BOTH),
        record(8, 1, &BOTH[..2]),
        mixed(record(6, 1, &BOTH)),
        mixed(record(7, 2, &BOTH[1..])),
    ]
}

/// States and discrepancies of all samples, one after the other, before any reading: means, and
/// what they are for a unit of each column.
struct DensePrior {
    mean: DVector<f64>,
    by_column: DMatrix<f64>,
    covariance: DMatrix<f64>,
    /// Readings by states and discrepancies.
    reads: DMatrix<f64>,
    reading: DVector<f64>,
    reading_by_column: DMatrix<f64>,
    reading_variance: DVector<f64>,
}

impl DensePrior {
    fn new(part: &LinearisedPart) -> Self {
        let count = part.samples.len();
        let size = ORDER * count;
        let mut mean = DVector::zeros(size);
        let mut by_column = DMatrix::zeros(size, COLUMNS);
        // What every sample is made of: the start, and the noise of each interval.
        let mut made = DMatrix::<f64>::zeros(size, size);
        let mut variance = DVector::zeros(size);
        made.view_mut((0, 0), (ORDER, ORDER)).fill_with_identity();
        variance.rows_mut(0, ORDER).copy_from(&start_variance(part));
        for k in 1..count {
            let (from, to) = (ORDER * (k - 1), ORDER * k);
            let (transition, caused) = interval(part, k - 1);
            let defect = DVector::from_column_slice(&part.defect[STATES * (k - 1)..][..STATES]);
            let mut next = &transition * mean.rows(from, ORDER);
            next.rows_mut(0, STATES).add_assign(&defect);
            mean.rows_mut(to, ORDER).copy_from(&next);
            let mut next = &transition * by_column.rows(from, ORDER);
            next.rows_mut(0, STATES).add_assign(&caused);
            by_column.rows_mut(to, ORDER).copy_from(&next);
            let next = &transition * made.rows(from, ORDER);
            made.rows_mut(to, ORDER).copy_from(&next);
            made.view_mut((to, to), (ORDER, ORDER)).fill_with_identity();
            variance.rows_mut(to, ORDER).copy_from(&interval_variance(part, k - 1));
        }
        let covariance = &made * DMatrix::from_diagonal(&variance) * made.transpose();
        let (reads, reading, reading_by_column, reading_variance) = readings(part);
        Self { mean, by_column, covariance, reads, reading, reading_by_column, reading_variance }
    }

    /// Residuals of readings, and how readings go with columns.
    fn residuals(&self) -> (DVector<f64>, DMatrix<f64>) {
        (
            &self.reading - &self.reads * &self.mean,
            &self.reading_by_column + &self.reads * &self.by_column,
        )
    }

    fn reading_covariance(&self) -> DMatrix<f64> {
        &self.reads * &self.covariance * self.reads.transpose()
            + DMatrix::from_diagonal(&self.reading_variance)
    }

    /// Mean and covariance of everything after all readings.
    fn posterior(&self) -> (DVector<f64>, DMatrix<f64>) {
        let cross = &self.covariance * self.reads.transpose();
        let gain = self.reading_covariance().lu().solve(&cross.transpose()).unwrap().transpose();
        let mean = &self.mean + &gain * self.residuals().0;
        (mean, &self.covariance - gain * cross.transpose())
    }
}

fn start_variance(part: &LinearisedPart) -> DVector<f64> {
    let of = |place: usize| match place.checked_sub(STATES) {
        Some(axis) => discrepancies()[axis].deviation.powi(2),
        None => part
            .channels
            .iter()
            .find(|(_, state)| *state == place)
            .map_or(RESIDUAL.unread_variance, |(channel, _)| {
                (RESIDUAL.start * noise()[channel].deviation).powi(2)
            }),
    };
    DVector::from_fn(ORDER, |place, _| of(place))
}

/// Transition of states and discrepancies, and what columns cause of states.
fn interval(part: &LinearisedPart, k: usize) -> (DMatrix<f64>, DMatrix<f64>) {
    let dt = part.t_s[k + 1] - part.t_s[k];
    let a = DMatrix::from_row_slice(STATES, STATES, &part.jacobian[9 * k..][..9]);
    let unit = DMatrix::<f64>::identity(STATES, STATES);
    let accelerated = (&unit + &a * (0.5 * dt)) * unit.columns(0, AXES) * dt;
    let mut transition = DMatrix::zeros(ORDER, ORDER);
    transition
        .view_mut((0, 0), (STATES, STATES))
        .copy_from(&(&unit + &a * dt + &a * &a * (0.5 * dt * dt)));
    transition.view_mut((0, STATES), (STATES, AXES)).copy_from(&accelerated);
    for axis in 0..AXES {
        transition[(STATES + axis, STATES + axis)] = (-dt / discrepancies()[axis].time_s).exp();
    }
    let block = AXES * COLUMNS;
    let columns = DMatrix::from_row_slice(AXES, COLUMNS, &part.accelerations[block * k..][..block]);
    (transition, accelerated * columns)
}

fn interval_variance(part: &LinearisedPart, k: usize) -> DVector<f64> {
    let dt = part.t_s[k + 1] - part.t_s[k];
    let all = discrepancies();
    let drift = |state: usize| {
        let channel = part.channels.iter().find(|(_, place)| *place == state);
        channel.map_or(RESIDUAL.unread_drift, |(channel, _)| noise()[channel].drift).powi(2)
    };
    let of = |place: usize| match place.checked_sub(STATES) {
        Some(axis) => {
            let kept = (-dt / all[axis].time_s).exp();
            all[axis].deviation.powi(2) * (1.0 - kept * kept)
        }
        None => dt * (drift(place) + all.get(place).map_or(0.0, |own| own.white.powi(2))),
    };
    DVector::from_fn(ORDER, |place, _| of(place))
}

/// All readings: by states, as they are, by columns, and their variances.
fn readings(part: &LinearisedPart) -> (DMatrix<f64>, DVector<f64>, DMatrix<f64>, DVector<f64>) {
    let count = part.samples.len();
    let channels = part.channels.len();
    let read: Vec<(usize, usize)> = (0..count)
        .filter(|k| k.is_multiple_of(part.every))
        .flat_map(|k| (0..channels).map(move |channel| (k, channel)))
        .collect();
    let rows = read.len();
    let mut reads = DMatrix::zeros(rows, ORDER * count);
    for (row, &(k, channel)) in read.iter().enumerate() {
        match &part.by_state {
            None => reads[(row, ORDER * k + part.channels[channel].1)] = 1.0,
            Some(by) => (0..STATES).for_each(|state| {
                reads[(row, ORDER * k + state)] = by[(k * channels + channel) * STATES + state];
            }),
        }
    }
    let at = |row: usize| read[row].0 * channels + read[row].1;
    let deviation = |row: usize| noise()[&part.channels[read[row].1].0].deviation;
    (
        reads,
        DVector::from_fn(rows, |row, _| part.reading[at(row)]),
        DMatrix::from_fn(rows, COLUMNS, |row, column| match column {
            1 => part.by_column[at(row)],
            _ => 0.0,
        }),
        DVector::from_fn(rows, |row, _| deviation(row).powi(2)),
    )
}

fn assert_near(own: f64, dense: f64, scale: f64, what: &str) {
    assert!((own - dense).abs() < 1e-7 * (scale + dense.abs()), "{what}: {own} not {dense}");
}

/// One reading after the other is whitened by the rows of the inverse root of their covariance.
#[test]
fn innovations_and_columns_are_those_of_the_joint_distribution() {
    for part in records() {
        let dense = DensePrior::new(&part);
        let root = dense.reading_covariance().cholesky().unwrap().l();
        let (residual, columns) = dense.residuals();
        let innovations = root.solve_lower_triangular(&residual).unwrap();
        let columns = root.solve_lower_triangular(&columns).unwrap();
        let (rows, log_variance) = whiten_part(&part, &noise(), &discrepancies()).unwrap();
        assert_eq!(rows.len(), innovations.len() * (1 + COLUMNS));
        for (place, row) in rows.chunks_exact(1 + COLUMNS).enumerate() {
            assert_near(row[0], innovations[place], 1.0, "innovation");
            for column in 0..COLUMNS {
                assert_near(row[1 + column], columns[(place, column)], 1.0, "column");
            }
        }
        let dense: f64 = root.diagonal().iter().map(|d| 2.0 * d.ln()).sum();
        assert_near(log_variance, dense, 1.0, "logarithm of the determinant");
    }
}

/// Products by the adjoint of the filter are those of columns that have passed it.
#[test]
fn products_by_the_adjoint_are_those_of_the_forward_pass() {
    for part in records() {
        // Columns of the adjoint act on no instrument.
        let part = LinearisedPart { by_column: Vec::new(), measured: Vec::new(), ..part };
        let gains = FilterGains::new(&part, &noise(), &discrepancies()).unwrap();
        let whitened = gains.whiten_columns(&part, COLUMNS);
        let all = whitened.reading_count();
        for readings in [0..all, all / 3..all / 2 + 1] {
            let forward = whitened.own_products(readings.clone());
            let adjoint = gains.column_products(&part, &whitened, readings);
            assert_eq!(adjoint.shape(), (COLUMNS, 1 + COLUMNS));
            assert!((&adjoint - forward.rows(1, COLUMNS)).amax() < 1e-12 * forward.amax());
        }
    }
}

/// Minus twice the logarithm of a multivariate normal density, less `n ln 2 pi`; parts together in
/// lanes and alone.
#[test]
fn the_likelihood_is_that_of_the_joint_distribution() {
    let parameters = [0.7, -0.4];
    let records = records();
    let along: Vec<LinearisedPart> =
        records.iter().map(|part| part.combine_columns(&parameters)).collect();
    let each: Vec<&LinearisedPart> = along.iter().chain(&along).collect();
    let found = part_deviances(&each, &noise(), &discrepancies()).unwrap();
    for (place, part) in records.iter().chain(&records).enumerate() {
        let dense = DensePrior::new(part);
        let covariance = dense.reading_covariance();
        let (residual, columns) = dense.residuals();
        let residual = residual - columns * DVector::from_column_slice(&parameters);
        let square = residual.dot(&covariance.clone().lu().solve(&residual).unwrap());
        let deviance = square + covariance.determinant().ln();
        assert_near(found[place], deviance, 1.0, "deviance");
    }
    for part in &along {
        let (errors, _) = prediction_errors(part, &noise(), &discrepancies()).unwrap();
        let (rows, _) = whiten_part(part, &noise(), &discrepancies()).unwrap();
        let caused = column_responses(part, &noise(), &discrepancies()).unwrap();
        for (k, row) in rows.chunks_exact(2).enumerate() {
            assert_eq!((errors[k], caused[k]), (row[0] - row[1], row[1]));
        }
    }
}

#[test]
fn smoothed_states_are_those_of_the_joint_distribution() {
    for part in records() {
        let (mean, covariance) = DensePrior::new(&part).posterior();
        let all = smoothed_states(&part, &noise(), &discrepancies()).unwrap();
        assert_eq!(all.len(), part.samples.len());
        for (k, state) in all.iter().enumerate() {
            let dense = covariance.view((ORDER * k, ORDER * k), (ORDER, ORDER));
            for i in 0..ORDER {
                assert_near(state.mean[i], mean[ORDER * k + i], 1.0, "mean");
                for j in 0..ORDER {
                    assert_near(state.covariance[(i, j)], dense[(i, j)], 1.0, "covariance");
                }
            }
        }
    }
}

#[test]
fn what_is_told_of_a_smoothed_part_are_its_discrepancies() {
    let part = record(9, 1, &BOTH);
    let states = smoothed_states(&part, &noise(), &discrepancies()).unwrap();
    let told = smooth_discrepancies(&part, &noise(), &discrepancies()).unwrap();
    assert_eq!((told.values.len(), told.deviations.len()), (AXES, AXES));
    for (k, state) in states.iter().enumerate() {
        for axis in 0..AXES {
            let place = STATES + axis;
            assert_eq!(told.values[axis][k], state.mean[place]);
            assert_eq!(told.deviations[axis][k], state.covariance[(place, place)].sqrt());
        }
    }
}

#[test]
fn a_channel_without_known_noise_is_refused_by_its_name() {
    let part = record(6, 1, &BOTH);
    let mut less = noise();
    less.remove(&Channel::V);
    let along = part.combine_columns(&[0.0, 0.0]);
    let refusals = [
        whiten_part(&part, &less, &discrepancies()).unwrap_err().to_string(),
        smooth_discrepancies(&part, &less, &discrepancies()).unwrap_err().to_string(),
        part_deviances(&[&along, &along], &less, &discrepancies()).unwrap_err().to_string(),
    ];
    for refusal in refusals {
        assert!(refusal.contains("the noise of the channel `v` cannot be estimated"), "{refusal}");
    }
}

#[test]
fn discrepancies_of_another_model_are_refused() {
    let part = record(6, 1, &BOTH);
    let less = vec![discrepancies()[0]];
    let refusal = whiten_part(&part, &noise(), &less).unwrap_err().to_string();
    assert!(refusal.contains("discrepancies of 1 accelerations, but the model has 2"), "{refusal}");
}

/// The same with a second reading, and what a column does to the first, that follow rates.
fn late(part: LinearisedPart) -> LinearisedPart {
    let by = |seed: u64| numbers(part.samples.len(), 0.6, seed);
    let by_rate = vec![
        RateResponse { channel: 1, column: None, state: 0, by: by(21) },
        RateResponse { channel: 0, column: Some(1), state: 2, by: by(22) },
    ];
    LinearisedPart { by_rate, ..part }
}

/// Strips of columns by known gains are the rows of the filter, to the last bit.
#[test]
fn known_gains_whiten_as_the_filter_does() {
    for part in records().into_iter().chain(records().into_iter().map(late)) {
        let (rows, log_variance) = whiten_part(&part, &noise(), &discrepancies()).unwrap();
        let gains = FilterGains::new(&part, &noise(), &discrepancies()).unwrap();
        let columns = gains.whiten_columns(&part, COLUMNS);
        for column in 0..=COLUMNS {
            let mut unit = [0.0; 1 + COLUMNS];
            unit[column] = 1.0;
            let own: Vec<f64> = rows.iter().skip(column).step_by(1 + COLUMNS).copied().collect();
            assert_eq!(columns.weighted_sum(&unit), own);
        }
        let gram = columns.gram_matrix();
        assert_eq!(gram.log_variance, log_variance);
        let product: f64 = rows.chunks_exact(1 + COLUMNS).map(|row| row[0] * row[2]).sum();
        assert_near(gram.products[(0, 2)], product, 1.0, "product");
    }
}

/// Products are those of the whitened columns, also where a block of samples has no reading.
#[test]
fn products_by_blocks_are_those_of_the_columns() {
    for part in [record(150, 1, &BOTH), record(150, 3, &BOTH), record(210, 100, &BOTH)] {
        let gains = FilterGains::new(&part, &noise(), &discrepancies()).unwrap();
        let expected = gains.whiten_columns(&part, COLUMNS).gram_matrix().products;
        let products = gains.whitened_products(&part).products;
        let scale = expected.amax();
        for (own, expected) in products.iter().zip(&expected) {
            assert_near(*own, *expected, scale, "product");
        }
    }
}

/// A column in segments is the column of each and its free movement after it.
#[test]
fn segments_and_their_free_movements_are_the_column() {
    for part in records() {
        let gains = FilterGains::new(&part, &noise(), &discrepancies()).unwrap();
        let starts = [FilterGains::input_place(2, true), FilterGains::input_place(4, false)];
        let cut = gains.whiten_segments(&part, &[0, 1], &starts);
        let whole = gains.whiten_columns(&part, COLUMNS);
        let limits: Vec<usize> = cut.readings.iter().map(|readings| readings.end).collect();
        assert!(limits.len() == 3 && limits.is_sorted() && limits[0] > 0, "{limits:?}");
        assert_eq!((cut.ends.len(), limits[2]), (3, whole.reading_count()));
        let mut unit = vec![0.0; cut.columns.column_count()];
        for column in 0..COLUMNS {
            let mut whole_unit = [0.0; 1 + COLUMNS];
            whole_unit[1 + column] = 1.0;
            let expected = whole.weighted_sum(&whole_unit);
            let mut moved = DVector::zeros(ORDER);
            for (readings, end) in cut.readings.iter().zip(&cut.ends) {
                unit.fill(0.0);
                unit[..ORDER].copy_from_slice(moved.as_slice());
                unit[cut.first + column] = 1.0;
                let own = cut.columns.weighted_sum(&unit);
                for reading in readings.clone() {
                    assert_near(own[reading], expected[reading], 1.0, "reading");
                }
                moved = end.columns(0, ORDER) * moved + end.column(cut.first + column);
            }
        }
    }
}
