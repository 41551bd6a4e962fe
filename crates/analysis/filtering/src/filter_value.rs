//! Numbers of a Kalman filter: those of one part of a trial, or of several parts in lockstep.

use std::ops::{Add, Div, Mul, Neg};

use super::linearised::LinearisedPart;

/// Parts in lockstep: one vector of doubles of AVX2. With twice as many, most would wait for the
/// longest, and the six trials of many a ship would be one task.
pub(super) const LANES: usize = 4;

/// A number for each part that a filter runs along. Every operation is that of [`f64`] in each
/// lane, in the same order, so that results do not depend on the number of parts in lockstep.
pub(super) trait FilterValue:
    Copy + Add<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// Creates a value from the number of each lane.
    fn from_lanes(of: impl FnMut(usize) -> f64) -> Self;

    /// Returns the number of a lane.
    fn lane_mut(&mut self, lane: usize) -> &mut f64;

    /// Adds a product.
    fn add_product(&mut self, one: Self, other: Self);

    /// Returns true if products with the value need not be added: it is zero, and the test is
    /// cheaper than the addition.
    fn is_skippable(self) -> bool;

    /// Sums rows of a matrix by their weights; `stride` is the distance between the beginnings of
    /// consecutive rows.
    fn weighted_sum(weights: &[Self], rows: &[Self], stride: usize, sum: &mut [Self]);

    /// Returns a row of numbers of each part, interleaved by lane; `room` is the buffer for it
    /// where one is needed.
    fn lane_row<'a>(
        parts: &[&'a LinearisedPart],
        of: impl Fn(usize, &'a LinearisedPart) -> &'a [f64],
        room: &'a mut Vec<Self>,
    ) -> &'a [Self];

    /// Returns the same number in each lane.
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self::from_lanes(|_| value)
    }
}

impl FilterValue for f64 {
    #[inline(always)]
    fn from_lanes(mut of: impl FnMut(usize) -> f64) -> Self {
        of(0)
    }

    #[inline(always)]
    fn lane_mut(&mut self, _: usize) -> &mut f64 {
        self
    }

    #[inline(always)]
    fn add_product(&mut self, one: Self, other: Self) {
        *self += one * other;
    }

    #[inline(always)]
    fn is_skippable(self) -> bool {
        self == 0.0
    }

    /// Row after row, each in wide instructions.
    #[inline(always)]
    fn weighted_sum(weights: &[Self], rows: &[Self], stride: usize, sum: &mut [Self]) {
        sum.fill(0.0);
        for (weight, row) in weights.iter().zip(rows.chunks(stride)) {
            // Skipped zeros leave the sum exactly as it is for finite rows.
            if *weight != 0.0 {
                add_scaled(*weight, row, sum);
            }
        }
    }

    #[inline(always)]
    fn lane_row<'a>(
        parts: &[&'a LinearisedPart],
        of: impl Fn(usize, &'a LinearisedPart) -> &'a [f64],
        _: &'a mut Vec<Self>,
    ) -> &'a [Self] {
        of(0, parts[0])
    }
}

/// A number for each of [`LANES`] parts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ValueLanes(pub [f64; LANES]);

impl Add for ValueLanes {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|lane| self.0[lane] + other.0[lane]))
    }
}

impl Mul for ValueLanes {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(std::array::from_fn(|lane| self.0[lane] * other.0[lane]))
    }
}

impl Div for ValueLanes {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self(std::array::from_fn(|lane| self.0[lane] / other.0[lane]))
    }
}

impl Neg for ValueLanes {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(std::array::from_fn(|lane| -self.0[lane]))
    }
}

impl FilterValue for ValueLanes {
    #[inline(always)]
    fn from_lanes(of: impl FnMut(usize) -> f64) -> Self {
        Self(std::array::from_fn(of))
    }

    #[inline(always)]
    fn lane_mut(&mut self, lane: usize) -> &mut f64 {
        &mut self.0[lane]
    }

    #[inline(always)]
    fn add_product(&mut self, one: Self, other: Self) {
        (0..LANES).for_each(|lane| self.0[lane] += one.0[lane] * other.0[lane]);
    }

    #[inline(always)]
    fn is_skippable(self) -> bool {
        false
    }

    /// Number after number, each of which is a wide register.
    #[inline(always)]
    fn weighted_sum(weights: &[Self], rows: &[Self], stride: usize, sum: &mut [Self]) {
        for (column, to) in sum.iter_mut().enumerate() {
            let mut own = Self([0.0; LANES]);
            // In the order of the rows, as for one part, so that the results are the same to the
            // last bit.
            for (weight, row) in weights.iter().zip(rows.chunks(stride)) {
                own.add_product(*weight, row[column]);
            }
            *to = own;
        }
    }

    #[inline(always)]
    fn lane_row<'a>(
        parts: &[&'a LinearisedPart],
        of: impl Fn(usize, &'a LinearisedPart) -> &'a [f64],
        room: &'a mut Vec<Self>,
    ) -> &'a [Self] {
        room.resize(of(0, parts[0]).len(), Self([0.0; LANES]));
        for (lane, part) in parts.iter().enumerate() {
            room.iter_mut().zip(of(lane, part)).for_each(|(to, from)| to.0[lane] = *from);
        }
        room
    }
}

/// Adds a multiple of a row to another.
#[inline(always)]
pub(super) fn add_scaled<V: FilterValue>(weight: V, from: &[V], to: &mut [V]) {
    for (to, from) in to.iter_mut().zip(from) {
        to.add_product(weight, *from);
    }
}
