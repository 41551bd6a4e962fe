//! Conversion of the text of a cell to a number, or to the fault of the text.

use std::fmt;

use crate::text_decoder::decode_text;

/// Largest number of bytes of a cell in a message.
const SHOWN: usize = 40;

/// Reason why a cell contains no number.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum CellFault {
    Absent,
    Short,
    Empty,
    NotANumber,
    Text(String),
    /// Text that is no time, in a column of dates or times of day.
    NoTime(String),
    OtherTime(String),
    /// A number with the unit of another quantity.
    OtherUnit(String),
}

impl fmt::Display for CellFault {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Absent => out.write_str("the row ends before this column"),
            Self::Short => out.write_str("the row has fewer cells than the header"),
            Self::Empty => out.write_str("the cell is empty"),
            Self::NotANumber => out.write_str("the cell is not a finite number"),
            Self::NoTime(text) => write!(out, "`{text}` is not a date or time"),
            Self::OtherTime(text) => {
                write!(out, "`{text}` has another form than the times before it")
            }
            Self::OtherUnit(text) => {
                write!(out, "the unit of `{text}` does not fit the quantity of its column")
            }
            Self::Text(text) => write!(out, "`{text}` is not a number{}", number_remedy(text)),
        }
    }
}

/// Parses the number in a cell: decimals with a point, optionally an exponent, such as `-1.5` or
/// `1e-3`.
pub(crate) fn parse_number(cell: &[u8]) -> Result<f64, CellFault> {
    let text = cell.trim_ascii();
    if text.is_empty() {
        return Err(CellFault::Empty);
    }
    // Fast path; the general parser accepts the same numbers.
    if let Some(value) = parse_plain(text) {
        return Ok(value);
    }
    let parsed = std::str::from_utf8(text).ok().and_then(|text| text.parse::<f64>().ok());
    match parsed {
        Some(value) if value.is_finite() => Ok(value),
        Some(_) => Err(CellFault::NotANumber),
        None => parse_degrees(text).ok_or_else(|| CellFault::Text(shown_text(text))),
    }
}

/// Parses an angle in degrees, minutes and seconds, such as `34°41.5'N`, `135 11 24.0 E` or
/// `33-54.0S`, to degrees; south and west are negative, a comma is a decimal mark. `None` without a
/// sign of degrees, or several numbers and a point of the compass.
pub(crate) fn parse_degrees(cell: &[u8]) -> Option<f64> {
    // In Latin-1 0xb0 is the sign of degrees.
    let text = decode_text(cell);
    let compass = |letter: char| matches!(letter, 'N' | 'S' | 'E' | 'W');
    let letters: Vec<char> =
        text.chars().filter(|letter| letter.is_alphabetic() && *letter != 'º').collect();
    let point = match letters[..] {
        [] => None,
        [letter] if compass(letter) => Some(letter),
        _ => return None,
    };
    // Between the digits of `33-54.0S` a dash is no sign.
    let text = match (point, text.split_at_checked(1)) {
        (Some(_), Some((first, rest))) => format!("{first}{}", rest.replace('-', " ")),
        _ => text.into_owned(),
    };
    let is_sign = |letter: char| matches!(letter, '°' | 'º' | '˚');
    let signed = text.contains(is_sign);
    let marks = |letter: char| {
        is_sign(letter) || compass(letter) || letter.is_whitespace() || "'\"′″’”".contains(letter)
    };
    let parts = text.split(marks).filter(|part| !part.is_empty());
    let number = |part: &str| part.replacen(',', ".", 1).parse().ok();
    let parts: Vec<f64> = parts.map(number).collect::<Option<_>>()?;
    let (&degrees, smaller) = parts.split_first()?;
    let is_whole = smaller.len() <= 2 && smaller.iter().all(|part| (0.0..60.0).contains(part));
    if !is_whole || !(signed || (point.is_some() && !smaller.is_empty())) || !degrees.is_finite() {
        return None;
    }
    // Minutes and seconds count away from zero, also those of -0 degrees.
    let size = smaller.iter().rev().fold(0.0, |rest, part| (rest + part) / 60.0) + degrees.abs();
    let is_negative = degrees.is_sign_negative() != matches!(point, Some('S' | 'W'));
    Some(if is_negative { -size } else { size })
}

/// Words for the starboard side in logs of several languages, and for the port side.
const SIDES: [(&[&str], f64); 2] = [
    (&["S", "SB", "STB", "STBD", "STARBOARD", "R", "RIGHT"], 1.0),
    (&["P", "PS", "PT", "PORT", "BB", "L", "LEFT"], -1.0),
];

/// Parses a number with its side, such as `StB 12,5` or `5.0° P`: positive to starboard. A single
/// comma is a decimal mark. `None` without exactly one side and one number without a sign.
pub(crate) fn parse_sided(cell: &[u8]) -> Option<f64> {
    let is_number = |letter: char| letter.is_ascii_digit() || matches!(letter, '.' | ',');
    let text = decode_text(cell);
    let text = text.trim();
    let (first, last) = (text.find(is_number)?, text.rfind(is_number)?);
    let (before, after) = (&text[..first], &text[last + 1..]);
    let word = |part: &str| part.trim_matches(|at: char| !at.is_ascii_alphabetic()).to_uppercase();
    let has_other = |part: &str| part.contains(['+', '-', '/', ':']);
    let (before, after) = match has_other(before) || has_other(after) {
        true => return None,
        false => (word(before), word(after)),
    };
    let side = if before.is_empty() { &after } else { &before };
    let is_twofold = !before.is_empty() && !after.is_empty();
    let (_, sign) =
        SIDES.iter().find(|(words, _)| words.contains(&side.as_str()) && !is_twofold)?;
    let value: f64 = text[first..=last].replacen(',', ".", 1).parse().ok()?;
    Some(sign * value)
}

/// Number of decimal digits that an f64 holds exactly.
const EXACT: usize = 15;
const TENS: [f64; EXACT + 1] =
    [1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];

/// Parses a short number without exponent: its digits and the power of ten are exact, so that their
/// quotient is rounded once and equals the result of the standard library (Clinger 1990, doi
/// 10.1145/93542.93557). Most cells of a log are such numbers.
#[inline]
fn parse_plain(text: &[u8]) -> Option<f64> {
    let digits = text.strip_prefix(b"-").unwrap_or(text);
    // A decimal point takes one byte more.
    if digits.len() > EXACT + 1 {
        return None;
    }
    let (mut whole, mut count, mut point) = (0_u64, 0, None);
    for (at, &byte) in digits.iter().enumerate() {
        match byte {
            b'0'..=b'9' => {
                whole = 10 * whole + u64::from(byte - b'0');
                count += 1;
            }
            b'.' if point.is_none() => point = Some(digits.len() - 1 - at),
            _ => return None,
        }
    }
    if count == 0 || count > EXACT {
        return None;
    }
    let value = whole as f64 / TENS[point.unwrap_or(0)];
    Some(if digits.len() < text.len() { -value } else { value })
}

/// Returns the text of a cell for a message, shortened if it is long.
pub(crate) fn shown_text(cell: &[u8]) -> String {
    let text = cell.trim_ascii();
    String::from_utf8_lossy(&text[..text.len().min(SHOWN)]).into_owned()
}

/// Returns advice if the text shows what was meant.
fn number_remedy(text: &str) -> &'static str {
    let thousands =
        |c: char| matches!(c, ' ' | '\u{a0}' | '\u{2009}' | '\u{202f}' | '\'' | '\u{2019}' | '_');
    let digits = text.chars().any(|c| c.is_ascii_digit());
    if text.contains('\0') {
        "; it contains a NUL byte: the file is damaged, or is not UTF-8 text"
    } else if digits && text.contains(',') && (text.contains('.') || text.matches(',').count() > 1)
    {
        "; remove the thousands separator and write decimals with a point"
    } else if digits && text.contains(',') {
        "; write decimals with a point"
    } else if digits && text.contains(':') {
        "; write time as seconds, such as 12.5, or declare its unit `hh:mm:ss` or `timestamp`"
    } else if digits && text.contains(['\u{2212}', '\u{2013}', '\u{2014}']) {
        "; write the minus sign as `-`"
    } else if digits && text.contains(thousands) {
        "; write the number without separators in it"
    } else if text.starts_with("0x") || text.starts_with("-0x") {
        "; write it as a decimal number"
    } else {
        ""
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn numbers_are_read_as_they_are_written() {
        for (text, value) in [
            ("1", 1.0),
            (" -1.5 ", -1.5),
            ("+2", 2.0),
            ("1e-3", 1e-3),
            (".5", 0.5),
            ("5.", 5.0),
            ("1E5", 1e5),
        ] {
            assert_eq!(parse_number(text.as_bytes()).unwrap(), value);
        }
        for text in ["nan", "NaN", "inf", "-Infinity", "1e400"] {
            assert_eq!(parse_number(text.as_bytes()), Err(CellFault::NotANumber), "{text}");
        }
    }

    #[test]
    fn short_numbers_are_those_of_the_standard_library() {
        let mut word = 1_u64;
        for _ in 0..200_000 {
            word = word.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let digits = (word >> 20) % 10_u64.pow(1 + (word % 15) as u32);
            let text = format!("{digits}");
            let at = (word >> 7) as usize % (text.len() + 1);
            let text = format!("{}{}.{}", ["", "-"][at % 2], &text[..at], &text[at..]);
            let wanted: Option<f64> = text.parse().ok();
            assert_eq!(
                parse_plain(text.as_bytes()).map(f64::to_bits),
                wanted.map(f64::to_bits),
                "{text}"
            );
        }
        assert_eq!(parse_plain(b"-0.0").map(f64::to_bits), Some((-0.0_f64).to_bits()));
        for text in [&b"."[..], b"-", b"", b"1.2.3", b"1e3", b"+1", b"1234567890123456", b"1_0"] {
            assert_eq!(parse_plain(text), None);
        }
    }

    #[test]
    fn degrees_and_minutes_are_read_as_degrees() {
        for (text, degrees) in [
            ("34°41.5'N", 34.0 + 41.5 / 60.0),
            ("34° 41' 30.0\" S", -(34.0 + 41.5 / 60.0)),
            ("135 11 24.0 E", 135.19),
            ("W005°30.0", -5.5),
            ("33-54.0S", -33.9),
            ("43°06,3000'N", 43.105),
            ("W 5°30'18,0\"", -5.505),
            ("018-18.0 E", 18.3),
            ("-0°30'", -0.5),
            ("312.5°", 312.5),
        ] {
            let read = parse_number(text.as_bytes()).unwrap();
            assert!((read - degrees).abs() < 1e-12, "{text}: {read}");
        }
        assert!((parse_number(b"312.5\xb0").unwrap() - 312.5).abs() < 1e-12, "Latin-1");
        for text in ["10.5S", "12 N 5 E", "34°75'N", "1,234.5°", "5 kn", "N/A", "°"] {
            assert!(parse_number(text.as_bytes()).is_err(), "{text}");
        }
    }

    #[test]
    fn what_is_no_number_is_told_with_what_to_write() {
        let told = [
            ("1,5", "with a point"),
            ("1,234.5", "thousands"),
            ("1,234,567", "thousands"),
            ("1 000", "without separators"),
            ("1\u{a0}000", "without separators"),
            ("1'000", "without separators"),
            ("1_000", "without separators"),
            ("\u{2212}3", "minus sign"),
            ("12:00:01", "seconds"),
            ("0x1p3", "as a decimal number"),
            ("1\0", "NUL"),
        ];
        for (text, wanted) in told {
            let fault = parse_number(text.as_bytes()).unwrap_err().to_string();
            assert!(
                fault.contains("is not a number") && fault.contains(wanted),
                "{text:?}: {fault}"
            );
        }
        for text in ["1d", "1.0f", "#N/A", "NULL", "--1", "1e", "1/2", "%"] {
            assert!(parse_number(text.as_bytes()).is_err(), "{text}");
        }
    }

    #[test]
    fn sides_of_a_rudder_are_signs() {
        let read = |text: &str| parse_sided(text.as_bytes());
        for (text, value) in [
            ("StB 12,5", 12.5),
            ("BB 3", -3.0),
            ("5.0 P", -5.0),
            ("S07.5", 7.5),
            ("10° stbd", 10.0),
        ] {
            assert_eq!(read(text), Some(value), "{text}");
        }
        assert_eq!(parse_sided(b"4,0\xb0 BB"), Some(-4.0), "Latin-1");
        for text in
            ["12", "N 12", "P -5", "P 5 S", "P 1,2,3", "P 1.2,3", "amidships", "", "5/P", "STB"]
        {
            assert_eq!(read(text), None, "{text}");
        }
    }
}
