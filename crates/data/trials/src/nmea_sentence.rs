//! NMEA 0183 sentences: the values that are of use for a trial, in canonical units.

use std::f64::consts::PI;

use sistership_model::trial::Channel;

use crate::calendar::{DAY, SECOND, day_of_date};
use crate::table::{ColumnTarget, RawQuantity};

const KNOT: f64 = 1852.0 / 3600.0;
const DEG: f64 = PI / 180.0;

/// Sentence with a valid checksum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct NmeaSentence<'a> {
    pub talker: &'a str,
    pub kind: &'a str,
    fields: &'a str,
    /// Text before the sentence, such as the logger's own time.
    pub before: &'a str,
}

/// Content of a line of a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NmeaLine<'a> {
    Sentence(NmeaSentence<'a>),
    /// A sentence whose checksum is wrong or missing.
    Damaged,
    /// Any other line.
    Other,
}

/// Parses a line of a log.
pub(crate) fn parse_line(text: &str) -> NmeaLine<'_> {
    let Some((before, sentence)) = text.split_once('$') else { return NmeaLine::Other };
    let Some((body, sum)) = sentence.rsplit_once('*') else { return NmeaLine::Damaged };
    let wanted = sum.trim().get(..2).and_then(|sum| u8::from_str_radix(sum, 16).ok());
    // The checksum is the exclusive or of all bytes between `$` and `*`.
    if wanted != Some(body.bytes().fold(0, |sum, byte| sum ^ byte)) {
        return NmeaLine::Damaged;
    }
    // Addresses that begin with P are proprietary sentences without a talker.
    let (address, fields) = body.split_once(',').unwrap_or((body, ""));
    match (address.get(..2), address.get(2..)) {
        (Some(talker), Some(kind)) if kind.len() == 3 && !talker.starts_with('P') => {
            NmeaLine::Sentence(NmeaSentence { talker, kind, fields, before })
        }
        _ => NmeaLine::Other,
    }
}

impl NmeaSentence<'_> {
    /// Returns a field by its number, from 1; empty if it is missing.
    fn field(&self, number: usize) -> &str {
        self.fields.split(',').nth(number - 1).unwrap_or_default().trim()
    }

    fn parse_field(&self, number: usize) -> Option<f64> {
        self.field(number).parse().ok().filter(|value: &f64| value.is_finite())
    }

    fn field_is(&self, number: usize, wanted: &str) -> bool {
        self.field(number) == wanted
    }

    /// Returns the nanoseconds since midnight UTC, if the sentence contains the time.
    pub(crate) fn time_of_day(&self) -> Option<i64> {
        let text = match self.kind {
            "GGA" | "RMC" | "ZDA" => self.field(1),
            _ => return None,
        };
        let digits = text.get(..6).filter(|digits| digits.bytes().all(|b| b.is_ascii_digit()))?;
        let part = |from: usize| digits[from..from + 2].parse::<i64>().ok();
        // Digits after `hhmmss`, such as `.25`.
        let fraction: f64 = format!("0{}", &text[6..]).parse().ok()?;
        let (hours, minutes, seconds) = (part(0)?, part(2)?, part(4)?);
        let fits = hours < 24 && minutes < 60 && seconds < 61 && (0.0..1.0).contains(&fraction);
        let fraction = (fraction * 1e6).round() as i64 * 1000;
        fits.then_some(((hours * 60 + minutes) * 60 + seconds) * SECOND + fraction)
    }

    /// Returns midnight of the day in nanoseconds since 1970, if the sentence contains the date.
    pub(crate) fn date_midnight(&self) -> Option<i64> {
        let whole = |text: &str| text.parse::<i64>().ok();
        let day = match self.kind {
            "RMC" => {
                let date = self.field(9);
                let part = |from: usize| date.get(from..from + 2).and_then(whole);
                day_of_date(2000 + part(4)?, part(2)?, part(0)?)
            }
            "ZDA" => {
                day_of_date(whole(self.field(4))?, whole(self.field(3))?, whole(self.field(2))?)
            }
            _ => None,
        };
        day.map(|day| day * DAY)
    }

    /// Returns an angle written as degrees and minutes with its hemisphere, rad.
    fn parse_angle(&self, number: usize, negative: &str) -> Option<f64> {
        let value = self.parse_field(number).filter(|value| *value >= 0.0)?;
        // `4807.038` is 48 degrees and 7.038 minutes.
        let degrees = (value / 100.0).floor();
        let angle = (degrees + (value - 100.0 * degrees) / 60.0) * DEG;
        Some(if self.field_is(number + 1, negative) { -angle } else { angle })
    }

    /// Returns the readings that are of use for a trial; none if the sentence is marked invalid.
    pub(crate) fn usable_readings(&self) -> Vec<(ColumnTarget, f64)> {
        let channel =
            |channel, value: Option<f64>| value.map(|v| (ColumnTarget::Channel(channel), v));
        let raw = |raw, value: Option<f64>| value.map(|v| (ColumnTarget::Raw(raw), v));
        let number = |number, scale: f64| self.parse_field(number).map(|value| value * scale);
        let position = |at: usize, holds: bool| {
            let place = (self.parse_angle(at, "S"), self.parse_angle(at + 2, "W"));
            let (Some(latitude), Some(longitude), true) = (place.0, place.1, holds) else {
                return [None, None];
            };
            [
                raw(RawQuantity::Latitude, Some(latitude)),
                raw(RawQuantity::Longitude, Some(longitude)),
            ]
        };
        // Field numbers of each kind of sentence; status fields must be `A` (valid).
        let found: Vec<Option<(ColumnTarget, f64)>> = match self.kind {
            "GGA" => position(2, !matches!(self.field(6), "" | "0")).into(),
            "RMC" if self.field_is(2, "A") => {
                let ground = [
                    raw(RawQuantity::Speed, number(7, KNOT)),
                    raw(RawQuantity::Course, number(8, DEG)),
                ];
                position(3, true).into_iter().chain(ground).collect()
            }
            "VTG" => vec![
                raw(RawQuantity::Course, number(1, DEG)),
                raw(RawQuantity::Speed, number(5, KNOT)),
            ],
            "HDT" => vec![channel(Channel::Psi, number(1, DEG))],
            "ROT" if self.field_is(2, "A") => vec![channel(Channel::R, number(1, DEG / 60.0))],
            "RSA" => {
                let side =
                    |at, of| channel(of, number(at, DEG).filter(|_| self.field_is(at + 1, "A")));
                vec![side(1, Channel::DeltaS), side(3, Channel::DeltaP)]
            }
            "RPM" if self.field_is(1, "S") && self.field_is(5, "A") => {
                vec![self.shaft_revolutions()]
            }
            "MWV" if self.field_is(2, "R") && self.field_is(5, "A") => {
                let scale = match self.field(4) {
                    "N" => KNOT,
                    "K" => 1.0 / 3.6,
                    _ => 1.0,
                };
                vec![
                    channel(Channel::ApparentWindFrom, number(1, DEG)),
                    channel(Channel::ApparentWindSpeed, number(3, scale)),
                ]
            }
            "VBW" => {
                let speed = |at, status| number(at, KNOT).filter(|_| self.field_is(status, "A"));
                vec![
                    channel(Channel::UWater, speed(1, 3)),
                    channel(Channel::VWater, speed(2, 3)),
                    channel(Channel::U, speed(4, 6)),
                    channel(Channel::V, speed(5, 6)),
                ]
            }
            "VHW" => {
                let metric = || number(7, 1.0 / 3.6);
                vec![channel(Channel::UWater, number(5, KNOT).or_else(metric))]
            }
            _ => Vec::new(),
        };
        found.into_iter().flatten().collect()
    }

    /// Returns the revolutions of a shaft. Shafts are numbered from 0, the only or the centre one;
    /// odd ones are to starboard.
    fn shaft_revolutions(&self) -> Option<(ColumnTarget, f64)> {
        let revolutions = self.parse_field(3)? / 60.0;
        match self.parse_field(2)? as i64 {
            0 => Some((ColumnTarget::Channel(Channel::N), revolutions)),
            1 => Some((ColumnTarget::Channel(Channel::NS), revolutions)),
            2 => Some((ColumnTarget::Channel(Channel::NP), revolutions)),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(crate) fn summed(body: &str) -> String {
        format!("${body}*{:02X}", body.bytes().fold(0, |sum, byte| sum ^ byte))
    }

    fn readings(body: &str) -> Vec<(&'static str, f64)> {
        match parse_line(&summed(body)) {
            NmeaLine::Sentence(sentence) => sentence
                .usable_readings()
                .into_iter()
                .map(|(target, value)| (target.name(), (value * 1e6).round() / 1e6))
                .collect(),
            _ => Vec::new(),
        }
    }

    #[test]
    fn sentences_give_canonical_values() {
        let place = "GPGGA,120003.25,5130.00,N,00930.00,W,1,08,0.9,1.0,M,0.0,M,,";
        assert_eq!(readings(place), [("latitude", 0.898845), ("longitude", -0.165806)]);
        assert!(readings(&place.replace("W,1", "W,0")).is_empty());
        assert_eq!(readings("HEHDT,80.0,T"), [("psi", 1.396263)]);
        assert_eq!(readings("TIROT,-60.0,A"), [("r", -0.017453)]);
        assert_eq!(
            readings("AGRSA,10.0,A,-10.0,A"),
            [("delta_s", 0.174533), ("delta_p", -0.174533)]
        );
        assert_eq!(readings("AGRSA,10.0,A,,V"), [("delta_s", 0.174533)]);
        assert_eq!(readings("RCRPM,S,0,120.0,,A"), [("n", 2.0)]);
        assert!(readings("RCRPM,E,0,120.0,,A").is_empty());
        let vbw = "VDVBW,10.0,1.0,A,9.0,0.5,A";
        let both = readings(vbw);
        assert_eq!(both[..2], [("u_water", 5.144444), ("v_water", 0.514444)]);
        assert_eq!(both[2..], [("u", 4.63), ("v", 0.257222)]);
        assert_eq!(readings(&vbw.replace("0.5,A", "0.5,V")).len(), 2);
        assert_eq!(readings("VWVHW,80.0,T,82.0,M,10.0,N,18.5,K"), [("u_water", 5.144444)]);
        assert_eq!(
            readings("WIMWV,40.0,R,10.0,N,A"),
            [("apparent_wind_from", 0.698132), ("apparent_wind_speed", 5.144444)]
        );
        assert!(readings("WIMWV,45.0,T,10.0,N,A").is_empty());
        assert_eq!(readings("GPVTG,90.0,T,,M,10.0,N,18.5,K")[1], ("speed", 5.144444));
    }

    #[test]
    fn checksums_decide() {
        assert_eq!(parse_line("$HEHDT,90.0,T*00"), NmeaLine::Damaged);
        assert_eq!(parse_line("$HEHDT,90.0,T"), NmeaLine::Damaged);
        assert_eq!(parse_line("# a remark"), NmeaLine::Other);
        assert_eq!(parse_line(&summed("PSIMSNS,1")), NmeaLine::Other);
        for text in ["$*", "$,*2C", "$\u{e9}\u{e9}\u{e9},*00", "$GPGGA*56", "$*00"] {
            if let NmeaLine::Sentence(sentence) = parse_line(text) {
                let _ = (sentence.usable_readings(), sentence.time_of_day());
            }
        }
    }

    #[test]
    fn time_and_date_are_read() {
        let rmc = summed("GPRMC,120003.250,A,5130.00,N,00930.00,W,10.0,90.0,010524,,,A");
        let NmeaLine::Sentence(sentence) = parse_line(&rmc) else { unreachable!("it is summed") };
        assert_eq!(sentence.time_of_day(), Some(12 * 3600 * SECOND + 3_250_000_000));
        assert_eq!(sentence.date_midnight(), Some(19_844 * DAY));
        assert_eq!(sentence.usable_readings().len(), 4);
    }
}
