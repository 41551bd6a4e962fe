//! Trial during the checks: canonical samples, with the row and column of each in the file.

use std::collections::BTreeMap;
use std::ops::Range;

use sistership_model::trial::{Channel, Trial};

use crate::declarations::GeographicPosition;
use crate::derived_channel::DerivedChannel;
use crate::exclusion::Exclusion;
use crate::findings::FaultySamples;
use crate::table::{ColumnTarget, RawQuantity, TableColumn, TimeOrigin};
use crate::units::UnitKind;

/// Canonical samples and their places in the file.
#[derive(Debug, Default)]
pub(crate) struct Recording {
    pub trial: Trial,
    /// True if it is a segment of a file, so that its time need not start at zero.
    pub is_stretch: bool,
    pub rows: Vec<u32>,
    /// Rows before which other rows have been excluded.
    pub resumed: Vec<u32>,
    /// Header of the time column.
    pub time: String,
    pub columns: BTreeMap<Channel, TableColumn>,
    /// Quantities from which channels are still to be computed.
    pub raw: BTreeMap<RawQuantity, Vec<f64>>,
    /// Channels that were derived.
    pub derived: Vec<DerivedChannel>,
    /// Calendar time of time zero, if the file contains it.
    pub start: Option<TimeOrigin>,
    /// Geographic position of the origin of `x` and `y`.
    pub origin: Option<GeographicPosition>,
    /// Faults of the values of the file, if they were searched.
    pub faults: Vec<Exclusion>,
    /// Median time between samples, s; zero until time is known to increase.
    pub interval_s: f64,
    /// Ranges without a gap; empty until time is known to increase.
    pub segments: Vec<Range<usize>>,
}

impl Recording {
    /// Returns the row of a sample in the file.
    pub(crate) fn row_number(&self, sample: usize) -> usize {
        self.rows.get(sample).map_or(0, |&row| row as usize)
    }

    /// Returns the name of the column in the file, or of the channel.
    pub(crate) fn column_header(&self, channel: Channel) -> &str {
        self.columns.get(&channel).map_or(channel.name(), |column| &column.header)
    }

    /// Returns the declared unit of a channel.
    pub(crate) fn declared_unit(&self, channel: Channel) -> &str {
        self.columns.get(&channel).map_or("", |column| &column.unit)
    }

    /// Returns the unit of the samples.
    pub(crate) fn canonical_unit(&self, channel: Channel) -> &'static str {
        UnitKind::from_target(ColumnTarget::Channel(channel)).canonical_unit()
    }

    pub(crate) fn channel(&self, channel: Channel) -> Option<&[f64]> {
        self.trial.channel(channel)
    }

    pub(crate) fn time(&self) -> &[f64] {
        &self.trial.t_s
    }

    /// Returns the samples that satisfy a condition, each with its row.
    pub(crate) fn find_samples(
        &self,
        samples: Range<usize>,
        holds: impl Fn(usize) -> bool,
    ) -> FaultySamples {
        let mut hits = FaultySamples::default();
        samples.filter(|&k| holds(k)).for_each(|k| hits.record_sample((k, self.row_number(k))));
        hits
    }

    /// Removes ranges of samples, in ascending order, from every channel; the rows after them are
    /// marked as resumed.
    pub(crate) fn leave_out(&mut self, ranges: &[Range<usize>]) {
        let resumed = ranges.iter().filter_map(|range| self.rows.get(range.end).copied());
        self.resumed.extend(resumed.collect::<Vec<_>>());
        self.resumed.sort_unstable();
        self.resumed.dedup();
        let channels = self.trial.channels.values_mut();
        let variances = self.derived.iter_mut().map(|derived| &mut derived.variance);
        let raw = self.raw.values_mut();
        for values in channels.chain(variances).chain(raw).chain([&mut self.trial.t_s]) {
            remove_ranges(values, ranges);
        }
        remove_ranges(&mut self.rows, ranges);
        let rows = &self.rows;
        // A row that was marked earlier may be removed now.
        self.resumed.retain(|row| rows.binary_search(row).is_ok());
    }

    /// Computes sampling interval and segments; time must be strictly increasing.
    pub(crate) fn settle_time(&mut self) {
        self.interval_s = self.trial.interval_s();
        self.segments = self.trial.segments();
    }
}

fn remove_ranges<T>(values: &mut Vec<T>, ranges: &[Range<usize>]) {
    let (mut at, mut next) = (0, ranges.iter().peekable());
    values.retain(|_| {
        while next.next_if(|range| range.end <= at).is_some() {}
        let kept = next.peek().is_none_or(|range| at < range.start);
        at += 1;
        kept
    });
}
