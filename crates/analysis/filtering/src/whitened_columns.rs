//! Residual and columns of a part after the filter, in strips of columns.

use std::ops::Range;

use nalgebra::DMatrix;
use sistership_simulation::simd::dispatch_simd;

use super::filter_gains::FilterGains;
use super::gram::GramMatrix;
use super::linearised::LinearisedPart;
use super::strip_filter::{
    RateDeviations, STRIP, SegmentLimits, StripGroup, StripKernel, StripLane, StripValues,
};
use super::strip_products::{StripRange, strip_products};

/// Prediction errors and the contributions of columns, divided by the predicted standard deviation.
#[derive(Debug)]
pub struct WhitenedColumns {
    width: usize,
    readings: usize,
    /// Strip after strip, by readings; columns beyond the last are zero.
    strips: Vec<StripValues>,
    log_variance: f64,
}

impl WhitenedColumns {
    /// Number of columns.
    pub fn column_count(&self) -> usize {
        self.width
    }

    /// Number of readings.
    pub fn reading_count(&self) -> usize {
        self.readings
    }

    /// Returns the products of all columns.
    pub fn gram_matrix(&self) -> GramMatrix {
        GramMatrix {
            products: self.own_products(0..self.readings),
            log_variance: self.log_variance,
            count: self.readings,
        }
    }

    /// Returns the products of all columns over some readings.
    pub fn own_products(&self, readings: Range<usize>) -> DMatrix<f64> {
        let range = self.strip_range(readings);
        strip_products((range, range), true).resize(self.width, self.width, 0.0)
    }

    /// Returns the products with other columns of the same readings: own columns by others.
    pub fn products_with(&self, other: &Self, readings: Range<usize>) -> DMatrix<f64> {
        let ranges = (self.strip_range(readings.clone()), other.strip_range(readings));
        strip_products(ranges, false).resize(self.width, other.width, 0.0)
    }

    /// Returns the sum of all columns by their weights, one for each column, at each reading.
    pub fn weighted_sum(&self, weights: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.readings];
        let strips = self.strips.chunks_exact(self.readings.max(1));
        for (strip, weights) in strips.zip(weights.chunks(STRIP)) {
            for (sum, values) in sum.iter_mut().zip(strip) {
                *sum += values.iter().zip(weights).map(|(value, by)| value * by).sum::<f64>();
            }
        }
        sum
    }

    /// Strip after strip, by readings.
    pub(super) fn strips(&self) -> &[StripValues] {
        &self.strips
    }

    fn strip_range(&self, readings: Range<usize>) -> StripRange<'_> {
        let readings = (readings.start, readings.end);
        StripRange { strips: &self.strips, count: self.readings, readings }
    }
}

/// Columns of which each starts again at the limits of segments, without an earlier movement; and
/// the free movements from a unit of each state and discrepancy at these limits. The columns of
/// these movements are first, then, from `first`, those of the linearisation.
#[derive(Debug)]
pub struct SegmentedColumns {
    /// All of them.
    pub columns: WhitenedColumns,
    /// Index of the first column of the linearisation.
    pub first: usize,
    /// Readings of each segment.
    pub readings: Vec<Range<usize>>,
    /// Deviations at the end of each segment: states and discrepancies by columns.
    pub ends: Vec<DMatrix<f64>>,
}

/// Number of samples whose columns are kept at a time where only their products are needed: they
/// stay in the cache.
const SAMPLES: usize = 64;
/// Number of strips in lockstep.
pub(super) const GROUP: usize = 4;

impl FilterGains {
    /// Returns the products of the residual and all columns of a part after the filter.
    pub fn whitened_products(&self, part: &LinearisedPart) -> GramMatrix {
        let columns = (0..part.sizes.columns).map(StripLane::Column);
        let lanes: Vec<StripLane> = std::iter::once(StripLane::Residual).chain(columns).collect();
        let rates = self.rate_deviations(part);
        let groups = lanes.chunks(STRIP * GROUP);
        let mut groups: Vec<StripGroup<'_, GROUP>> =
            groups.map(|lanes| StripGroup::new(self, part, lanes)).collect();
        let mut gram = GramMatrix::zeros(lanes.len());
        let mut rows = Vec::new();
        for from in (0..part.samples.len()).step_by(SAMPLES) {
            let samples = from..part.samples.len().min(from + SAMPLES);
            let count = (samples.end.div_ceil(part.every) - from.div_ceil(part.every))
                * part.channels.len();
            rows.resize(groups.len() * GROUP * count, [0.0; STRIP]);
            // Without a reading among these samples the strips are predicted all the same.
            for (place, strips) in groups.iter_mut().enumerate() {
                let rows = &mut rows[place * GROUP * count..][..GROUP * count];
                let (samples, rates) = (samples.clone(), RateDeviations::Known(&rates));
                dispatch_simd(StripKernel { strips, samples, rates, segments: None, rows });
            }
            if count == 0 {
                continue;
            }
            // Strips beyond the last column stay out of the products.
            let strips = &rows[..lanes.len().div_ceil(STRIP) * count];
            let range = StripRange { strips, count, readings: (0, count) };
            let products = strip_products((range, range), true);
            gram.products += products.view((0, 0), (lanes.len(), lanes.len()));
        }
        (gram.log_variance, gram.count) = (self.log_variance, self.reading_count());
        gram
    }

    /// Returns the residual and the first columns of a part after the filter.
    pub fn whiten_columns(&self, part: &LinearisedPart, columns: usize) -> WhitenedColumns {
        let lanes: Vec<StripLane> = std::iter::once(StripLane::Residual)
            .chain((0..columns).map(StripLane::Column))
            .collect();
        let rates = self.rate_deviations(part);
        let mut all = Vec::with_capacity(lanes.len().div_ceil(STRIP) * self.reading_count());
        for lanes in lanes.chunks(STRIP * GROUP) {
            self.run_strips(part, lanes, RateDeviations::Known(&rates), (&mut all, None));
        }
        self.whitened(lanes.len(), all)
    }

    /// Returns some columns of a part, each by segments; `starts` are the places of the first input
    /// of each segment but the first ([`input_place`]).
    ///
    /// [`input_place`]: Self::input_place
    pub fn whiten_segments(
        &self,
        part: &LinearisedPart,
        columns: &[usize],
        starts: &[usize],
    ) -> SegmentedColumns {
        let units: Vec<StripLane> = (0..self.order()).map(StripLane::Unit).collect();
        let own: Vec<StripLane> = columns.iter().map(|&column| StripLane::Column(column)).collect();
        let rates = self.rate_deviations(part);
        // Movements fill strips of their own, so that columns begin at a whole strip.
        let first = units.len().next_multiple_of(STRIP);
        let width = first + own.len();
        let mut ends = vec![DMatrix::zeros(self.order(), width); 1 + starts.len()];
        let (mut all, mut readings) = (Vec::new(), Vec::new());
        let mut place = 0;
        let groups = units.chunks(STRIP * GROUP).chain(own.chunks(STRIP * GROUP));
        for lanes in groups {
            let mut limits = SegmentLimits { starts, ends: Vec::new(), readings: Vec::new() };
            let rates = RateDeviations::Known(&rates);
            self.run_strips(part, lanes, rates, (&mut all, Some(&mut limits)));
            let strips = lanes.len().div_ceil(STRIP);
            for (to, from) in ends.iter_mut().zip(&limits.ends) {
                for lane in 0..lanes.len() {
                    let values = from.iter().skip(lane / STRIP).step_by(strips);
                    let mut column = to.column_mut(place + lane);
                    column.iter_mut().zip(values).for_each(|(to, own)| *to = own[lane % STRIP]);
                }
            }
            place += strips * STRIP;
            readings = limits.readings;
        }
        let begins = std::iter::once(0).chain(readings.iter().copied());
        let readings = begins.zip(&readings).map(|(from, to)| from..*to).collect();
        SegmentedColumns { columns: self.whitened(width, all), first, readings, ends }
    }

    /// Place among the inputs of the filter of the reading of sample `k`, or of the interval that
    /// follows it.
    pub fn input_place(k: usize, is_interval: bool) -> usize {
        2 * k + usize::from(is_interval)
    }

    fn whitened(&self, width: usize, strips: Vec<StripValues>) -> WhitenedColumns {
        let (readings, log_variance) = (self.reading_count(), self.log_variance);
        WhitenedColumns { width, readings, strips, log_variance }
    }

    /// Deviations of the rates on which readings depend; they are those of the residual.
    fn rate_deviations(&self, part: &LinearisedPart) -> Vec<f64> {
        let mut all = Vec::new();
        if !part.by_rate.is_empty() {
            let rates = RateDeviations::Record(&mut all);
            self.run_strips(part, &[StripLane::Residual], rates, (&mut Vec::new(), None));
        }
        all
    }

    /// Runs as many strips as there are lanes, at most [`GROUP`], and appends their values.
    fn run_strips(
        &self,
        part: &LinearisedPart,
        lanes: &[StripLane],
        rates: RateDeviations<'_>,
        (all, segments): (&mut Vec<StripValues>, Option<&mut SegmentLimits<'_>>),
    ) {
        let (strips, before) = (lanes.len().div_ceil(STRIP), all.len());
        all.resize(before + strips * self.reading_count(), [0.0; STRIP]);
        let to = (&mut all[before..], segments);
        match strips {
            1 => self.run_group::<1>(part, lanes, rates, to),
            2 => self.run_group::<2>(part, lanes, rates, to),
            3 => self.run_group::<3>(part, lanes, rates, to),
            _ => self.run_group::<GROUP>(part, lanes, rates, to),
        }
    }

    fn run_group<const G: usize>(
        &self,
        part: &LinearisedPart,
        lanes: &[StripLane],
        rates: RateDeviations<'_>,
        (rows, segments): (&mut [StripValues], Option<&mut SegmentLimits<'_>>),
    ) {
        let strips = &mut StripGroup::<G>::new(self, part, lanes);
        let samples = 0..part.samples.len();
        dispatch_simd(StripKernel { strips, samples, rates, segments, rows });
    }
}
