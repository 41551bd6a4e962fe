//! Lines of NMEA 2000 logs in the forms of common recorders.

use crate::calendar::SECOND;
use crate::stamp::{DateOrder, StampDate, parse_stamp};

/// Seconds of a day.
const DAY_S: f64 = 86_400.0;

/// Frame or message of a line.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LogLine {
    /// Seconds since 1970, or of the day where no date is written.
    pub t_s: f64,
    /// Parameter group number.
    pub pgn: u32,
    /// Address of the sender.
    pub source: u8,
    pub data: Vec<u8>,
    /// True for a whole message, false for a frame that may be part of one.
    pub is_assembled: bool,
}

/// Parses a line of `candump` (with or without `-L`), of Actisense (`A173321.107 23FF7 1F513 ...`),
/// of Yacht Devices (`17:33:21.107 R 19F51323 ...`) or of canboat
/// (`2024-05-01-12:00:00.000,2,127250,7,255,8,...`); `None` for any other line.
pub(crate) fn parse_log_line(text: &str) -> Option<LogLine> {
    let text = text.trim();
    candump_line(text)
        .or_else(|| actisense_line(text))
        .or_else(|| yacht_devices_line(text))
        .or_else(|| canboat_line(text))
}

/// Returns number and sender of a message from the identifier of a frame, by ISO 11783-3.
fn split_identifier(identifier: u32) -> (u32, u8) {
    let (format, specific) = ((identifier >> 16) & 0xff, (identifier >> 8) & 0xff);
    let page = (identifier >> 24) & 0x3;
    // Below 240 the second byte is the address of the receiver, not a part of the number.
    let pgn = if format < 240 {
        (page << 16) | (format << 8)
    } else {
        (page << 16) | (format << 8) | specific
    };
    (pgn, (identifier & 0xff) as u8)
}

/// `(1436509053.850870) can0 09F8017F#50C3B81347D82BC6`, or `(1.5) can0 09F8017F [8] 50 C3 ...`.
fn candump_line(text: &str) -> Option<LogLine> {
    let (stamp, rest) = text.strip_prefix('(')?.split_once(')')?;
    let mut words = rest.split_whitespace().skip(1);
    let first = words.next()?;
    let (identifier, data) = match first.split_once('#') {
        Some((identifier, data)) => (identifier, hex_bytes(data)?),
        None => {
            // The number of bytes in brackets comes before them.
            words.next().filter(|count| count.starts_with('['))?;
            (first, hex_bytes(&words.collect::<String>())?)
        }
    };
    let (pgn, source) = split_identifier(u32::from_str_radix(identifier, 16).ok()?);
    Some(LogLine { t_s: stamp.trim().parse().ok()?, pgn, source, data, is_assembled: false })
}

/// `A173321.107 23FF7 1F513 012F3070002F30709F`: time, source with destination and priority, number,
/// data.
fn actisense_line(text: &str) -> Option<LogLine> {
    let mut words = text.strip_prefix('A')?.split_whitespace();
    let (clock, addresses, pgn) = (words.next()?, words.next()?, words.next()?);
    let (whole, fraction) = clock.split_once('.').unwrap_or((clock, "0"));
    let digits = |from: usize| whole.get(from..from + 2)?.parse::<f64>().ok();
    let of_day = 3600.0 * digits(0)? + 60.0 * digits(2)? + digits(4)?;
    Some(LogLine {
        t_s: of_day + format!("0.{fraction}").parse::<f64>().ok()?,
        pgn: u32::from_str_radix(pgn, 16).ok()?,
        source: u8::from_str_radix(addresses.get(..2)?, 16).ok()?,
        data: hex_bytes(words.next()?)?,
        is_assembled: true,
    })
}

/// `17:33:21.107 R 19F51323 01 2F 30 70 00 2F 30 70`.
fn yacht_devices_line(text: &str) -> Option<LogLine> {
    let mut words = text.split_whitespace();
    let stamp = parse_stamp(words.next()?, DateOrder::Open)?;
    words.next().filter(|way| matches!(*way, "R" | "T"))?;
    let (pgn, source) = split_identifier(u32::from_str_radix(words.next()?, 16).ok()?);
    let data = hex_bytes(&words.collect::<String>())?;
    let t_s = stamp.of_day as f64 / SECOND as f64;
    Some(LogLine { t_s, pgn, source, data, is_assembled: false })
}

/// `2024-05-01T12:00:00.000Z,2,127250,7,255,8,00,5a,7c,00,00,00,00,fd`: time, priority, number,
/// source, destination, bytes.
fn canboat_line(text: &str) -> Option<LogLine> {
    let mut cells = text.split(',');
    // Older versions write a hyphen between date and time.
    let stamp = cells.next()?;
    let stamp = match stamp.as_bytes().get(10) {
        Some(b'-') => format!("{}T{}", &stamp[..10], &stamp[11..]),
        _ => stamp.to_owned(),
    };
    let stamp = parse_stamp(&stamp, DateOrder::Open)?;
    let StampDate::Known(day) = stamp.date else { return None };
    let _priority: u8 = cells.next()?.parse().ok()?;
    let pgn = cells.next()?.parse().ok()?;
    let source = cells.next()?.parse().ok()?;
    let _destination: u8 = cells.next()?.parse().ok()?;
    let length: usize = cells.next()?.parse().ok()?;
    let data = hex_bytes(&cells.collect::<String>())?;
    let t_s = day as f64 * DAY_S + stamp.of_day as f64 / SECOND as f64;
    // Fast packets are written either whole or frame by frame, of eight bytes each.
    Some(LogLine { t_s, pgn, source, is_assembled: length > 8, data })
}

/// Returns the bytes of hexadecimal digits; `None` for other text and for more than a message has.
fn hex_bytes(text: &str) -> Option<Vec<u8>> {
    let text = text.trim();
    if !text.is_ascii() || !text.len().is_multiple_of(2) || text.is_empty() || text.len() > 2 * 1785
    {
        return None;
    }
    let byte = |at: usize| u8::from_str_radix(&text[at..at + 2], 16).ok();
    (0..text.len()).step_by(2).map(byte).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn lines_of_five_recorders_are_one_message() {
        let data = vec![0xff, 0x10, 0x27, 0xff, 0x7f, 0xff, 0x7f, 0xfd];
        for (text, t_s) in [
            ("(1714564800.500000) can0 09F11223#FF1027FF7FFF7FFD", 1_714_564_800.5),
            (" (012.250000)  can0  09F11223   [8]  FF 10 27 FF 7F FF 7F FD", 12.25),
            ("A000130.500 23FF2 1F112 FF1027FF7FFF7FFD", 90.5),
            ("00:01:30.500 R 09F11223 FF 10 27 FF 7F FF 7F FD", 90.5),
            ("2024-05-01-12:00:00.500,2,127250,35,255,8,ff,10,27,ff,7f,ff,7f,fd", 1_714_564_800.5),
        ] {
            let line = parse_log_line(text).unwrap();
            assert_eq!((line.pgn, line.source, &line.data), (127_250, 0x23, &data), "{text}");
            assert!((line.t_s - t_s).abs() < 1e-6, "{text}: {}", line.t_s);
        }
        for text in ["", "t_s,u_m_s", "(1.0)", "A12", "# candump", "(1) can0 09F1#0", "é,1,2"] {
            assert_eq!(parse_log_line(text), None, "{text}");
        }
    }
}
