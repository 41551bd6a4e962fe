//! Units in which a channel may be given, and the suffixes that name them in a header.

use sistership_formula::units::{Dimension, Unit};
use sistership_model::trial::Channel;

use crate::table::{Raw, Target};

/// Physical kind of a column. Dimensions alone cannot distinguish a yaw rate from propeller
/// revolutions: both are 1/s, but one counts radians and the other turns, and 80 rpm read as a yaw
/// rate would be wrong by a factor of two pi.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Time,
    Length,
    Speed,
    Angle,
    Rate,
    Revolutions,
}

/// Header suffix, kind, unit. The suffix `ms` is a millisecond for time and a metre per second for
/// a speed.
const SUFFIXES: &[(&str, Kind, &str)] = &[
    ("s", Kind::Time, "s"),
    ("sec", Kind::Time, "s"),
    ("ms", Kind::Time, "ms"),
    ("us", Kind::Time, "us"),
    ("ns", Kind::Time, "ns"),
    ("min", Kind::Time, "min"),
    ("h", Kind::Time, "h"),
    ("m", Kind::Length, "m"),
    ("km", Kind::Length, "km"),
    ("nmi", Kind::Length, "nmi"),
    ("m_s", Kind::Speed, "m/s"),
    ("mps", Kind::Speed, "m/s"),
    ("ms", Kind::Speed, "m/s"),
    ("kn", Kind::Speed, "kn"),
    ("kt", Kind::Speed, "kn"),
    ("kts", Kind::Speed, "kn"),
    ("km_h", Kind::Speed, "km/h"),
    ("kmh", Kind::Speed, "km/h"),
    ("kmph", Kind::Speed, "km/h"),
    ("rad", Kind::Angle, "rad"),
    ("deg", Kind::Angle, "deg"),
    ("rad_s", Kind::Rate, "rad/s"),
    ("radps", Kind::Rate, "rad/s"),
    ("deg_s", Kind::Rate, "deg/s"),
    ("degps", Kind::Rate, "deg/s"),
    ("deg_min", Kind::Rate, "deg/min"),
    ("degpmin", Kind::Rate, "deg/min"),
    ("rps", Kind::Revolutions, "rps"),
    ("rpm", Kind::Revolutions, "rpm"),
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

impl Kind {
    /// Returns the kind of the columns of a target.
    pub(crate) fn of(target: Target) -> Self {
        match target {
            Target::Time => Self::Time,
            Target::Channel(Channel::N) | Target::Raw(Raw::NS | Raw::NP) => Self::Revolutions,
            Target::Channel(channel) => Self::measuring(channel.dimension()),
            Target::Raw(raw) => Self::measuring(raw.dimension()),
            Target::Unidentified(_) => Self::Length,
        }
    }

    fn measuring(dimension: Dimension) -> Self {
        match dimension {
            Dimension::LENGTH => Self::Length,
            Dimension::SPEED => Self::Speed,
            Dimension::RATE => Self::Rate,
            _ => Self::Angle,
        }
    }

    /// Returns the unit of a header's suffix.
    pub(crate) fn suffix(self, suffix: &str) -> Option<&'static str> {
        SUFFIXES
            .iter()
            .find(|(known, kind, _)| *kind == self && *known == suffix)
            .map(|&(_, _, unit)| unit)
    }

    /// Returns the unit at the end of a header, such as `log_kn`, `log [kn]` or `log (kn)`.
    pub(crate) fn named_in(self, header: &str) -> Option<&'static str> {
        let bracket = |open: char, close: char| {
            header.trim_end().strip_suffix(close)?.rsplit_once(open).map(|(_, unit)| unit.trim())
        };
        let written = bracket('[', ']').or_else(|| bracket('(', ')'));
        if let Some(written) = written {
            return self.accepted().into_iter().find(|unit| *unit == plain_unit(written));
        }
        // From the left, so that the longest suffix is found: `deg_s` before `s`.
        header.match_indices('_').find_map(|(at, _)| self.suffix(&header[at + 1..]))
    }

    /// Returns the accepted units, the canonical one first.
    pub(crate) fn accepted(self) -> Vec<&'static str> {
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
    pub(crate) fn canonical(self) -> &'static str {
        self.accepted().first().copied().unwrap_or("1")
    }

    /// Returns the factor to canonical units.
    ///
    /// # Errors
    /// Returns a message with the accepted units if the unit is not one of them.
    pub(crate) fn factor(self, unit: &str) -> Result<f64, String> {
        let mut accepted = self.accepted();
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
            kind.factor(unit).unwrap();
        }
    }

    #[test]
    fn revolutions_are_not_a_yaw_rate() {
        assert!(Kind::of(Target::Channel(Channel::R)).factor("rpm").unwrap_err().contains("rad/s"));
        assert!(
            Kind::of(Target::Channel(Channel::N)).factor("rad/s").unwrap_err().contains("rps, rpm")
        );
        assert_eq!(Kind::of(Target::Channel(Channel::Depth)), Kind::Length);
        assert_eq!(Kind::of(Target::Channel(Channel::WindFrom)), Kind::Angle);
    }
}
