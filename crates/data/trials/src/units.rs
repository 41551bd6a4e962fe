//! Units in which a channel may be given, and the suffixes that name them in a header.

use sistership_formula::units::{Dimension, Unit};
use sistership_model::trial::Channel;

use crate::table::ColumnTarget;

/// Physical kind of a column. Dimensions alone cannot distinguish a yaw rate from propeller
/// revolutions: both are 1/s, but one counts radians and the other turns, and 80 rpm read as a yaw
/// rate would be wrong by a factor of two pi.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum UnitKind {
    Time,
    Length,
    Speed,
    Angle,
    Rate,
    Revolutions,
}

/// Header suffix, kind, unit. The suffix `ms` is a millisecond for time and a metre per second for
/// a speed.
const SUFFIXES: &[(&str, UnitKind, &str)] = &[
    ("s", UnitKind::Time, "s"),
    ("sec", UnitKind::Time, "s"),
    ("ms", UnitKind::Time, "ms"),
    ("us", UnitKind::Time, "us"),
    ("ns", UnitKind::Time, "ns"),
    ("min", UnitKind::Time, "min"),
    ("h", UnitKind::Time, "h"),
    ("m", UnitKind::Length, "m"),
    ("km", UnitKind::Length, "km"),
    ("nmi", UnitKind::Length, "nmi"),
    ("m_s", UnitKind::Speed, "m/s"),
    ("mps", UnitKind::Speed, "m/s"),
    ("ms", UnitKind::Speed, "m/s"),
    ("kn", UnitKind::Speed, "kn"),
    ("kt", UnitKind::Speed, "kn"),
    ("kts", UnitKind::Speed, "kn"),
    ("km_h", UnitKind::Speed, "km/h"),
    ("kmh", UnitKind::Speed, "km/h"),
    ("kmph", UnitKind::Speed, "km/h"),
    ("rad", UnitKind::Angle, "rad"),
    ("deg", UnitKind::Angle, "deg"),
    ("rad_s", UnitKind::Rate, "rad/s"),
    ("radps", UnitKind::Rate, "rad/s"),
    ("deg_s", UnitKind::Rate, "deg/s"),
    ("degps", UnitKind::Rate, "deg/s"),
    ("deg_min", UnitKind::Rate, "deg/min"),
    ("degpmin", UnitKind::Rate, "deg/min"),
    ("rps", UnitKind::Revolutions, "rps"),
    ("rpm", UnitKind::Revolutions, "rpm"),
];

/// Forms of time other than a duration, with the factor to seconds. `auto` is detected from the
/// cells.
const CALENDAR: [(&str, f64); 8] = [
    ("auto", 1.0),
    ("timestamp", 1.0),
    ("day/month/year", 1.0),
    ("month/day/year", 1.0),
    ("hh:mm:ss", 1.0),
    ("excel", 86_400.0),
    ("matlab", 86_400.0),
    ("unix", 1.0),
];

/// Other common spellings of accepted units.
const SPELLINGS: [(&str, &str); 32] = [
    ("sec", "s"),
    ("secs", "s"),
    ("second", "s"),
    ("seconds", "s"),
    ("meter", "m"),
    ("meters", "m"),
    ("metre", "m"),
    ("metres", "m"),
    ("knots", "kn"),
    ("knot", "kn"),
    ("kt", "kn"),
    ("kts", "kn"),
    ("mps", "m/s"),
    ("m s-1", "m/s"),
    ("m_s", "m/s"),
    ("kmh", "km/h"),
    ("\u{b0}", "deg"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("radians", "rad"),
    ("\u{b0}/s", "deg/s"),
    ("deg/sec", "deg/s"),
    ("deg_s", "deg/s"),
    ("\u{b0}/min", "deg/min"),
    ("rad_s", "rad/s"),
    ("1/min", "rpm"),
    ("min-1", "rpm"),
    ("r/min", "rpm"),
    ("1/s", "rps"),
    ("hz", "rps"),
    ("percent", "%"),
    ("pct", "%"),
];

/// Returns the accepted name of a unit, without brackets and in the usual spelling.
pub(crate) fn plain_unit(written: &str) -> &str {
    let inner = written.trim().trim_matches(['[', ']', '(', ')']).trim();
    let same = |spelling: &str| spelling.eq_ignore_ascii_case(inner);
    if let Some((_, unit)) = SPELLINGS.iter().find(|(spelling, _)| same(spelling)) {
        return unit;
    }
    // Capitals are accepted: `KN` and `Deg` are clear, and `M` and `S` do not justify a refusal.
    SUFFIXES.iter().map(|&(_, _, unit)| unit).find(|unit| same(unit)).unwrap_or(inner)
}

/// Returns true if a cell can only be a unit.
pub(crate) fn is_unit(cell: &str) -> bool {
    let unit = plain_unit(cell);
    Unit::parse(unit).is_ok()
        || matches!(unit, "%" | "-")
        || CALENDAR.iter().any(|(known, _)| *known == unit)
}

impl UnitKind {
    /// Returns the kind of the columns of a target.
    pub(crate) fn from_target(target: ColumnTarget) -> Self {
        match target {
            ColumnTarget::Time => Self::Time,
            ColumnTarget::Channel(Channel::N | Channel::NS | Channel::NP) => Self::Revolutions,
            ColumnTarget::Channel(channel) => Self::from_dimension(channel.dimension()),
            ColumnTarget::Raw(raw) => Self::from_dimension(raw.dimension()),
            ColumnTarget::Unidentified(_) => Self::Length,
        }
    }

    fn from_dimension(dimension: Dimension) -> Self {
        match dimension {
            Dimension::LENGTH => Self::Length,
            Dimension::SPEED => Self::Speed,
            Dimension::RATE => Self::Rate,
            _ => Self::Angle,
        }
    }

    /// Returns the unit of a header's suffix.
    pub(crate) fn unit_of_suffix(self, suffix: &str) -> Option<&'static str> {
        SUFFIXES
            .iter()
            .find(|(known, kind, _)| *kind == self && *known == suffix)
            .map(|&(_, _, unit)| unit)
    }

    /// Returns the unit at the end of a header, such as `log_kn`, `log [kn]` or `log (kn)`.
    pub(crate) fn unit_in_header(self, header: &str) -> Option<&'static str> {
        let bracket = |open: char, close: char| {
            header.trim_end().strip_suffix(close)?.rsplit_once(open).map(|(_, unit)| unit.trim())
        };
        let written = bracket('[', ']').or_else(|| bracket('(', ')'));
        if let Some(written) = written {
            return self.accepted_units().into_iter().find(|unit| *unit == plain_unit(written));
        }
        // From the left, so that the longest suffix is found: `deg_s` before `s`.
        header.match_indices('_').find_map(|(at, _)| self.unit_of_suffix(&header[at + 1..]))
    }

    /// Returns the accepted units, the canonical one first.
    pub(crate) fn accepted_units(self) -> Vec<&'static str> {
        let mut units: Vec<&str> = SUFFIXES
            .iter()
            .filter(|(_, kind, _)| *kind == self)
            .map(|&(_, _, unit)| unit)
            .collect();
        // Spellings of one unit are neighbours in `SUFFIXES`.
        units.dedup();
        units
    }

    /// Returns the unit of the canonical column.
    pub(crate) fn canonical_unit(self) -> &'static str {
        self.accepted_units().first().copied().unwrap_or("1")
    }

    /// Returns the factor to canonical units.
    ///
    /// # Errors
    /// Returns a message with the accepted units if the unit is not one of them.
    pub(crate) fn unit_to_si(self, unit: &str) -> Result<f64, String> {
        let mut accepted = self.accepted_units();
        // Forms of time have a factor, but are no units.
        if self == Self::Time {
            if let Some(&(_, factor)) = CALENDAR.iter().find(|(known, _)| *known == unit.trim()) {
                return Ok(factor);
            }
            accepted.extend(CALENDAR.map(|(known, _)| known));
        }
        match Unit::parse(plain_unit(unit)) {
            Ok(known) if accepted.contains(&plain_unit(unit)) => Ok(known.to_si),
            _ => Err(format!("unit `{unit}` does not fit; use one of {}", accepted.join(", "))),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn every_suffix_names_a_known_unit() {
        for (_, kind, unit) in SUFFIXES {
            kind.unit_to_si(unit).unwrap();
        }
    }

    #[test]
    fn revolutions_are_not_a_yaw_rate() {
        assert!(
            UnitKind::from_target(ColumnTarget::Channel(Channel::R))
                .unit_to_si("rpm")
                .unwrap_err()
                .contains("rad/s")
        );
        assert!(
            UnitKind::from_target(ColumnTarget::Channel(Channel::N))
                .unit_to_si("rad/s")
                .unwrap_err()
                .contains("rps, rpm")
        );
        assert_eq!(UnitKind::from_target(ColumnTarget::Channel(Channel::Depth)), UnitKind::Length);
        assert_eq!(
            UnitKind::from_target(ColumnTarget::Channel(Channel::WindFrom)),
            UnitKind::Angle
        );
    }
}
