//! Pass over a long log that reports the steering of the ship and stores nothing.

use std::io;
use std::path::Path;

use sistership_model::manifest::RudderSign;
use sistership_model::trial::{Channel, Finding};

use crate::clock::Clock;
use crate::findings::Findings;
use crate::mapping::Mapping;
use crate::number::Fault;
use crate::outcome::Refusal;
use crate::read::{Visit, each_row};
use crate::source::Source;
use crate::stretches::StretchFault;
use crate::table::{Column, Raw, Table, Target};
use crate::taker::{RowsFile, Taker};

/// Steering and motion of a ship at one time, in SI units and radians; NaN where not measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steering {
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
pub fn scan(path: &Path, mapping: &Mapping, each: impl FnMut(&Steering)) -> Result<(), Refusal> {
    let file = path.display().to_string();
    let unreadable = |error: io::Error| Refusal {
        file: file.clone(),
        findings: vec![Finding {
            row: None,
            column: None,
            message: format!("cannot be read: {error}"),
        }],
    };
    let source = Source::open(&file, path).map_err(unreadable)?;
    let mut findings = Findings::default();
    let visit =
        ScanVisit { each, port: mapping.conventions.rudder_positive == RudderSign::PortTurn };
    if let Some(found) = each_row(source.content, mapping, &mut findings, visit) {
        findings = found;
    }
    let (errors, _) = findings.finish();
    if errors.is_empty() { Ok(()) } else { Err(Refusal { file, findings: errors }) }
}

struct ScanVisit<F> {
    each: F,
    port: bool,
}

impl<F: FnMut(&Steering)> Visit for ScanVisit<F> {
    type Output = Findings;

    fn visit(self, mut file: impl RowsFile, header: &Findings) -> Findings {
        let mut findings = header.clone();
        let places = Places::of(file.columns(), self.port);
        let mut scan = Scan { each: self.each, places, t_s: f64::NAN, is_open: false };
        file.each(&mut scan);
        // Rows without a known time were skipped: the scan is not complete.
        if scan.is_open {
            findings.error(None, None, StretchFault::Open.to_string());
        }
        // No table is built: only the findings of the reader are needed.
        file.finish(true, &mut Table::default(), &mut findings);
        findings
    }
}

/// Positions of the column of a quantity, or of a pair, with the factor to SI units.
type Place = [Option<(usize, f64)>; 2];

/// Columns of the quantities of [`SteeringSample`].
struct Places {
    rudder: Place,
    revolutions: Place,
    yaw: Place,
    heading: Place,
    speed: Place,
    /// All columns by position, as the cell reader needs them.
    columns: Vec<Column>,
}

impl Places {
    fn of(columns: &[Column], port: bool) -> Self {
        let sign = if port { -1.0 } else { 1.0 };
        let at = |target: Target| {
            let found = columns.iter().position(|column| column.target == target)?;
            Some((found, columns[found].to_si))
        };
        let one = |channel: Channel| [at(Target::Channel(channel)), None];
        let or = |first: Place, second: Place| if first[0].is_some() { first } else { second };
        let raw = |one: Raw, other: Raw| [at(Target::Raw(one)), at(Target::Raw(other))];
        let signed = |place: Place| place.map(|one| one.map(|(at, factor)| (at, sign * factor)));
        // The pair of a twin ship is read only if the channel itself is absent.
        let yaw = one(Channel::R);
        Self {
            rudder: signed(or(one(Channel::Delta), raw(Raw::DeltaS, Raw::DeltaP))),
            revolutions: or(one(Channel::N), raw(Raw::NS, Raw::NP)),
            yaw,
            // The heading is only needed where there is no yaw rate.
            heading: if yaw[0].is_some() { [None, None] } else { one(Channel::Psi) },
            speed: or(one(Channel::U), [at(Target::Raw(Raw::Speed)), None]),
            columns: columns.to_vec(),
        }
    }
}

struct Scan<F> {
    each: F,
    places: Places,
    t_s: f64,
    is_open: bool,
}

impl<F: FnMut(&Steering)> Taker for Scan<F> {
    const TIMED: bool = true;

    #[inline]
    fn wants(&mut self, _: usize, t_s: Option<f64>, clock: &Clock) -> bool {
        self.t_s = t_s.unwrap_or(f64::NAN);
        self.is_open = self.is_open || (t_s.is_none() && clock.is_open());
        t_s.is_some()
    }

    #[inline]
    fn row(&mut self, _: usize, mut cell: impl FnMut(usize, &Column) -> Result<f64, Fault>) {
        let places = &self.places;
        let mut number = |place: Option<(usize, f64)>| {
            let (at, factor) = place?;
            cell(at, &places.columns[at]).ok().map(|value| factor * value)
        };
        let mut mean = |[one, other]: Place| match (number(one), number(other)) {
            (Some(one), Some(other)) => 0.5 * (one + other),
            (one, other) => one.or(other).unwrap_or(f64::NAN),
        };
        let steering = Steering {
            t_s: self.t_s,
            rudder_rad: mean(places.rudder),
            revolutions_rps: mean(places.revolutions),
            yaw_rate_rad_s: mean(places.yaw),
            heading_rad: mean(places.heading),
            speed_m_s: mean(places.speed),
        };
        (self.each)(&steering);
    }

    fn short(&mut self, _: usize) {}

    fn held(&self) -> usize {
        0
    }
}
