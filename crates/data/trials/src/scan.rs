//! Pass over a long log that reports the steering of the ship and stores nothing.

use std::io;
use std::path::Path;

use sistership_model::manifest::RudderSign;
use sistership_model::trial::{Channel, Finding};

use crate::clock::ColumnClock;
use crate::file_segments::SegmentFault;
use crate::findings::Findings;
use crate::mapping::Mapping;
use crate::number::CellFault;
use crate::outcome::Refusal;
use crate::read::{RowsVisitor, each_row};
use crate::row_sink::{RowSink, RowSource};
use crate::table::{ColumnTarget, RawQuantity, Table, TableColumn};
use crate::trial_file::TrialFile;

/// Steering and motion of a ship at one time, in SI units and radians; NaN where not measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteeringSample {
    /// Time, s, as in the table.
    pub t_s: f64,
    /// Rudder angle, rad, positive to starboard; the mean of a pair.
    pub rudder_rad: f64,
    /// Propeller revolutions, 1/s; the mean of a pair.
    pub revolutions_rps: f64,
    /// Yaw rate, rad/s.
    pub yaw_rate_rad_s: f64,
    /// Heading, rad, as recorded; not read if the yaw rate is measured.
    pub heading_rad: f64,
    /// Speed ahead, or over ground, m/s.
    pub speed_m_s: f64,
}

/// Calls `each` with every row of a file that has a time.
///
/// # Errors
/// Returns an error if the file cannot be read, lacks these columns, or needs its whole time column
/// for its times to be known.
pub fn scan_file(
    path: &Path,
    mapping: &Mapping,
    each: impl FnMut(&SteeringSample),
) -> Result<(), Refusal> {
    let file = path.display().to_string();
    let unreadable = |error: io::Error| Refusal {
        file: file.clone(),
        findings: vec![Finding {
            row: None,
            column: None,
            message: format!("cannot be read: {error}"),
        }],
    };
    let source = TrialFile::open(&file, path).map_err(unreadable)?;
    let mut findings = Findings::default();
    let visit =
        ScanVisitor { each, port: mapping.conventions.rudder_positive == RudderSign::PortTurn };
    if let Some(found) = each_row(source.content, mapping, &mut findings, visit) {
        findings = found;
    }
    let (errors, _) = findings.into_lists();
    if errors.is_empty() { Ok(()) } else { Err(Refusal { file, findings: errors }) }
}

struct ScanVisitor<F> {
    each: F,
    port: bool,
}

impl<F: FnMut(&SteeringSample)> RowsVisitor for ScanVisitor<F> {
    type Output = Findings;

    fn visit_rows(self, mut file: impl RowSource, header: &Findings) -> Findings {
        let mut findings = header.clone();
        let places = SteeringColumns::from_columns(file.columns(), self.port);
        let mut scan = SteeringScan { each: self.each, places, t_s: f64::NAN, is_open: false };
        file.feed_rows(&mut scan);
        // Rows without a known time were skipped: the scan is not complete.
        if scan.is_open {
            findings.error(None, None, SegmentFault::Open.to_string());
        }
        // No table is built: only the findings of the reader are needed.
        file.complete_table(true, &mut Table::default(), &mut findings);
        findings
    }
}

/// Positions of the column of a quantity, or of a pair, with the factor to SI units.
type ColumnPair = [Option<(usize, f64)>; 2];

/// Columns of the quantities of [`SteeringSample`].
struct SteeringColumns {
    rudder: ColumnPair,
    revolutions: ColumnPair,
    yaw: ColumnPair,
    heading: ColumnPair,
    speed: ColumnPair,
    /// All columns by position, as the cell reader needs them.
    columns: Vec<TableColumn>,
}

impl SteeringColumns {
    fn from_columns(columns: &[TableColumn], port: bool) -> Self {
        let sign = if port { -1.0 } else { 1.0 };
        let at = |target: ColumnTarget| {
            let found = columns.iter().position(|column| column.target == target)?;
            Some((found, columns[found].to_si))
        };
        let one = |channel: Channel| [at(ColumnTarget::Channel(channel)), None];
        let or =
            |first: ColumnPair, second: ColumnPair| if first[0].is_some() { first } else { second };
        let pair = |one: Channel, other: Channel| {
            [at(ColumnTarget::Channel(one)), at(ColumnTarget::Channel(other))]
        };
        let signed =
            |place: ColumnPair| place.map(|one| one.map(|(at, factor)| (at, sign * factor)));
        // The pair of a twin ship is read only if the channel itself is absent.
        let yaw = one(Channel::R);
        Self {
            rudder: signed(or(one(Channel::Delta), pair(Channel::DeltaS, Channel::DeltaP))),
            revolutions: or(one(Channel::N), pair(Channel::NS, Channel::NP)),
            yaw,
            // The heading is only needed where there is no yaw rate.
            heading: if yaw[0].is_some() { [None, None] } else { one(Channel::Psi) },
            speed: or(one(Channel::U), [at(ColumnTarget::Raw(RawQuantity::Speed)), None]),
            columns: columns.to_vec(),
        }
    }
}

struct SteeringScan<F> {
    each: F,
    places: SteeringColumns,
    t_s: f64,
    is_open: bool,
}

impl<F: FnMut(&SteeringSample)> RowSink for SteeringScan<F> {
    const TIMED: bool = true;

    #[inline]
    fn accepts_row(&mut self, _: usize, t_s: Option<f64>, clock: &ColumnClock) -> bool {
        self.t_s = t_s.unwrap_or(f64::NAN);
        self.is_open = self.is_open || (t_s.is_none() && clock.is_open());
        t_s.is_some()
    }

    #[inline]
    fn take_row(
        &mut self,
        _: usize,
        mut cell: impl FnMut(usize, &TableColumn) -> Result<f64, CellFault>,
    ) {
        let places = &self.places;
        let mut number = |place: Option<(usize, f64)>| {
            let (at, factor) = place?;
            let column = &places.columns[at];
            cell(at, column).ok().map(|value| factor * (value - column.at_rest))
        };
        let mut mean = |[one, other]: ColumnPair| match (number(one), number(other)) {
            (Some(one), Some(other)) => 0.5 * (one + other),
            (one, other) => one.or(other).unwrap_or(f64::NAN),
        };
        let steering = SteeringSample {
            t_s: self.t_s,
            rudder_rad: mean(places.rudder),
            revolutions_rps: mean(places.revolutions),
            yaw_rate_rad_s: mean(places.yaw),
            heading_rad: mean(places.heading),
            speed_m_s: mean(places.speed),
        };
        (self.each)(&steering);
    }

    fn take_short_row(&mut self, _: usize) {}

    fn stored_rows(&self) -> usize {
        0
    }
}
