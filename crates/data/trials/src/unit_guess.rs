//! The unit of a column: as it is written, or as its first values suggest.

use crate::clock::looks_serial;
use crate::decimals::Decimals;
use crate::number::number;
use crate::stamp::{Date, Order, stamp};
use crate::table::{Raw, Target};
use crate::units::{Kind, plain_unit};

/// A unit and what it rests on.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct UnitGuess {
    pub unit: String,
    pub why: String,
    pub certain: bool,
}

/// The unit of a column of the target.
pub(crate) fn unit(target: Target, header: &str, below: Option<&str>, cells: &[&str]) -> UnitGuess {
    let kind = Kind::of(target);
    let guess = |unit: &str, why: String, certain| UnitGuess { unit: unit.into(), why, certain };
    if target == Target::Time
        && let Some((unit, why, certain)) = written_time(cells).or_else(|| serial(header, cells))
    {
        return guess(unit, why.into(), certain);
    }
    let percent = |text: &str| text.contains('%') && target != Target::Time;
    if percent(header) || below.is_some_and(percent) {
        let why = format!("a percentage: declare what 100 % is as `maximum` of {}", target.name());
        return guess("%", why, false);
    }
    if let Some(unit) = kind.named_in(header) {
        return guess(unit, format!("`{unit}` is written in it"), true);
    }
    let canonical = crate::names::canonical(header).map(|(_, unit)| unit);
    let below = below.map(plain_unit).filter(|unit| kind.factor(unit).is_ok());
    match canonical.or(below) {
        Some(unit) => guess(unit, format!("`{unit}` is written below or in it"), true),
        None => {
            let (unit, why) = by_size(target, kind, largest(cells));
            guess(unit, format!("no unit is written, {why}: look at it"), false)
        }
    }
}

fn written_time(cells: &[&str]) -> Option<(&'static str, &'static str, bool)> {
    let first = cells.iter().find(|cell| !cell.is_empty())?;
    Some(match stamp(first, Order::Open)?.date {
        Date::Known(_) => ("timestamp", "its cells are dates with times of day", true),
        Date::Absent => ("hh:mm:ss", "its cells are times of day", true),
        Date::Either(_) => {
            let why = "its cells are dates of which either number may be the month: \
            `day/month/year` or \
                       `month/day/year` says which";
            ("auto", why, false)
        }
    })
}

fn serial(header: &str, cells: &[&str]) -> Option<(&'static str, &'static str, bool)> {
    let values = numbers(cells);
    let is_serial = !values.is_empty() && looks_serial(header, &values);
    is_serial.then_some(("excel", "its numbers are the days of a sheet", true))
}

fn largest(cells: &[&str]) -> f64 {
    numbers(cells).into_iter().map(f64::abs).fold(0.0, f64::max)
}

fn numbers(cells: &[&str]) -> Vec<f64> {
    let mut decimals = Decimals::new(b';');
    cells.iter().filter_map(|cell| number(&decimals.point(0, cell.as_bytes())).ok()).collect()
}

fn by_size(target: Target, kind: Kind, largest: f64) -> (&'static str, &'static str) {
    match kind {
        Kind::Time => ("s", "seconds are the rule"),
        Kind::Length => ("m", "metres are the rule"),
        Kind::Angle if matches!(target, Target::Raw(Raw::Latitude | Raw::Longitude)) => {
            ("deg", "places are given in degrees")
        }
        Kind::Angle if largest > 6.3 => ("deg", "and values beyond two pi are degrees"),
        Kind::Angle => ("rad", "and the first values are small"),
        Kind::Rate if largest > 20.0 => ("deg/min", "and no ship makes as many degrees per second"),
        Kind::Rate if largest > 0.3 => ("deg/s", "and few ships make as many radians per second"),
        Kind::Rate => ("rad/s", "and the first values are small"),
        Kind::Revolutions if largest > 30.0 => ("rpm", "and no propeller makes as many per second"),
        Kind::Revolutions => ("rps", "and the first values are small"),
        Kind::Speed if matches!(target, Target::Raw(_)) => ("kn", "and receivers give knots"),
        Kind::Speed => ("m/s", "metres per second are the rule"),
    }
}
