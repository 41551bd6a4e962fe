//! Value of a cell of text in the unit of its column: a plain number, or one with a unit, a side or
//! a point of the compass of its own.

use crate::number::{CellFault, parse_degrees, parse_number, parse_sided, shown_text};
use crate::table::{ColumnTarget, RawQuantity, TableColumn};
use crate::text_decoder::decode_text;
use crate::units::{UnitKind, is_unit, plain_unit};

/// Digits before the decimal mark from which a latitude has degrees and minutes in one number, as
/// in NMEA 0183 (`llll.ll`, `yyyyy.yy`).
const JOINED_DIGITS: usize = 4;

/// Returns the value of a cell in the unit of its column; `next` is the cell to the right, which
/// may hold the hemisphere of a position.
pub(crate) fn read_value(
    cell: &[u8],
    next: Option<&[u8]>,
    column: &TableColumn,
) -> Result<f64, CellFault> {
    // A gap of the recording stays one, whatever is beside it.
    if let Some(letter) = next.and_then(point_of_compass)
        && whole_digits(cell) > 0
        && belongs_together(cell, column.target)
    {
        return read_position(&[cell.trim_ascii(), &[b' ', letter]].concat());
    }
    parse_number(cell).or_else(|fault| match column.target {
        target if is_position(cell, target) => read_position(cell),
        ColumnTarget::Raw(_) => read_with_unit(cell, column).unwrap_or(Err(fault)),
        // `S` is starboard before it is a second.
        _ => match parse_sided(cell) {
            Some(value) => Ok(value),
            None => read_with_unit(cell, column).unwrap_or(Err(fault)),
        },
    })
}

/// Returns true if a point of the compass beside a cell is its hemisphere: in a column of
/// positions, or where the number itself can be nothing else.
fn belongs_together(cell: &[u8], target: ColumnTarget) -> bool {
    match target {
        ColumnTarget::Raw(raw) => matches!(raw, RawQuantity::Latitude | RawQuantity::Longitude),
        ColumnTarget::Unidentified(_) => whole_digits(cell) >= JOINED_DIGITS,
        _ => false,
    }
}

/// Returns true if a cell that is no number may be a position with its point of the compass. In a
/// column that is yet to be identified `2.5 S` may be to starboard as well.
fn is_position(cell: &[u8], target: ColumnTarget) -> bool {
    let Some((&last, number)) = cell.trim_ascii().split_last() else { return false };
    // `11.7 kn` ends with a letter that is none of the compass.
    let is_alone = !number.iter().any(u8::is_ascii_alphabetic);
    let last = point_of_compass(&[last]).filter(|_| is_alone);
    belongs_together(cell, target) && last.is_some()
        || matches!(target, ColumnTarget::Unidentified(_)) && last.is_some_and(|at| at != b'S')
}

fn point_of_compass(cell: &[u8]) -> Option<u8> {
    match cell.trim_ascii() {
        [letter] => Some(letter.to_ascii_uppercase()).filter(|letter| b"NSEW".contains(letter)),
        _ => None,
    }
}

fn whole_digits(cell: &[u8]) -> usize {
    cell.trim_ascii().iter().take_while(|byte| byte.is_ascii_digit()).count()
}

/// Reads degrees with a point of the compass: `54.32 N`, `5419.20 N`, `54 19.2 N`.
fn read_position(cell: &[u8]) -> Result<f64, CellFault> {
    let refuse = || CellFault::Text(shown_text(cell));
    let Some((&last, number)) = cell.trim_ascii().split_last() else { return Err(refuse()) };
    let (Some(letter), Ok(value)) = (point_of_compass(&[last]), parse_number(number)) else {
        return parse_degrees(cell).ok_or_else(refuse);
    };
    let is_east_or_west = matches!(letter, b'E' | b'W');
    let (digits, most) = match is_east_or_west {
        true => (JOINED_DIGITS + 1, 180.0),
        false => (JOINED_DIGITS, 90.0),
    };
    // Leading zeros tell degrees with minutes from degrees alone, near the equator and Greenwich too.
    let is_joined = whole_digits(number) >= digits || value > most;
    let (degrees, minutes) = ((value / 100.0).trunc(), value % 100.0);
    let size = match is_joined {
        true if minutes < 60.0 => degrees + minutes / 60.0,
        true => return Err(refuse()),
        false => value,
    };
    let is_valid = value >= 0.0 && size <= most;
    let sign = if matches!(letter, b'S' | b'W') { -1.0 } else { 1.0 };
    if is_valid { Ok(sign * size) } else { Err(refuse()) }
}

/// Reads a number with a unit of its own in the unit of its column; `None` without a unit.
fn read_with_unit(cell: &[u8], column: &TableColumn) -> Option<Result<f64, CellFault>> {
    let (value, unit) = split_unit(cell)?;
    if matches!(column.target, ColumnTarget::Unidentified(_)) || plain_unit(&column.unit) == unit {
        return Some(Ok(value));
    }
    // The cell knows better than the column what it holds.
    let factor = UnitKind::from_target(column.target).unit_to_si(&unit);
    Some(match factor {
        Ok(factor) => Ok(value * factor / column.to_si),
        Err(_) => Err(CellFault::OtherUnit(shown_text(cell))),
    })
}

/// Splits a number from the unit after it, as in `11.7 kn` and `4,1°/min`; `None` without both.
pub(crate) fn split_unit(cell: &[u8]) -> Option<(f64, String)> {
    let text = decode_text(cell);
    let text = text.trim();
    let is_number = |at: char| at.is_ascii_digit() || matches!(at, '+' | '-' | '.' | ',');
    let (number, unit) = text.split_at(text.find(|at| !is_number(at))?);
    let value = parse_number(number.replacen(',', ".", 1).as_bytes()).ok()?;
    let unit = unit.trim();
    is_unit(unit).then(|| (value, plain_unit(unit).to_owned()))
}

/// Returns the unit that every cell with text has; `None` if there is none.
pub(crate) fn common_unit<'a>(cells: impl Iterator<Item = &'a str>) -> Option<String> {
    // Empty cells are gaps of the recording, which have no unit.
    let mut units = cells
        .filter(|cell| !cell.trim().is_empty())
        .map(|cell| split_unit(cell.as_bytes()).map(|(_, unit)| unit));
    let first = units.next()??;
    units.all(|unit| unit.as_ref() == Some(&first)).then_some(first)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::trial::Channel;

    fn column(target: ColumnTarget, unit: &str) -> TableColumn {
        let to_si = UnitKind::from_target(target).unit_to_si(unit).unwrap_or(1.0);
        let (index, header, unit) = (0, String::new(), unit.to_owned());
        TableColumn { index, header, target, unit, to_si, at_rest: 0.0 }
    }

    fn close(read: Result<f64, CellFault>, wanted: f64) {
        let read = read.unwrap();
        assert!((read - wanted).abs() < 1e-9, "{read} {wanted}");
    }

    #[test]
    fn a_hemisphere_beside_or_behind_a_position_is_its_sign() {
        let latitude = column(ColumnTarget::Raw(RawQuantity::Latitude), "deg");
        let longitude = column(ColumnTarget::Raw(RawQuantity::Longitude), "deg");
        for (text, letter, degrees) in [
            ("5419.2", "N", 54.32),
            ("0030.6", "S", -0.51),
            ("54.32", "s", -54.32),
            ("54 19.2", "N", 54.32),
        ] {
            close(read_value(text.as_bytes(), Some(letter.as_bytes()), &latitude), degrees);
            let joined = format!("{text} {}", letter.to_uppercase());
            close(read_value(joined.as_bytes(), None, &latitude), degrees);
        }
        for (text, degrees) in
            [("00130.6 W", -1.51), ("1009.6E", 10.16), ("130.6 E", 130.6), ("18000 W", -180.0)]
        {
            close(read_value(text.as_bytes(), None, &longitude), degrees);
        }
        for text in ["5475.0 N", "95.0 X", "9100.0 N", "-54.3 N", "N", ""] {
            assert!(read_value(text.as_bytes(), None, &latitude).is_err(), "{text}");
        }
        close(read_value(b"54.32", Some(b"12"), &latitude), 54.32);
        assert_eq!(read_value(b" ", Some(b"N"), &latitude), Err(CellFault::Empty));
    }

    #[test]
    fn a_letter_beside_another_number_is_not_its_sign() {
        let unknown = column(ColumnTarget::Unidentified(0), "1");
        close(read_value(b"12.5", Some(b"S"), &unknown), 12.5);
        close(read_value(b"5419.2", Some(b"S"), &unknown), -54.32);
        close(read_value(b"5419.2 S", None, &unknown), -54.32);
        close(read_value(b"54.32 W", None, &unknown), -54.32);
        close(read_value(b"2.5 S", None, &unknown), 2.5);
        let speed = column(ColumnTarget::Raw(RawQuantity::Speed), "kn");
        close(read_value(b"5419.2", Some(b"S"), &speed), 5419.2);
    }

    #[test]
    fn a_cell_with_a_unit_is_read_in_that_of_its_column() {
        let u = column(ColumnTarget::Channel(Channel::U), "m/s");
        close(read_value(b"18 km/h", None, &u), 5.0);
        close(read_value(b"3,6 km/h", None, &u), 1.0);
        let r = column(ColumnTarget::Channel(Channel::R), "deg/min");
        close(read_value("-4.1 °/min".as_bytes(), None, &r), -4.1);
        close(read_value(b"1 \xb0/s", None, &r), 60.0);
        let delta = column(ColumnTarget::Channel(Channel::Delta), "deg");
        close(read_value(b"2.5 S", None, &delta), 2.5);
        close(read_value(b"2.5 P", None, &delta), -2.5);
        let fault = read_value(b"2.5 kn", None, &r).unwrap_err();
        assert!(fault.to_string().contains("does not fit"), "{fault}");
        assert!(read_value(b"2.5 apples", None, &u).is_err());
        let unknown = column(ColumnTarget::Unidentified(3), "1");
        for cell in ["92 rpm", "92 kn", "92 °/min", "92,0 m", "92 °"] {
            close(read_value(cell.as_bytes(), None, &unknown), 92.0);
        }
    }

    #[test]
    fn a_unit_is_common_to_all_cells_or_none() {
        let unit = |cells: &[&str]| common_unit(cells.iter().copied());
        assert_eq!(unit(&["11.7 kn", "", "12 kts"]).as_deref(), Some("kn"));
        assert_eq!(unit(&["40.1°", "40.2°"]).as_deref(), Some("deg"));
        assert_eq!(unit(&["11.7 kn", "12"]), None);
        assert_eq!(unit(&["11.7", "12"]), None);
        assert_eq!(unit(&[]), None);
    }
}
