//! Log odds of a hypothesis by the column itself: header, unit, range and shape.

use crate::data::ColumnData;
use crate::header::HeaderEvidence;
use crate::hypothesis::Hypothesis;
use crate::role::{Kind, Role};
use crate::summary::Summary;

/// Log odds of a given channel where a header names none: one of some thirty quantities.
const UNNAMED: f64 = -3.2;
/// What a header that clearly names something else takes from a channel, at most.
const NAMED_OTHERWISE: f64 = 8.0;
/// Log odds lost with a unit that is not the written one.
const OTHER_UNIT: f64 = 9.0;
/// Log odds lost with a reversed sign, and of a rudder's, which is common.
const REVERSED: f64 = 4.5;
const REVERSED_RUDDER: f64 = 3.6;
/// The same of a column without a name, whose sign nobody has stated.
const UNNAMED_RUDDER: f64 = 0.7;
/// Standard deviation, in natural logarithms, with which ranges fade.
const FADE: f64 = 0.45;
/// Log odds that a range can take.
const OUT_OF_RANGE: f64 = 14.0;

/// A column with what its header says and its values show.
#[derive(Debug, Clone)]
pub(crate) struct OwnEvidence {
    pub header: HeaderEvidence,
    pub summary: Summary,
    is_blank: bool,
}

impl OwnEvidence {
    pub(crate) fn new(column: &ColumnData, summary: &Summary) -> Self {
        let header = HeaderEvidence::new(&column.header, column.below.as_deref());
        let text = column.header.trim();
        let is_blank = text.is_empty() || text.starts_with('#') || header.candidates.is_empty();
        Self { header, summary: summary.clone(), is_blank }
    }

    /// Log odds against the column being none of the channels.
    pub(crate) fn odds(&self, what: &Hypothesis) -> f64 {
        if self.summary.count == 0 {
            return -OUT_OF_RANGE;
        }
        self.named(what.role) + self.unit(what) + self.sign(what) + self.range(what)
    }

    /// Log odds of a column that no channel holds.
    pub(crate) fn none(&self) -> f64 {
        let other = self.header.other().map_or(0.0, |(_, odds)| odds);
        if self.summary.is_counter { other.max(2.0) } else { other }
    }

    pub(crate) fn named(&self, role: Role) -> f64 {
        match self.header.odds(role) {
            Some(odds) => odds,
            // `speed` may be either speed, a heading is often called a course.
            None if self.alike(role) => self.header.best() - 3.0,
            None if self.is_blank => UNNAMED,
            None => UNNAMED - self.header.best().min(NAMED_OTHERWISE),
        }
    }

    /// Whether the header names a quantity that is often called by this one's name.
    fn alike(&self, role: Role) -> bool {
        const ALIKE: [(Role, Role); 11] = [
            (Role::Speed, Role::U),
            (Role::U, Role::Speed),
            (Role::Speed, Role::UWater),
            (Role::U, Role::UWater),
            (Role::V, Role::VWater),
            (Role::Psi, Role::Course),
            (Role::X, Role::Y),
            (Role::Y, Role::X),
            (Role::U, Role::VNorth),
            (Role::V, Role::VEast),
            (Role::Course, Role::Psi),
        ];
        let best = self.header.best();
        let is_best = |written: Role| self.header.odds(written).is_some_and(|odds| odds >= best);
        ALIKE.iter().any(|&(written, meant)| meant == role && is_best(written))
    }

    fn unit(&self, what: &Hypothesis) -> f64 {
        let kind = what.role.kind();
        if let Some((_, unit)) = self.summary.period
            && kind == Kind::Angle
            && unit != what.unit.name
        {
            return -OTHER_UNIT;
        }
        match self.header.unit(kind) {
            Some(written) if written == what.unit.name => 0.0,
            Some(_) => -OTHER_UNIT,
            // A unit of another kind is written: then it is another quantity.
            None if self.written_otherwise(kind) => -OTHER_UNIT,
            None => -unusual(what),
        }
    }

    fn written_otherwise(&self, kind: Kind) -> bool {
        // A name may end in the letter of a side, or be a unit itself: only units of several
        // letters speak against a quantity.
        let clear = |unit: &String| unit.len() > 1;
        !self.header.units.is_empty()
            && self.header.units.iter().all(clear)
            && self.header.unit(kind).is_none()
    }

    fn sign(&self, what: &Hypothesis) -> f64 {
        let is_rudder = matches!(what.role, Role::Delta | Role::DeltaS | Role::DeltaP);
        match (self.header.is_port_positive, what.is_reversed) {
            (true, false) => -OTHER_UNIT,
            (true, true) | (false, false) => 0.0,
            (false, true) if is_rudder && self.is_blank => -UNNAMED_RUDDER,
            // The rudders of a ship count the same way: each of two bears half of it.
            (false, true) if is_rudder && what.role != Role::Delta => -0.5 * REVERSED_RUDDER,
            (false, true) if is_rudder => -REVERSED_RUDDER,
            (false, true) => -REVERSED,
        }
    }

    fn range(&self, what: &Hypothesis) -> f64 {
        let summary = &self.summary;
        let [low, high] = what.role.largest();
        let size = match what.role {
            Role::X | Role::Y => summary.spread,
            Role::Psi | Role::Course if summary.period.is_none() => summary.spread,
            _ => summary.largest,
        } * what.unit.to_si;
        let out = if size < low { low / size.max(1e-12) } else { (size / high).max(1.0) };
        let faded = 0.5 * (out.ln() / FADE).powi(2);
        -(faded.min(OUT_OF_RANGE)) + self.shape(what)
    }

    /// What the shape of the values says for or against a quantity.
    fn shape(&self, what: &Hypothesis) -> f64 {
        let summary = &self.summary;
        let directed =
            matches!(what.role, Role::Psi | Role::Course | Role::WindFrom | Role::ApparentWindFrom);
        let returns = match (summary.period.is_some(), directed) {
            (true, true) => 3.0,
            (true, false) if what.role != Role::Longitude => -10.0,
            _ => 0.0,
        };
        let positive = matches!(
            what.role,
            Role::Speed | Role::WindSpeed | Role::ApparentWindSpeed | Role::Depth
        );
        let negative = if positive && summary.negative > 0.005 { -10.0 } else { 0.0 };
        let constant = match (summary.spread == 0.0, what.role) {
            (false, _) | (true, Role::N | Role::NS | Role::NP | Role::Depth) => 0.0,
            (true, _) => -4.0,
        };
        let place = matches!(what.role, Role::Latitude | Role::Longitude);
        // A place moves by minutes of arc in a trial, and is written with many digits.
        let moves = if place && summary.spread * what.unit.to_si > 0.2 { -10.0 } else { 0.0 };
        let swings = match (summary.swings, what.role) {
            (true, Role::Psi | Role::Course) => -6.0,
            (true, Role::Phi | Role::P) => 1.5,
            _ => 0.0,
        };
        let counted = if summary.is_counter { -6.0 } else { 0.0 };
        returns + negative + constant + moves + counted + swings
    }
}

/// Log odds lost with a unit that is less usual of a quantity whose unit is not written.
fn unusual(what: &Hypothesis) -> f64 {
    let is_log =
        matches!(what.role, Role::Speed | Role::UWater | Role::WindSpeed | Role::ApparentWindSpeed);
    match what.unit.name {
        "m/s" | "deg" | "m" | "deg/s" => 0.0,
        "kn" if is_log => 0.0,
        "rad" | "rad/s" | "rpm" | "rps" => 0.3,
        "deg/min" => 1.0,
        "kn" => 2.5,
        _ => 3.5,
    }
}
