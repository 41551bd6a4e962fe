//! Kalman filter along linearised parts of trials.
//!
//! The state is the deviation from the recorded path, then the discrepancy of each acceleration.
//! The same filter serves any number of parts in lockstep ([`FilterValue`]) and of columns.
//!
//! Readings are used one channel after the other (their noises are independent), so that each
//! prediction error is divided by its own predicted standard deviation and no matrix is inverted:
//! Maybeck 1979, Stochastic models, estimation and control, vol. 1, section 7.

use nalgebra::{DMatrix, DVector};
use sistership_identification::refine::RefineError;

use super::discrepancies::AxisDiscrepancies;
use super::filter_noise::FilterNoise;
use super::filter_value::{FilterValue, add_scaled};
use super::linearised::LinearisedPart;
use super::noise::InstrumentNoise;
use super::transition::TransitionMatrix;

/// Deviations from the paths of some parts with all their columns, and their covariance.
pub(super) struct KalmanFilter<'p, V> {
    /// One part for each lane; their sizes, channels and readings are alike.
    parts: Vec<&'p LinearisedPart>,
    noise: FilterNoise,
    transition: TransitionMatrix<V>,
    /// Number of states.
    states: usize,
    /// Number of states with discrepancies.
    order: usize,
    width: usize,
    /// `order` by `width`, row by row; the first column is the residual, the others are the
    /// movements by each column.
    deviations: Vec<V>,
    /// `order` by `order`.
    covariance: Vec<V>,
    /// Deviations at the next sample.
    moved: Vec<V>,
    /// Transition times covariance.
    product: Vec<V>,
    error: Vec<V>,
    gain: Vec<V>,
    /// Buffer for interleaved rows of all parts.
    gathered: Vec<V>,
}

impl<'p, V: FilterValue> KalmanFilter<'p, V> {
    /// Creates a filter before the first reading, with the first `width - 1` columns.
    ///
    /// # Errors
    /// Returns an error if the noise of a channel is unknown.
    pub fn new(
        parts: Vec<&'p LinearisedPart>,
        noise: &InstrumentNoise,
        discrepancies: &AxisDiscrepancies,
        width: usize,
    ) -> Result<Self, RefineError> {
        let noise = FilterNoise::new(parts[0], noise, discrepancies)?;
        let (states, axes) = (parts[0].sizes.states, parts[0].sizes.axes);
        let (order, zero) = (states + axes, V::splat(0.0));
        let mut covariance = vec![zero; order * order];
        for (row, variance) in noise.start_variances().enumerate() {
            covariance[row * (order + 1)] = V::splat(variance);
        }
        Ok(Self {
            parts,
            noise,
            transition: TransitionMatrix::new(states, axes),
            states,
            order,
            width,
            deviations: vec![zero; order * width],
            covariance,
            moved: vec![zero; order * width],
            product: vec![zero; order * order],
            error: vec![zero; width],
            gain: vec![zero; order],
            gathered: Vec::new(),
        })
    }

    /// Index of the sample of a lane; a part that has ended stays `last` samples from its end.
    #[inline(always)]
    fn sample_index(part: &LinearisedPart, k: usize, last: usize) -> usize {
        k.min(part.samples.len().saturating_sub(last))
    }

    /// Predicts from sample `k` to the next.
    #[inline(always)]
    pub fn predict(&mut self, k: usize) {
        self.transition.set_interval(&self.parts, k, &self.noise);
        self.move_deviations(k);
        self.move_covariance();
        self.add_noise();
    }

    /// Moves deviations to the next sample: by the transition, by the defect of the path, and by
    /// the columns.
    #[inline(always)]
    fn move_deviations(&mut self, k: usize) {
        let Self { parts, transition, states, width, deviations, moved, gathered, .. } = self;
        let (n, width) = (*states, *width);
        let columns = parts[0].sizes.columns;
        let block = parts[0].sizes.axes * columns;
        let caused = V::lane_row(
            parts,
            |_, part| &part.accelerations[Self::sample_index(part, k, 2) * block..][..block],
            gathered,
        );
        // x' = F x + defect + G a, with the accelerations a of each column; the defect belongs to
        // the residual alone.
        for (row, target) in moved.chunks_exact_mut(width).take(n).enumerate() {
            V::weighted_sum(transition.state_row(row), deviations, width, target);
            for (lane, part) in parts.iter().enumerate() {
                *target[0].lane_mut(lane) += part.defect[Self::sample_index(part, k, 2) * n + row];
            }
            if width == 1 {
                continue;
            }
            for (weight, caused) in
                transition.acceleration_weights(row).iter().zip(caused.chunks(columns.max(1)))
            {
                if !weight.is_skippable() {
                    // Idle weights are zero; skipping them leaves the sum as it is.
                    add_scaled(*weight, caused, &mut target[1..]);
                }
            }
        }
        // A discrepancy decays by its share alone.
        for (axis, kept) in transition.kept_shares().iter().enumerate() {
            let (from, to) = ((n + axis) * width, &mut moved[(n + axis) * width..][..width]);
            to.iter_mut().zip(&deviations[from..]).for_each(|(to, from)| *to = *kept * *from);
        }
        std::mem::swap(&mut self.moved, &mut self.deviations);
    }

    /// `F P F'`, made exactly symmetric.
    #[inline(always)]
    fn move_covariance(&mut self) {
        let Self { transition, states, order, covariance, product, .. } = self;
        let (n, order) = (*states, *order);
        // The product F P; the rows of discrepancies are diagonal in F.
        for (row, target) in product.chunks_exact_mut(order).take(n).enumerate() {
            V::weighted_sum(transition.state_row(row), covariance, order, target);
        }
        for (axis, kept) in transition.kept_shares().iter().enumerate() {
            let (at, from) = ((n + axis) * order, &covariance[(n + axis) * order..][..order]);
            let to = &mut product[at..][..order];
            to.iter_mut().zip(from).for_each(|(to, from)| *to = *kept * *from);
        }
        // Only the lower triangle of (F P) F' is computed.
        for row in 0..order {
            let left = &product[row * order..][..order];
            let target = &mut covariance[row * order..][..=row];
            let (by_states, by_axes) = target.split_at_mut(n.min(row + 1));
            V::weighted_sum(left, transition.transposed_rows(), n, by_states);
            for ((to, left), kept) in
                by_axes.iter_mut().zip(&left[n..]).zip(transition.kept_shares())
            {
                *to = *left * *kept;
            }
        }
        // Copied rather than computed, so that rounding cannot break the symmetry.
        for row in 0..order {
            for column in 0..row {
                covariance[column * order + row] = covariance[row * order + column];
            }
        }
    }

    #[inline(always)]
    fn add_noise(&mut self) {
        let (n, diagonal, dt) = (self.states, self.order + 1, self.transition.interval_s());
        // Process noise: drift of states, white acceleration noise, and the renewed share of each
        // discrepancy's variance.
        for (state, density) in self.noise.state_densities().enumerate() {
            self.covariance[state * diagonal].add_product(V::splat(density), dt);
        }
        for (axis, discrepancy) in self.noise.discrepancies().iter().enumerate() {
            let white = V::splat(discrepancy.white.powi(2));
            self.covariance[axis * diagonal].add_product(dt, white);
            let variance = V::splat(discrepancy.deviation.powi(2));
            let renewed = self.transition.renewed_shares()[axis];
            self.covariance[(n + axis) * diagonal].add_product(renewed, variance);
        }
    }

    /// Uses the readings of sample `k`; `take` receives each prediction error (the residual's, then
    /// minus each column's), its variance, and its covariances with states and discrepancies.
    #[inline(always)]
    pub fn update(&mut self, k: usize, mut take: impl FnMut(&[V], V, &[V])) {
        for channel in 0..self.parts[0].channels.len() {
            self.load_reading(k, channel);
            let own = match self.parts[0].by_state {
                None => self.expect_state(self.parts[0].channels[channel].1),
                Some(_) => self.expect_states(k, channel),
            };
            // The variance of the innovation: that of the expected reading and that of the noise.
            let variance = own + V::splat(self.noise.reading_variance(channel));
            take(&self.error, variance, &self.gain);
            self.correct_state(variance);
        }
    }

    /// Sets the error to the reading of a channel, less the parts due to columns and rates.
    #[inline(always)]
    fn load_reading(&mut self, k: usize, channel: usize) {
        self.error.fill(V::splat(0.0));
        for lane in 0..self.parts.len() {
            let part = self.parts[lane];
            let at = Self::sample_index(part, k, 1);
            let reading = at * part.channels.len() + channel;
            *self.error[0].lane_mut(lane) = part.reading[reading];
            let seen = part.measured.len();
            for (place, &column) in part.measured.iter().enumerate() {
                // A filter may carry only the first columns; those beyond its width are skipped.
                if let Some(error) = self.error.get_mut(1 + column) {
                    *error.lane_mut(lane) -= part.by_column[reading * seen + place];
                }
            }
            for response in part.by_rate.iter().filter(|response| response.channel == channel) {
                let faster = self.rate_deviation(at, lane, response.state);
                let place = response.column.map_or(0, |column| 1 + column);
                if let Some(error) = self.error.get_mut(place) {
                    *error.lane_mut(lane) -= response.by[at] * faster;
                }
            }
        }
    }

    /// Difference of a state's rate, by the model, between the expected state and the path. The
    /// discrepancy is excluded: where its true statistics differ from the assumed ones, its
    /// estimate follows the readings, and their prediction errors would follow with it.
    #[inline(always)]
    fn rate_deviation(&self, at: usize, lane: usize, state: usize) -> f64 {
        let (n, part) = (self.states, self.parts[lane]);
        let interval = Self::sample_index(part, at, 2);
        let row = &part.jacobian[(interval * n + state) * n..][..n];
        let expected = |state: usize| {
            let mut deviation = self.deviations[state * self.width];
            *deviation.lane_mut(lane)
        };
        row.iter().enumerate().map(|(state, slope)| slope * expected(state)).sum()
    }

    /// Subtracts from the error the expected reading of a channel that reads a state, and fills
    /// `gain` with the covariances of that state; returns its variance.
    #[inline(always)]
    fn expect_state(&mut self, place: usize) -> V {
        let own = &self.deviations[place * self.width..][..self.width];
        add_scaled(V::splat(-1.0), own, &mut self.error);
        self.gain.copy_from_slice(&self.covariance[place * self.order..][..self.order]);
        self.gain[place]
    }

    /// As [`Self::expect_state`] for a channel that depends on several states.
    #[inline(always)]
    fn expect_states(&mut self, k: usize, channel: usize) -> V {
        let Self { parts, states, order, width, deviations, covariance, error, gain, .. } = self;
        let (n, order, width) = (*states, *order, *width);
        let channels = parts[0].channels.len();
        let weights = V::lane_row(
            parts,
            |_, part| {
                let row = (Self::sample_index(part, k, 1) * channels + channel) * n;
                part.by_state.as_ref().map_or(&[], |by| &by[row..][..n])
            },
            &mut self.gathered,
        );
        // With the row h of the channel: e -= h x, gain = P h', and h P h' as the variance.
        gain.fill(V::splat(0.0));
        for (state, weight) in
            weights.iter().enumerate().filter(|(_, weight)| !weight.is_skippable())
        {
            add_scaled(-*weight, &deviations[state * width..][..width], error);
            add_scaled(*weight, &covariance[state * order..][..order], gain);
        }
        let mut own = V::splat(0.0);
        weights.iter().zip(&*gain).for_each(|(weight, gain)| own.add_product(*weight, *gain));
        own
    }

    /// Corrects deviations and covariance by a reading.
    #[inline(always)]
    fn correct_state(&mut self, variance: V) {
        let Self { order, width, deviations, covariance, error, gain, .. } = self;
        // x += k e and P -= k (P h')', with the gain k = P h' / s of one scalar reading.
        let rows = deviations.chunks_exact_mut(*width).zip(covariance.chunks_exact_mut(*order));
        for ((deviations, covariance), own) in rows.zip(&*gain) {
            let by = *own / variance;
            add_scaled(by, error, deviations);
            add_scaled(-by, gain, covariance);
        }
    }
}

impl KalmanFilter<'_, f64> {
    /// Transition of the last interval.
    pub fn transition(&self) -> &TransitionMatrix<f64> {
        &self.transition
    }

    /// Deviation of each state and discrepancy; with columns, the residual's.
    pub fn state_mean(&self) -> DVector<f64> {
        DVector::from_fn(self.order, |place, _| self.deviations[place * self.width])
    }

    /// Covariance of states and discrepancies.
    pub fn state_covariance(&self) -> DMatrix<f64> {
        DMatrix::from_row_slice(self.order, self.order, &self.covariance)
    }

    /// Transition matrix of deviations from the last sample to this one.
    pub fn transition_matrix(&self) -> DMatrix<f64> {
        self.transition.matrix()
    }
}
