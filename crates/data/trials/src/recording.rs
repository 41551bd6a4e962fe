//! A trial on its way through the checks: canonical samples, and the row and column that each came
//! from.

use std::collections::BTreeMap;
use std::ops::Range;

use sistership_model::trial::{Channel, Trial};

use crate::derived_channel::DerivedChannel;
use crate::exclusion::Exclusion;
use crate::findings::Hits;
use crate::table::{Column, Raw, Start, Target};
use crate::units::Kind;

/// Canonical samples and where they stand in the file.
#[derive(Debug, Default)]
pub(crate) struct Recording {
    pub trial: Trial,
    /// Whether it is a stretch of a file, which starts when it does.
    pub is_stretch: bool,
    pub rows: Vec<u32>,
    /// Rows before which others have been left out.
    pub resumed: Vec<u32>,
    /// Header of the time column.
    pub time: String,
    pub columns: BTreeMap<Channel, Column>,
    /// What channels have yet to be made of.
    pub raw: BTreeMap<Raw, Vec<f64>>,
    /// Channels that were not measured.
    pub derived: Vec<DerivedChannel>,
    /// What time zero is in the calendar, where the file says it.
    pub start: Option<Start>,
    /// Faults that were found in the file's values, where they were looked for.
    pub faults: Vec<Exclusion>,
    /// Median time between samples, s; zero until time is known to be in order.
    pub interval_s: f64,
    /// Ranges without a gap; empty until time is known to be in order.
    pub segments: Vec<Range<usize>>,
}

impl Recording {
    /// The row of a sample.
    pub(crate) fn row(&self, sample: usize) -> usize {
        self.rows.get(sample).map_or(0, |&row| row as usize)
    }

    /// The column's name in the file, or the channel's own.
    pub(crate) fn header(&self, channel: Channel) -> &str {
        self.columns.get(&channel).map_or(channel.name(), |column| &column.header)
    }

    /// The declared unit.
    pub(crate) fn unit(&self, channel: Channel) -> &str {
        self.columns.get(&channel).map_or("", |column| &column.unit)
    }

    /// The unit of the samples.
    pub(crate) fn canonical_unit(&self, channel: Channel) -> &'static str {
        Kind::of(Target::Channel(channel)).canonical()
    }

    pub(crate) fn channel(&self, channel: Channel) -> Option<&[f64]> {
        self.trial.channel(channel)
    }

    pub(crate) fn time(&self) -> &[f64] {
        &self.trial.t_s
    }

    /// Samples that a test holds for, each with its row.
    pub(crate) fn hits(&self, samples: Range<usize>, holds: impl Fn(usize) -> bool) -> Hits {
        let mut hits = Hits::default();
        samples.filter(|&k| holds(k)).for_each(|k| hits.add((k, self.row(k))));
        hits
    }

    /// Takes ranges of samples, in order, out of every channel; the rows that follow them resume.
    pub(crate) fn leave_out(&mut self, ranges: &[Range<usize>]) {
        let resumed = ranges.iter().filter_map(|range| self.rows.get(range.end).copied());
        self.resumed.extend(resumed.collect::<Vec<_>>());
        self.resumed.sort_unstable();
        self.resumed.dedup();
        let channels = self.trial.channels.values_mut();
        let variances = self.derived.iter_mut().map(|derived| &mut derived.variance);
        let raw = self.raw.values_mut();
        for values in channels.chain(variances).chain(raw).chain([&mut self.trial.t_s]) {
            without(values, ranges);
        }
        without(&mut self.rows, ranges);
        let rows = &self.rows;
        self.resumed.retain(|row| rows.binary_search(row).is_ok());
    }

    /// Learns interval and segments; time must be strictly increasing.
    pub(crate) fn settle_time(&mut self) {
        self.interval_s = self.trial.interval_s();
        self.segments = self.trial.segments();
    }
}

fn without<T>(values: &mut Vec<T>, ranges: &[Range<usize>]) {
    let (mut at, mut next) = (0, ranges.iter().peekable());
    values.retain(|_| {
        while next.next_if(|range| range.end <= at).is_some() {}
        let kept = next.peek().is_none_or(|range| at < range.start);
        at += 1;
        kept
    });
}
