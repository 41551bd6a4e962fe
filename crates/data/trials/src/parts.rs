//! Reading of several segments of a file in one pass, each into a table of its own.

use crate::clock::Clock;
use crate::findings::Findings;
use crate::mapping::Mapping;
use crate::number::Fault;
use crate::rows::Builder;
use crate::stretches::{Stretch, StretchFault, Window};
use crate::table::{Column, Table};
use crate::taker::{RowsFile, Taker};

/// Segment to be read: its label, and its mapping.
pub(crate) struct Asked<'a> {
    pub label: &'a str,
    pub mapping: &'a Mapping,
}

/// Reads segments. The findings on the header are added to those of each segment; a segment without
/// rows or with an error has no table.
pub(crate) fn read(
    mut file: impl RowsFile,
    asked: &[Asked],
    header: &Findings,
) -> Vec<(Option<Table>, Findings)> {
    let mut findings = vec![header.clone(); asked.len()];
    let columns = file.columns().to_vec();
    let builder = |(asked, findings)| Builder::new(columns.clone(), missing(asked), findings);
    let builders = asked.iter().zip(&mut findings).map(builder).collect();
    let mut parts = Parts::new(builders);
    let mut pass = Pass { asked, parts: &mut parts };
    file.each(&mut pass);
    let drops: Vec<bool> = parts.builders.iter().map(Builder::drops).collect();
    let Parts { builders, faults, windows, is_open, first_s, last_s, .. } = parts;
    let tables: Vec<Table> = builders.into_iter().map(Builder::finish).collect();
    let mut read = Vec::new();
    for (at, (mut table, mut findings)) in tables.into_iter().zip(findings).enumerate() {
        file.finish(drops[at], &mut table, &mut findings);
        let window = windows.iter().find(|(_, part)| *part == at).map(|(window, _)| *window);
        let outside = window.and_then(|window| window.fault(first_s, last_s));
        // The first fault that applies, from the most to the least fundamental.
        let open = is_open.then_some(StretchFault::Open);
        let empty = window.filter(|_| table.rows.is_empty() && !findings.has_errors());
        let empty = empty.map(|Window { from_s, to_s }| StretchFault::NoRow { from_s, to_s });
        let fault = open.or(faults[at].clone()).or(outside).or(empty);
        if let Some(fault) = &fault {
            findings.error(None, None, fault.to_string());
        }
        read.push((fault.is_none().then_some(table), findings));
    }
    read
}

fn missing(asked: &Asked) -> sistership_model::manifest::Missing {
    asked.mapping.conventions.missing
}

/// Tables under construction, and the assignment of times to them.
struct Parts<'a> {
    builders: Vec<Builder<'a>>,
    /// Windows in order of time, without overlap, with the index of the table.
    windows: Vec<(Window, usize)>,
    faults: Vec<Option<StretchFault>>,
    /// Window of times in which all rows belong to the table `at`, or to none.
    known: Window,
    at: Option<usize>,
    first_s: f64,
    last_s: f64,
    /// True if times cannot be converted row by row.
    is_open: bool,
}

impl<'a> Parts<'a> {
    fn new(builders: Vec<Builder<'a>>) -> Self {
        Self {
            faults: vec![None; builders.len()],
            builders,
            windows: Vec::new(),
            known: Window { from_s: f64::INFINITY, to_s: f64::NEG_INFINITY },
            at: None,
            first_s: f64::INFINITY,
            last_s: f64::NEG_INFINITY,
            is_open: false,
        }
    }

    /// Orders the segments in time, once the calendar time of time zero is known.
    fn settle(&mut self, asked: &[Asked], clock: &Clock) {
        let start = clock.start();
        let mut windows = Vec::new();
        for (at, asked) in asked.iter().enumerate() {
            let whole = Stretch { from: None, to: None };
            let stretch = asked.mapping.stretch.as_ref().unwrap_or(&whole);
            match stretch.window(start.as_ref()) {
                Ok(window) => windows.push((window, at)),
                Err(fault) => self.faults[at] = Some(fault),
            }
        }
        windows.sort_by(|a, b| a.0.from_s.total_cmp(&b.0.from_s));
        for (window, at) in windows {
            match self.windows.last().filter(|(before, _)| window.from_s < before.to_s) {
                Some((_, before)) => {
                    let other = asked[*before].label.to_owned();
                    self.faults[at] = Some(StretchFault::Overlap { other });
                }
                None => self.windows.push((window, at)),
            }
        }
    }

    /// Finds the table to which a time belongs, and the window in which this holds.
    fn locate(&mut self, t_s: f64) {
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
                (self.known, self.at) = (Window { from_s, to_s }, None);
            }
        }
    }
}

/// Row sink that distributes rows to the tables.
struct Pass<'a, 'b> {
    asked: &'a [Asked<'a>],
    parts: &'a mut Parts<'b>,
}

impl Taker for Pass<'_, '_> {
    const TIMED: bool = true;

    #[inline]
    fn wants(&mut self, _: usize, t_s: Option<f64>, clock: &Clock) -> bool {
        let parts = &mut *self.parts;
        // A row without a time belongs to the segment of the row before.
        let Some(t_s) = t_s else {
            parts.is_open = parts.is_open || clock.is_open();
            return parts.at.is_some();
        };
        if parts.first_s > parts.last_s {
            parts.settle(self.asked, clock);
        }
        parts.first_s = parts.first_s.min(t_s);
        parts.last_s = parts.last_s.max(t_s);
        // Times mostly ascend: a search is only needed where a row leaves the known window.
        if !(parts.known.from_s <= t_s && t_s <= parts.known.to_s) {
            parts.locate(t_s);
        }
        parts.at.is_some()
    }

    fn row(&mut self, row: usize, cell: impl FnMut(usize, &Column) -> Result<f64, Fault>) {
        if let Some(at) = self.parts.at {
            self.parts.builders[at].row(row, cell);
        }
    }

    fn short(&mut self, row: usize) {
        if let Some(at) = self.parts.at {
            self.parts.builders[at].short(row);
        }
    }

    fn held(&self) -> usize {
        self.parts.builders.iter().map(Builder::held).sum()
    }
}
