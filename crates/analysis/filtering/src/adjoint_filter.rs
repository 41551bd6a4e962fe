//! Adjoint of the filter of columns: products of few whitened columns with any number of columns
//! that act by accelerations, without passing these through the filter.
//!
//! The filter is linear in the accelerations `a_k` of each interval, so that the product of a
//! whitened column `w` with the whitened column of `a` is `sum_k q_k a_k`. Backwards along the part,
//! with the transition `T`, the gains `g`, the readings `h` and their scales `s`: at a reading
//! `l <- l + h (s w - g l)`, over an interval `q = B' l` and `l <- T' l`, where `B` are the columns
//! of `T` by which accelerations act.

use std::hint::black_box;
use std::ops::Range;

use nalgebra::DMatrix;
use sistership_simulation::simd::{SimdKernel, dispatch_simd};

use super::filter_gains::FilterGains;
use super::linearised::LinearisedPart;
use super::strip_filter::{GroupValues, STRIP, StripValues, add_scaled};
use super::strip_products::row_products;
use super::whitened_columns::{GROUP, WhitenedColumns};

impl FilterGains {
    /// Returns the products over some readings of the columns of a part, which act on no instrument,
    /// with columns that have passed this filter: the former by the latter, without the residual of
    /// the part.
    pub fn column_products(
        &self,
        part: &LinearisedPart,
        whitened: &WhitenedColumns,
        readings: Range<usize>,
    ) -> DMatrix<f64> {
        let count = part.samples.len().saturating_sub(1) * self.axes;
        let strips = whitened.strips().chunks(GROUP * self.reading_count().max(1));
        let mut causes = Vec::with_capacity(whitened.column_count().div_ceil(STRIP) * count);
        for rows in strips {
            match rows.len() / self.reading_count().max(1) {
                1 => self.run_adjoint::<1>(part, (rows, &readings), &mut causes),
                2 => self.run_adjoint::<2>(part, (rows, &readings), &mut causes),
                3 => self.run_adjoint::<3>(part, (rows, &readings), &mut causes),
                _ => self.run_adjoint::<GROUP>(part, (rows, &readings), &mut causes),
            }
        }
        let width = part.sizes.columns;
        let products = row_products(&part.accelerations[..count * width], width, &causes);
        products.resize(width, whitened.column_count(), 0.0)
    }

    /// Appends the weights of accelerations for strips of whitened columns, strip after strip.
    fn run_adjoint<const G: usize>(
        &self,
        part: &LinearisedPart,
        (rows, readings): (&[StripValues], &Range<usize>),
        causes: &mut Vec<StripValues>,
    ) {
        let intervals = part.samples.len().saturating_sub(1) * self.axes;
        let before = causes.len();
        causes.resize(before + G * intervals, [0.0; STRIP]);
        let zeros = || vec![[[0.0; STRIP]; G]; self.order()];
        dispatch_simd(AdjointKernel::<G> {
            gains: self,
            part,
            rows,
            readings: readings.clone(),
            causes: &mut causes[before..],
            adjoint: zeros(),
            moved: zeros(),
        });
    }
}

/// Arguments of a backward pass.
struct AdjointKernel<'a, const G: usize> {
    gains: &'a FilterGains,
    part: &'a LinearisedPart,
    /// Whitened values, strip after strip.
    rows: &'a [StripValues],
    /// Readings whose products are summed.
    readings: Range<usize>,
    /// Weights of the accelerations, strip after strip, by interval and axis.
    causes: &'a mut [StripValues],
    /// Sensitivities to states and discrepancies.
    adjoint: Vec<GroupValues<G>>,
    moved: Vec<GroupValues<G>>,
}

impl<const G: usize> SimdKernel for AdjointKernel<'_, G> {
    #[inline(always)]
    fn run(mut self) {
        for k in (0..self.part.samples.len()).rev() {
            if k.is_multiple_of(self.part.every) {
                for channel in (0..self.part.channels.len()).rev() {
                    self.pass_reading(k, channel);
                }
            }
            if k > 0 {
                self.pass_interval(k - 1);
            }
        }
    }
}

impl<const G: usize> AdjointKernel<'_, G> {
    /// Passes the reading of a channel at sample `k`.
    #[inline(always)]
    fn pass_reading(&mut self, k: usize, channel: usize) {
        let Self { gains, part, rows, readings, adjoint, .. } = self;
        let (order, count) = (gains.order(), rows.len() / G);
        let reading = k / part.every * part.channels.len() + channel;
        let mut input = [[0.0; STRIP]; G];
        if readings.contains(&reading) {
            let own: GroupValues<G> = std::array::from_fn(|strip| rows[strip * count + reading]);
            add_scaled(gains.scales[reading], &own, &mut input);
        }
        for (by, from) in gains.gains[reading * order..][..order].iter().zip(&*adjoint) {
            // Opaque for the reason that the forward pass states.
            add_scaled(-black_box(*by), from, &mut input);
        }
        let Some(by_state) = &part.by_state else {
            return add_scaled(1.0, &input, &mut adjoint[part.channels[channel].1]);
        };
        let n = gains.states;
        let weights = &by_state[(k * part.channels.len() + channel) * n..][..n];
        for (weight, to) in weights.iter().zip(adjoint) {
            if *weight != 0.0 {
                add_scaled(*weight, &input, to);
            }
        }
    }

    /// Passes the interval after sample `k`.
    #[inline(always)]
    fn pass_interval(&mut self, k: usize) {
        let Self { gains, causes, adjoint, moved, .. } = self;
        let (n, order, count) = (gains.states, gains.order(), causes.len() / G);
        let transition = &gains.transitions[k * n * order..][..n * order];
        for (column, sum) in moved.iter_mut().enumerate() {
            *sum = [[0.0; STRIP]; G];
            for (row, from) in adjoint[..n].iter().enumerate() {
                add_scaled(black_box(transition[row * order + column]), from, sum);
            }
        }
        for axis in 0..gains.axes {
            // Accelerations and discrepancies act alike; the latter remain in part.
            for strip in 0..G {
                causes[strip * count + k * gains.axes + axis] = moved[n + axis][strip];
            }
            let kept = gains.kept[k * gains.axes + axis];
            add_scaled(kept, &adjoint[n + axis], &mut moved[n + axis]);
        }
        std::mem::swap(adjoint, moved);
    }
}
