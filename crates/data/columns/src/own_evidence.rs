//! Log odds of a hypothesis from the column alone: header, unit, range and shape.

use crate::data::ColumnData;
use crate::header::HeaderEvidence;
use crate::hypothesis::Hypothesis;
use crate::role::{QuantityKind, Role};
use crate::summary::ColumnSummary;

/// Log odds of a given channel where a header names none: one of some thirty quantities.
const UNNAMED: f64 = -3.2;
/// The same where no column of a file has a name: most columns of such files are channels.
const NAMELESS: f64 = -1.5;
/// Largest loss of log odds of a channel whose column clearly names another quantity.
const NAMED_OTHERWISE: f64 = 8.0;
/// Log odds lost with a unit that is not the written one.
const OTHER_UNIT: f64 = 9.0;
/// Log odds lost with a reversed sign; of a rudder, whose reversed sign is common; and of a rudder
/// column without a name, whose sign is not stated anywhere.
const REVERSED: f64 = 4.5;
const REVERSED_RUDDER: f64 = 3.6;
const UNNAMED_RUDDER: f64 = 0.7;
/// Unrest of a column that a rudder and the ship's motions have equally often: rudders of the given
/// recordings have 0.00 to 0.02, velocities and roll 0.02 to 0.5.
const HELD: f64 = 0.04;
/// Standard deviation, in natural logarithms, of the size of a value outside the usual range.
const FADE: f64 = 0.45;
/// Largest loss of log odds by the range.
const OUT_OF_RANGE: f64 = 14.0;

/// Evidence of a single column: its header and the summary of its values.
#[derive(Debug, Clone)]
pub(crate) struct OwnEvidence {
    pub header: HeaderEvidence,
    pub summary: ColumnSummary,
    is_blank: bool,
    /// Log odds of a channel that the header does not name.
    unnamed: f64,
}

impl OwnEvidence {
    pub(crate) fn new(column: &ColumnData, summary: &ColumnSummary) -> Self {
        let header = HeaderEvidence::new(&column.header, column.below.as_deref());
        let text = column.header.trim();
        let is_blank = text.is_empty() || text.starts_with('#') || header.candidates.is_empty();
        Self { header, summary: summary.clone(), is_blank, unnamed: UNNAMED }
    }

    /// Marks the columns of a file in which no column has a name.
    pub(crate) fn mark_nameless(all: &mut [Self]) {
        if all.iter().all(|own| own.is_blank) {
            all.iter_mut().for_each(|own| own.unnamed = NAMELESS);
        }
    }

    /// Returns the log odds of a hypothesis against the column being none of the channels.
    pub(crate) fn hypothesis_odds(&self, what: &Hypothesis) -> f64 {
        if self.summary.count == 0 {
            return -OUT_OF_RANGE;
        }
        self.name_odds(what.role)
            + self.unit_odds(what)
            + self.sign_odds(what)
            + self.range_odds(what)
    }

    /// Returns true if the column has numbers, and its header names no quantity.
    pub(crate) fn is_open(&self) -> bool {
        self.is_blank && self.summary.count > 0
    }

    /// Returns the log odds of the column holding none of the channels.
    pub(crate) fn unassigned_odds(&self) -> f64 {
        let other = self.header.other_quantity().map_or(0.0, |(_, odds)| odds);
        if self.summary.is_counter { other.max(2.0) } else { other }
    }

    pub(crate) fn name_odds(&self, role: Role) -> f64 {
        match self.header.role_odds(role) {
            Some(odds) => odds,
            // `speed` may be either speed, a heading is often called a course.
            None if self.shares_name(role) => self.header.best_odds() - 3.0,
            None if self.is_blank => self.unnamed,
            None => self.unnamed - self.header.best_odds().min(NAMED_OTHERWISE),
        }
    }

    /// Returns true if the header names a quantity whose name is often used for the given one.
    fn shares_name(&self, role: Role) -> bool {
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
        let best = self.header.best_odds();
        let is_best =
            |written: Role| self.header.role_odds(written).is_some_and(|odds| odds >= best);
        ALIKE.iter().any(|&(written, meant)| meant == role && is_best(written))
    }

    fn unit_odds(&self, what: &Hypothesis) -> f64 {
        let kind = what.role.kind();
        // Values that wrap at 360 or 2 pi show their unit, whatever is written.
        if let Some((_, unit)) = self.summary.period
            && kind == QuantityKind::Angle
            && unit != what.unit.name
        {
            return -OTHER_UNIT;
        }
        match self.header.unit_of_kind(kind) {
            Some(written) if written == what.unit.name => 0.0,
            Some(_) => -OTHER_UNIT,
            // A written unit of another kind means another quantity.
            None if self.has_other_unit(kind) => -OTHER_UNIT,
            None => -unusual_unit_odds(what),
        }
    }

    /// Returns the log odds that a hypothesis loses by an unusual unit that is not written.
    pub(crate) fn unusual_unit_loss(&self, what: &Hypothesis) -> f64 {
        match self.header.units.is_empty() {
            true => unusual_unit_odds(what),
            false => 0.0,
        }
    }

    fn has_other_unit(&self, kind: QuantityKind) -> bool {
        // A name may end in the letter of a side, or be a unit itself: only units of several
        // letters speak against a quantity.
        let clear = |unit: &String| unit.len() > 1;
        !self.header.units.is_empty()
            && self.header.units.iter().all(clear)
            && self.header.unit_of_kind(kind).is_none()
    }

    fn sign_odds(&self, what: &Hypothesis) -> f64 {
        let is_rudder = matches!(what.role, Role::Delta | Role::DeltaS | Role::DeltaP);
        match (self.header.is_port_positive, what.is_reversed) {
            (true, false) => -OTHER_UNIT,
            (true, true) | (false, false) => 0.0,
            (false, true) if is_rudder && self.is_blank => -UNNAMED_RUDDER,
            // The rudders of a ship have the same sign: each of two bears half of the loss.
            (false, true) if is_rudder && what.role != Role::Delta => -0.5 * REVERSED_RUDDER,
            (false, true) if is_rudder => -REVERSED_RUDDER,
            (false, true) => -REVERSED,
        }
    }

    fn range_odds(&self, what: &Hypothesis) -> f64 {
        let summary = &self.summary;
        let [low, high] = what.role.usual_range();
        // Positions and unwrapped headings have an arbitrary origin: their spread counts, not their
        // size.
        let size = match what.role {
            Role::X | Role::Y => summary.spread,
            Role::Psi | Role::Course if summary.period.is_none() => summary.spread,
            _ => summary.largest,
        } * what.unit.to_si;
        // A straight run has no rudder, no drift and one heading, so that a constant says nothing
        // of how small such a quantity is; speeds and revolutions have a size even then.
        let has_size =
            matches!(what.role, Role::U | Role::Speed | Role::UWater | Role::Depth | Role::N)
                || matches!(what.role, Role::NS | Role::NP);
        let is_small = size < low && (summary.spread > 0.0 || has_size);
        let out = if is_small { low / size.max(1e-12) } else { (size / high).max(1.0) };
        // A log-normal tail outside the usual range, bounded so that relations may outweigh it.
        let faded = 0.5 * (out.ln() / FADE).powi(2);
        -(faded.min(OUT_OF_RANGE)) + self.shape_odds(what)
    }

    /// Returns the log odds of a quantity by the shape of the values.
    fn shape_odds(&self, what: &Hypothesis) -> f64 {
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
        // Revolutions and depth are often constant; other quantities change in a manoeuvre.
        let constant = match (summary.spread == 0.0, what.role) {
            (false, _) | (true, Role::N | Role::NS | Role::NP | Role::Depth) => 0.0,
            (true, _) => -4.0,
        };
        let place = matches!(what.role, Role::Latitude | Role::Longitude);
        // A place moves by minutes of arc in a trial, and is written with many digits.
        let moves = if place && summary.spread * what.unit.to_si > 0.2 { -10.0 } else { 0.0 };
        let swings = match (summary.swings, what.role) {
            (true, Role::Psi | Role::Course) => -8.0,
            (true, Role::R) => -2.0,
            (true, Role::Phi | Role::P) => 1.5,
            _ => 0.0,
        };
        let counted = if summary.is_counter { -6.0 } else { 0.0 };
        returns + negative + constant + moves + counted + swings + self.rudder_odds(what)
    }

    /// Returns the log odds of a rudder without a name: it is held between its movements, and moves
    /// about amidships.
    fn rudder_odds(&self, what: &Hypothesis) -> f64 {
        let is_rudder = matches!(what.role, Role::Delta | Role::DeltaS | Role::DeltaP);
        if !is_rudder || !self.is_blank {
            return 0.0;
        }
        let unrest = self.summary.unrest.unwrap_or(HELD);
        let held = (2.0 * (HELD / unrest.max(1e-3)).ln()).clamp(-5.0, 0.0);
        let is_offset = self.summary.spread < 0.2 * self.summary.largest;
        held + if is_offset { -2.0 } else { 0.0 }
    }
}

/// Returns the log odds lost with a less usual unit where the header states none.
fn unusual_unit_odds(what: &Hypothesis) -> f64 {
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
