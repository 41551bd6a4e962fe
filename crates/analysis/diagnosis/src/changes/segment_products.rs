//! Products of possible changes by segments of a trial.
//!
//! The filter is linear: a column that acts in one segment only leaves, at the end of it, a
//! deviation of the filter's states that moves on freely. These movements are the same for all
//! columns, so that one pass for each column, starting again at every limit, and one pass for each
//! state give the products of all columns in all segments.

use nalgebra::DMatrix;
use sistership_filtering::{FilterGains, LinearisedPart, SegmentedColumns, WhitenedColumns};

use super::source::ChangeSource;
use super::windows::TrialSegments;

/// Products of the columns of a source, each once for every segment: segments of its first
/// parameter, then those of the next.
pub(super) struct SourceProducts {
    /// With the residual and the columns that are present with any change.
    pub cross: DMatrix<f64>,
    /// Among themselves.
    pub own: DMatrix<f64>,
}

impl SourceProducts {
    /// Sums of no sample, for a number of known columns and of own ones.
    pub fn zeros(known: usize, own: usize) -> Self {
        Self { cross: DMatrix::zeros(known, own), own: DMatrix::zeros(own, own) }
    }
}

/// A part of a trial with its filter, and the columns that are present with any change.
pub(super) struct KeptPart<'p> {
    pub part: &'p LinearisedPart,
    pub gains: FilterGains,
    pub columns: WhitenedColumns,
}

/// Adds the products of a part to those of each source.
pub(super) fn add_segment_products(
    kept: &KeptPart<'_>,
    sources: &[&ChangeSource],
    segments: TrialSegments,
    products: &mut [SourceProducts],
) {
    let columns: Vec<usize> =
        sources.iter().flat_map(|source| source.columns.iter().copied()).collect();
    let starts = segments.input_starts(kept.part);
    let cut = kept.gains.whiten_segments(kept.part, &columns, &starts);
    let moving = FreeMovements::new(&kept.columns, cut, kept.gains.order());
    let mut first = moving.cut.first;
    for (source, products) in sources.iter().zip(products) {
        moving.add_source((first, source.columns.len()), products);
        first += source.columns.len();
    }
}

/// Products of a segment.
struct SegmentProducts {
    /// Of the columns that are present with any change, with all.
    cross: DMatrix<f64>,
    /// Of all columns among themselves.
    own: DMatrix<f64>,
    /// Change of states and discrepancies over it.
    transition: DMatrix<f64>,
}

/// Products of a movement from the end of a segment with all that follows.
struct LaterProducts {
    /// With the columns that are present with any change: these by states.
    cross: DMatrix<f64>,
    /// Of two movements: states by states.
    own: DMatrix<f64>,
}

/// Columns by segments, with the products of their free movements.
struct FreeMovements {
    cut: SegmentedColumns,
    segments: Vec<SegmentProducts>,
    /// By the segment at whose end a movement begins.
    later: Vec<LaterProducts>,
    order: usize,
}

impl FreeMovements {
    fn new(kept: &WhitenedColumns, cut: SegmentedColumns, order: usize) -> Self {
        let of = |(readings, end): (&std::ops::Range<usize>, &DMatrix<f64>)| SegmentProducts {
            cross: kept.products_with(&cut.columns, readings.clone()),
            own: cut.columns.own_products(readings.clone()),
            transition: end.columns(0, order).into_owned(),
        };
        let segments: Vec<SegmentProducts> = cut.readings.iter().zip(&cut.ends).map(of).collect();
        let known = segments.first().map_or(0, |segment| segment.cross.nrows());
        let none = LaterProducts {
            cross: DMatrix::zeros(known, order),
            own: DMatrix::zeros(order, order),
        };
        // Backwards: A' = G + A F and Q' = B + F' Q F, with the transition F of the segment that
        // follows and the products G and B of the movements from its start.
        let mut later = vec![none];
        for next in segments.iter().skip(1).rev() {
            let after = &later[later.len() - 1];
            let moved = next.transition.tr_mul(&after.own) * &next.transition;
            later.push(LaterProducts {
                cross: next.cross.columns(0, order) + &after.cross * &next.transition,
                own: next.own.view((0, 0), (order, order)) + moved,
            });
        }
        later.reverse();
        Self { cut, segments, later, order }
    }

    /// Adds the products of a source, whose columns are `count` from `first`.
    fn add_source(&self, (first, count): (usize, usize), to: &mut SourceProducts) {
        let ends: Vec<DMatrix<f64>> =
            self.cut.ends.iter().map(|end| end.columns(first, count).into_owned()).collect();
        let place = |parameter: usize, segment: usize| parameter * self.segments.len() + segment;
        for (at, (segment, later)) in self.segments.iter().zip(&self.later).enumerate() {
            let cross = segment.cross.columns(first, count) + &later.cross * &ends[at];
            let own = segment.own.view((first, first), (count, count))
                + ends[at].tr_mul(&(&later.own * &ends[at]));
            for i in 0..count {
                let mut column = to.cross.column_mut(place(i, at));
                column += cross.column(i);
                (0..count).for_each(|j| to.own[(place(i, at), place(j, at))] += own[(i, j)]);
            }
        }
        let later = self.later_products((first, count), &ends);
        for (from, end) in ends.iter().enumerate() {
            // Deviation that the column of a segment leaves at the start of each later one.
            let mut moved = end.clone();
            for (at, later) in later.iter().enumerate().skip(from + 1) {
                let both = moved.tr_mul(later);
                for i in 0..count {
                    for j in 0..count {
                        to.own[(place(i, from), place(j, at))] += both[(i, j)];
                        to.own[(place(j, at), place(i, from))] += both[(i, j)];
                    }
                }
                moved = &self.segments[at].transition * moved;
            }
        }
    }

    /// Products of a movement from the start of each segment with the columns of a source in it:
    /// states by columns.
    fn later_products(
        &self,
        (first, count): (usize, usize),
        ends: &[DMatrix<f64>],
    ) -> Vec<DMatrix<f64>> {
        let of = |at: usize| {
            let (segment, later) = (&self.segments[at], &self.later[at]);
            segment.own.view((0, first), (self.order, count))
                + segment.transition.tr_mul(&(&later.own * &ends[at]))
        };
        (0..self.segments.len()).map(of).collect()
    }
}
