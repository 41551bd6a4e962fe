//! Logs of NMEA 2000 as text: frames and fast packets become messages, and these become columns.

use std::collections::HashMap;
use std::io::{self, BufRead, BufReader, Read};

use super::candump::{LogLine, parse_log_line};
use super::message_log::MessageLog;
use super::nmea2000_messages::{decode_message, is_fast_packet};
use crate::column_source::MemoryColumns;
use crate::limits::FileLimits;

/// Seconds of a day, and the decrease of a time of day from which a line belongs to the next day.
const DAY_S: f64 = 86_400.0;
const MIDNIGHT_S: f64 = 43_200.0;
/// Largest number of bytes of a fast packet, of its first frame, and of each further one.
const PACKET: usize = 223;
const FIRST: usize = 6;
const FURTHER: usize = 7;
/// Largest number of packets that are open at a time.
const OPEN: usize = 1000;

/// Columns of the first of several instances: alone, and with the second, which is to starboard.
const PAIRS: [(&str, &str, &str); 2] =
    [("delta_rad", "delta_p_rad", "delta_s_rad"), ("n_rpm", "n_p_rpm", "n_s_rpm")];

/// Fast packet whose frames are not complete.
struct OpenPacket {
    counter: u8,
    next_frame: u8,
    length: usize,
    bytes: Vec<u8>,
}

/// Assembler of fast packets, by message and source.
#[derive(Default)]
struct PacketAssembler {
    open: HashMap<(u32, u8), OpenPacket>,
}

impl PacketAssembler {
    /// Adds a frame; returns the message that it completes.
    fn add_frame(&mut self, pgn: u32, source: u8, data: &[u8]) -> Option<Vec<u8>> {
        let (&head, rest) = data.split_first()?;
        // The upper three bits count packets, the lower five the frames of a packet.
        let (counter, frame) = (head >> 5, head & 0x1f);
        if frame == 0 {
            let (&length, rest) = rest.split_first()?;
            let length = usize::from(length).min(PACKET);
            let bytes = rest.iter().copied().take(length.min(FIRST)).collect();
            if self.open.len() < OPEN {
                self.open
                    .insert((pgn, source), OpenPacket { counter, next_frame: 1, length, bytes });
            }
        } else {
            let packet = self.open.get_mut(&(pgn, source))?;
            if packet.counter != counter || packet.next_frame != frame {
                // A lost frame: nothing of the packet is used.
                self.open.remove(&(pgn, source));
                return None;
            }
            packet.next_frame += 1;
            let open = packet.length.saturating_sub(packet.bytes.len()).min(FURTHER);
            packet.bytes.extend(rest.iter().take(open));
        }
        let done =
            self.open.get(&(pgn, source)).is_some_and(|packet| packet.bytes.len() >= packet.length);
        if done { self.open.remove(&(pgn, source)).map(|packet| packet.bytes) } else { None }
    }
}

/// Clock of a log whose lines may have the time of day alone.
#[derive(Default)]
struct LineClock {
    last: Option<f64>,
    midnights: f64,
}

impl LineClock {
    fn continuous_seconds(&mut self, of_day: f64) -> f64 {
        if self.last.is_some_and(|last| last - of_day > MIDNIGHT_S) {
            self.midnights += 1.0;
        }
        self.last = Some(of_day);
        of_day + self.midnights * DAY_S
    }
}

/// Reads the messages of a log that are of use for a trial.
///
/// # Errors
/// Returns an error if a line is too long, or the log has no message of use.
pub(crate) fn read_nmea2000(input: impl Read, limits: FileLimits) -> io::Result<MemoryColumns> {
    let mut log = MessageLog::new(limits);
    let (mut packets, mut clock) = (PacketAssembler::default(), LineClock::default());
    let mut is_dated = false;
    let (mut input, mut bytes) = (BufReader::new(input), Vec::new());
    for row in 1.. {
        bytes.clear();
        let most = limits.line_bytes as u64;
        let read = input.by_ref().take(most).read_until(b'\n', &mut bytes)?;
        if read == 0 {
            break;
        }
        if read as u64 == most {
            return Err(io::Error::other(format!("line {row} is longer than {most} bytes")));
        }
        let Some(line) = parse_log_line(&String::from_utf8_lossy(&bytes)) else { continue };
        let LogLine { t_s, pgn, source, data, is_assembled } = line;
        // Seconds since 1970 are larger than those of a day.
        is_dated = t_s > 1e9;
        let t_s = if is_dated { t_s } else { clock.continuous_seconds(t_s) };
        let is_frame = is_fast_packet(pgn) && !is_assembled;
        let message = if is_frame { packets.add_frame(pgn, source, &data) } else { Some(data) };
        for value in message.iter().flat_map(|message| decode_message(pgn, message)) {
            // A quantity is read from one message of one sender.
            log.add_value(t_s, (pgn << 8) | u32::from(source), value)?;
        }
    }
    for (alone, port, starboard) in PAIRS {
        if log.has_column(starboard) {
            log.rename_column(alone, port);
        }
    }
    log.into_columns(is_dated)
}
