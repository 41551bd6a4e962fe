//! Reading of several segments of a file in one pass, each into a table of its own.

use crate::clock::ColumnClock;
use crate::file_segments::{FileSegment, SegmentFault, TimeWindow};
use crate::findings::Findings;
use crate::mapping::Mapping;
use crate::number::CellFault;
use crate::row_sink::{RowSink, RowSource};
use crate::rows::TableBuilder;
use crate::table::{Table, TableColumn};

/// Segment to be read: its label, and its mapping.
pub(crate) struct LabelledMapping<'a> {
    pub label: &'a str,
    pub mapping: &'a Mapping,
}

/// Reads segments. The findings on the header are added to those of each segment; a segment without
/// rows or with an error has no table.
pub(crate) fn read_tables(
    mut file: impl RowSource,
    asked: &[LabelledMapping],
    header: &Findings,
) -> Vec<(Option<Table>, Findings)> {
    let mut findings = vec![header.clone(); asked.len()];
    let columns = file.columns().to_vec();
    let builder =
        |(asked, findings)| TableBuilder::new(columns.clone(), missing_policy(asked), findings);
    let builders = asked.iter().zip(&mut findings).map(builder).collect();
    let mut parts = SegmentTables::new(builders);
    let mut pass = SegmentPass { asked, parts: &mut parts };
    file.feed_rows(&mut pass);
    let drops: Vec<bool> = parts.builders.iter().map(TableBuilder::drops_rows).collect();
    let SegmentTables { builders, faults, windows, is_open, first_s, last_s, .. } = parts;
    let tables: Vec<Table> = builders.into_iter().map(TableBuilder::finish_table).collect();
    let mut read = Vec::new();
    for (at, (mut table, mut findings)) in tables.into_iter().zip(findings).enumerate() {
        file.complete_table(drops[at], &mut table, &mut findings);
        let window = windows.iter().find(|(_, part)| *part == at).map(|(window, _)| *window);
        let outside = window.and_then(|window| window.window_fault(first_s, last_s));
        // The first fault that applies, from the most to the least fundamental.
        let open = is_open.then_some(SegmentFault::Open);
        let empty = window.filter(|_| table.rows.is_empty() && !findings.has_errors());
        let empty = empty.map(|TimeWindow { from_s, to_s }| SegmentFault::NoRow { from_s, to_s });
        let fault = open.or(faults[at].clone()).or(outside).or(empty);
        if let Some(fault) = &fault {
            findings.error(None, None, fault.to_string());
        }
        read.push((fault.is_none().then_some(table), findings));
    }
    read
}

fn missing_policy(asked: &LabelledMapping) -> sistership_model::manifest::MissingValues {
    asked.mapping.conventions.missing
}

/// Tables under construction, and the assignment of times to them.
struct SegmentTables<'a> {
    builders: Vec<TableBuilder<'a>>,
    /// Windows in order of time, without overlap, with the index of the table.
    windows: Vec<(TimeWindow, usize)>,
    faults: Vec<Option<SegmentFault>>,
    /// Window of times in which all rows belong to the table `at`, or to none.
    known: TimeWindow,
    at: Option<usize>,
    first_s: f64,
    last_s: f64,
    /// True if times cannot be converted row by row.
    is_open: bool,
}

impl<'a> SegmentTables<'a> {
    fn new(builders: Vec<TableBuilder<'a>>) -> Self {
        Self {
            faults: vec![None; builders.len()],
            builders,
            windows: Vec::new(),
            known: TimeWindow { from_s: f64::INFINITY, to_s: f64::NEG_INFINITY },
            at: None,
            first_s: f64::INFINITY,
            last_s: f64::NEG_INFINITY,
            is_open: false,
        }
    }

    /// Orders the segments in time, once the calendar time of time zero is known.
    fn order_windows(&mut self, asked: &[LabelledMapping], clock: &ColumnClock) {
        let start = clock.time_zero();
        let mut windows = Vec::new();
        for (at, asked) in asked.iter().enumerate() {
            let whole = FileSegment { from: None, to: None };
            let stretch = asked.mapping.stretch.as_ref().unwrap_or(&whole);
            match stretch.time_window(start.as_ref()) {
                Ok(window) => windows.push((window, at)),
                Err(fault) => self.faults[at] = Some(fault),
            }
        }
        windows.sort_by(|a, b| a.0.from_s.total_cmp(&b.0.from_s));
        for (window, at) in windows {
            match self.windows.last().filter(|(before, _)| window.from_s < before.to_s) {
                Some((_, before)) => {
                    let other = asked[*before].label.to_owned();
                    self.faults[at] = Some(SegmentFault::Overlap { other });
                }
                None => self.windows.push((window, at)),
            }
        }
    }

    /// Finds the table to which a time belongs, and the window in which this holds.
    fn locate_table(&mut self, t_s: f64) {
        // The first window that does not end before `t_s`.
        let next = self.windows.partition_point(|(window, _)| window.to_s < t_s);
        let ends = next.checked_sub(1).map(|before| self.windows[before].0.to_s.next_up());
        match self.windows.get(next) {
            Some(&(window, part)) if window.from_s <= t_s => {
                self.known = window;
                self.at = Some(part);
            }
            other => {
                let from_s = ends.unwrap_or(f64::NEG_INFINITY);
                let to_s = other.map_or(f64::INFINITY, |(window, _)| window.from_s.next_down());
                (self.known, self.at) = (TimeWindow { from_s, to_s }, None);
            }
        }
    }
}

/// Row sink that distributes rows to the tables.
struct SegmentPass<'a, 'b> {
    asked: &'a [LabelledMapping<'a>],
    parts: &'a mut SegmentTables<'b>,
}

impl RowSink for SegmentPass<'_, '_> {
    const TIMED: bool = true;

    #[inline]
    fn accepts_row(&mut self, _: usize, t_s: Option<f64>, clock: &ColumnClock) -> bool {
        let parts = &mut *self.parts;
        // A row without a time belongs to the segment of the row before.
        let Some(t_s) = t_s else {
            parts.is_open = parts.is_open || clock.is_open();
            return parts.at.is_some();
        };
        if parts.first_s > parts.last_s {
            parts.order_windows(self.asked, clock);
        }
        parts.first_s = parts.first_s.min(t_s);
        parts.last_s = parts.last_s.max(t_s);
        // Times mostly ascend: a search is only needed where a row leaves the known window.
        if !(parts.known.from_s <= t_s && t_s <= parts.known.to_s) {
            parts.locate_table(t_s);
        }
        parts.at.is_some()
    }

    fn take_row(
        &mut self,
        row: usize,
        cell: impl FnMut(usize, &TableColumn) -> Result<f64, CellFault>,
    ) {
        if let Some(at) = self.parts.at {
            self.parts.builders[at].take_row(row, cell);
        }
    }

    fn take_short_row(&mut self, row: usize) {
        if let Some(at) = self.parts.at {
            self.parts.builders[at].take_short_row(row);
        }
    }

    fn stored_rows(&self) -> usize {
        self.parts.builders.iter().map(TableBuilder::stored_rows).sum()
    }
}
