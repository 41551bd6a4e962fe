//! Filter of strips of columns by known gains: one vector of the widest instructions for each state
//! and strip. Several strips in lockstep hide the latency of each.

use std::hint::black_box;
use std::ops::Range;

use sistership_simulation::simd::SimdKernel;

use super::filter_gains::FilterGains;
use super::linearised::LinearisedPart;

/// Number of columns in a strip: the lanes of the widest instructions.
pub(super) const STRIP: usize = 8;

/// Values of a strip of columns at one reading, or for one state.
pub(super) type StripValues = [f64; STRIP];

/// Values of strips in lockstep.
pub(super) type GroupValues<const G: usize> = [StripValues; G];

/// Content of a lane of a strip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum StripLane {
    /// The residual.
    Residual,
    /// A column of the linearisation.
    Column(usize),
    /// A free movement from a unit of a state or discrepancy.
    Unit(usize),
}

/// Columns of a strip.
struct StripColumns {
    /// Lanes with their columns.
    columns: Vec<(usize, usize)>,
    /// First of as many consecutive columns as there are lanes.
    consecutive: Option<usize>,
}

impl StripColumns {
    fn new(lanes: &[StripLane]) -> Self {
        let column = |(lane, own): (usize, &StripLane)| match own {
            StripLane::Column(column) => Some((lane, *column)),
            _ => None,
        };
        let columns: Vec<(usize, usize)> = lanes.iter().enumerate().filter_map(column).collect();
        // Neighbouring columns are read by one load in place of eight.
        let is_row =
            columns.len() == STRIP && columns.windows(2).all(|pair| pair[0].1 + 1 == pair[1].1);
        Self { consecutive: is_row.then(|| columns[0].1), columns }
    }

    /// Fills the lanes from a row of all columns.
    #[inline(always)]
    fn load(&self, row: &[f64], to: &mut StripValues) {
        match self.consecutive {
            Some(first) => to.copy_from_slice(&row[first..first + STRIP]),
            None => self.columns.iter().for_each(|&(lane, column)| to[lane] = row[column]),
        }
    }
}

/// A lane of strips in lockstep.
#[derive(Debug, Clone, Copy)]
struct LanePlace {
    strip: usize,
    lane: usize,
}

/// Lanes of strips in lockstep, with the places of what they receive.
struct StripLanes {
    /// True if the first lane is the residual.
    has_residual: bool,
    units: Vec<(LanePlace, usize)>,
    strips: Vec<StripColumns>,
    /// Lanes with the places of their columns among those that act on instruments.
    seen: Vec<(LanePlace, usize)>,
    /// Lanes with their responses to rates.
    rates: Vec<(LanePlace, usize)>,
}

impl StripLanes {
    fn new(lanes: &[StripLane], part: &LinearisedPart) -> Self {
        let place = |lane: usize| LanePlace { strip: lane / STRIP, lane: lane % STRIP };
        let all = || lanes.iter().enumerate().map(move |(lane, own)| (place(lane), *own));
        let of = |wanted: StripLane| all().find(|(_, own)| *own == wanted).map(|(lane, _)| lane);
        let units = all().filter_map(|(lane, own)| match own {
            StripLane::Unit(state) => Some((lane, state)),
            _ => None,
        });
        let seen = part.measured.iter().enumerate();
        let rates = part.by_rate.iter().enumerate();
        Self {
            has_residual: lanes.first() == Some(&StripLane::Residual),
            units: units.collect(),
            strips: lanes.chunks(STRIP).map(StripColumns::new).collect(),
            seen: seen
                .filter_map(|(place, column)| Some((of(StripLane::Column(*column))?, place)))
                .collect(),
            rates: rates
                .filter_map(|(rate, response)| {
                    let lane = response.column.map_or(StripLane::Residual, StripLane::Column);
                    Some((of(lane)?, rate))
                })
                .collect(),
        }
    }
}

/// Deviations of rates that the readings depend on, by response within each sample that is read.
pub(super) enum RateDeviations<'a> {
    /// Recorded by this pass, which has the residual in its first lane.
    Record(&'a mut Vec<f64>),
    /// Known from an earlier pass.
    Known(&'a [f64]),
}

/// Limits of segments, at each of which a strip starts again, and the deviations that it had.
pub(super) struct SegmentLimits<'a> {
    /// Place of the first input of each segment but the first: `2 k` for the reading of sample `k`,
    /// `2 k + 1` for the interval that follows it.
    pub starts: &'a [usize],
    /// Deviations at the end of each segment: strips, state by state.
    pub ends: Vec<Vec<StripValues>>,
    /// Number of readings before the end of each segment.
    pub readings: Vec<usize>,
}

/// Arguments of a pass of strips over some samples, which follow those of their last pass.
pub(super) struct StripKernel<'a, 'p, 's, const G: usize> {
    pub strips: &'a mut StripGroup<'p, G>,
    pub samples: Range<usize>,
    pub rates: RateDeviations<'a>,
    pub segments: Option<&'a mut SegmentLimits<'s>>,
    /// Whitened values of these samples, strip after strip.
    pub rows: &'a mut [StripValues],
}

impl<const G: usize> SimdKernel for StripKernel<'_, '_, '_, G> {
    #[inline(always)]
    fn run(self) {
        let Self { strips, samples, mut rates, mut segments, rows } = self;
        let part = strips.part;
        let readings = |k: usize| k.div_ceil(part.every) * part.channels.len();
        let (before, is_last) = (readings(samples.start), samples.end == part.samples.len());
        for k in samples {
            if k > 0 {
                strips.pass_limits(2 * k - 1, readings(k), &mut segments);
                strips.predict(k - 1);
            }
            if k.is_multiple_of(part.every) {
                strips.pass_limits(2 * k, readings(k), &mut segments);
                strips.update(k, &mut rates, (rows, before));
            }
        }
        if is_last {
            strips.pass_limits(usize::MAX, readings(part.samples.len()), &mut segments);
        }
    }
}

/// Deviations of strips in lockstep on their way along a part.
pub(super) struct StripGroup<'a, const G: usize> {
    gains: &'a FilterGains,
    part: &'a LinearisedPart,
    lanes: StripLanes,
    deviations: Vec<GroupValues<G>>,
    moved: Vec<GroupValues<G>>,
    /// Accelerations of an interval, by axis.
    caused: Vec<GroupValues<G>>,
    segment: usize,
}

impl<'a, const G: usize> StripGroup<'a, G> {
    /// Creates strips before the first sample.
    pub fn new(gains: &'a FilterGains, part: &'a LinearisedPart, lanes: &[StripLane]) -> Self {
        let zeros = vec![[[0.0; STRIP]; G]; gains.order()];
        let caused = vec![[[0.0; STRIP]; G]; gains.axes];
        let lanes = StripLanes::new(lanes, part);
        let mut strips = Self {
            gains,
            part,
            lanes,
            deviations: zeros.clone(),
            moved: zeros,
            caused,
            segment: 0,
        };
        strips.restart();
        strips
    }

    #[inline(always)]
    fn restart(&mut self) {
        self.deviations.fill([[0.0; STRIP]; G]);
        for &(place, state) in &self.lanes.units {
            self.deviations[state][place.strip][place.lane] = 1.0;
        }
    }

    /// Ends all segments before an input.
    #[inline(always)]
    fn pass_limits(
        &mut self,
        input: usize,
        readings: usize,
        segments: &mut Option<&mut SegmentLimits<'_>>,
    ) {
        let Some(limits) = segments else { return };
        let count = 1 + limits.starts.len();
        while self.segment < count
            && limits.starts.get(self.segment).copied().unwrap_or(usize::MAX) <= input
        {
            // What a segment leaves behind moves on freely in the later ones.
            limits.ends.push(self.deviations.iter().flatten().copied().collect());
            limits.readings.push(readings);
            self.restart();
            self.segment += 1;
        }
    }

    /// Predicts from sample `k` to the next.
    #[inline(always)]
    fn predict(&mut self, k: usize) {
        let Self { gains, part, lanes, deviations, moved, caused, .. } = self;
        let (n, order, columns) = (gains.states, gains.order(), part.sizes.columns);
        let transition = &gains.transitions[k * n * order..][..n * order];
        for (axis, caused) in caused.iter_mut().enumerate() {
            let row = &part.accelerations[(k * gains.axes + axis) * columns..][..columns];
            for (strip, caused) in lanes.strips.iter().zip(caused) {
                strip.load(row, caused);
            }
        }
        for (row, weights) in transition.chunks_exact(order).enumerate() {
            let mut sum = [[0.0; STRIP]; G];
            for (by, from) in weights.iter().zip(&*deviations) {
                add_scaled(*by, from, &mut sum);
            }
            if lanes.has_residual {
                sum[0][0] += part.defect[k * n + row];
            }
            for (by, caused) in weights[n..].iter().zip(&*caused) {
                add_scaled(*by, caused, &mut sum);
            }
            moved[row] = sum;
        }
        // Discrepancies decay independently of the states.
        let kept = &gains.kept[k * gains.axes..][..gains.axes];
        for ((kept, from), to) in kept.iter().zip(&deviations[n..]).zip(&mut moved[n..]) {
            for (from, to) in from.iter().zip(to) {
                to.iter_mut().zip(from).for_each(|(to, from)| *to = kept * from);
            }
        }
        std::mem::swap(moved, deviations);
    }

    /// Uses the readings of sample `k`; `before` is the number of readings before the first row.
    #[inline(always)]
    fn update(
        &mut self,
        k: usize,
        rates: &mut RateDeviations<'_>,
        (rows, before): (&mut [StripValues], usize),
    ) {
        let (channels, count) = (self.part.channels.len(), rows.len() / G);
        for channel in 0..channels {
            let mut error = self.reading_input(k, channel, rates);
            self.subtract_expected((k, channel), &mut error);
            let reading = k / self.part.every * channels + channel;
            let scale = self.gains.scales[reading];
            for (strip, error) in error.iter().enumerate() {
                // The error of a column is the movement that its parameter explains, with the sign
                // turned.
                let row = &mut rows[strip * count + reading - before];
                row.iter_mut().zip(error).for_each(|(to, error)| *to = -error * scale);
                if strip == 0 && self.lanes.has_residual {
                    row[0] = error[0] * scale;
                }
            }
            let order = self.gains.order();
            let gains = &self.gains.gains[reading * order..][..order];
            for (to, by) in self.deviations.iter_mut().zip(gains) {
                // An opaque gain keeps the compiler from gathering a lane of several states into one
                // vector, which is ten times slower than the lanes of one state.
                add_scaled(black_box(*by), &error, to);
            }
        }
    }

    /// Reading of a channel, less the parts due to columns and rates.
    #[inline(always)]
    fn reading_input(
        &self,
        k: usize,
        channel: usize,
        rates: &mut RateDeviations<'_>,
    ) -> GroupValues<G> {
        let Self { part, lanes, .. } = self;
        let reading = k * part.channels.len() + channel;
        let mut error = [[0.0; STRIP]; G];
        if lanes.has_residual {
            error[0][0] = part.reading[reading];
        }
        let seen = part.measured.len();
        for &(at, place) in &lanes.seen {
            error[at.strip][at.lane] -= part.by_column[reading * seen + place];
        }
        let first = k / part.every * part.by_rate.len();
        if let RateDeviations::Record(all) = rates {
            all.resize(first + part.by_rate.len(), 0.0);
            for (rate, response) in part.by_rate.iter().enumerate() {
                if response.channel == channel {
                    all[first + rate] = self.rate_deviation(k, response.state);
                }
            }
        }
        let known: &[f64] = match rates {
            RateDeviations::Record(all) => all,
            RateDeviations::Known(all) => all,
        };
        for &(at, rate) in &lanes.rates {
            let response = &part.by_rate[rate];
            if response.channel == channel {
                error[at.strip][at.lane] -= response.by[k] * known[first + rate];
            }
        }
        error
    }

    /// Difference of a state's rate, by the model, between the expected state and the path.
    #[inline(always)]
    fn rate_deviation(&self, k: usize, state: usize) -> f64 {
        let n = self.gains.states;
        let interval = k.min(self.part.samples.len().saturating_sub(2));
        let row = &self.part.jacobian[(interval * n + state) * n..][..n];
        row.iter().zip(&self.deviations).map(|(slope, deviation)| slope * deviation[0][0]).sum()
    }

    /// Subtracts from the error the expected reading of a channel.
    #[inline(always)]
    fn subtract_expected(&self, (k, channel): (usize, usize), error: &mut GroupValues<G>) {
        let part = self.part;
        let Some(by_state) = &part.by_state else {
            return add_scaled(-1.0, &self.deviations[part.channels[channel].1], error);
        };
        let n = self.gains.states;
        let weights = &by_state[(k * part.channels.len() + channel) * n..][..n];
        for (weight, deviation) in weights.iter().zip(&self.deviations) {
            if *weight != 0.0 {
                add_scaled(-weight, deviation, error);
            }
        }
    }
}

/// Adds a multiple of strips to others. The lanes of each strip are added together, as an array, so
/// that each is one vector.
#[inline(always)]
pub(super) fn add_scaled<const G: usize>(
    weight: f64,
    from: &GroupValues<G>,
    to: &mut GroupValues<G>,
) {
    for strip in 0..G {
        let (own, more) = (to[strip], from[strip]);
        to[strip] = std::array::from_fn(|lane| own[lane] + weight * more[lane]);
    }
}
