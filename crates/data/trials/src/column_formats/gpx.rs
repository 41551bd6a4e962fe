//! GPX tracks: the points with their times, and course and speed where a recorder adds them.

use std::io::{self, BufReader, Read};

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use crate::calendar::SECOND;
use crate::column_source::MemoryColumns;
use crate::limits::FileLimits;
use crate::stamp::{DateOrder, StampDate, parse_stamp};

/// Seconds of a day.
const DAY_S: f64 = 86_400.0;

/// Columns that are read: name, element of a point, unit.
const EXTRAS: [(&str, &str, &str); 3] =
    [("course", "course_deg", "deg"), ("speed", "speed_m_s", "m/s"), ("hdg", "psi_deg", "deg")];

/// Columns of the points that are read so far.
#[derive(Default)]
struct TrackPoints {
    time: Vec<f64>,
    latitude: Vec<f64>,
    longitude: Vec<f64>,
    extras: [Vec<f64>; EXTRAS.len()],
}

/// Reads the points of all segments of all tracks.
///
/// # Errors
/// Returns an error if the file is no XML, has no point with a time, or more points than the limits
/// allow.
pub(crate) fn read_gpx(input: impl Read, limits: FileLimits) -> io::Result<MemoryColumns> {
    // XML is read in pieces; the bound also covers an element without an end.
    let input = BufReader::new(input.take(limits.unpacked_bytes as u64));
    let mut reader = Reader::from_reader(input);
    let (mut points, mut buffer, mut open) = (TrackPoints::default(), Vec::new(), None);
    loop {
        let at = reader.buffer_position();
        let damaged = |what: &dyn std::fmt::Display| {
            io::Error::new(io::ErrorKind::InvalidData, format!("byte {at}: {what}"))
        };
        match reader.read_event_into(&mut buffer).map_err(|error| damaged(&error))? {
            Event::Start(element) => {
                let name = element.local_name().as_ref().to_owned();
                if name == "trkpt" {
                    points.begin_point(&element).ok_or_else(|| damaged(&"a point has no place"))?;
                }
                open = Some(name);
            }
            Event::Text(text) => {
                points.set_value(open.as_deref().unwrap_or_default(), text.trim());
            }
            Event::End(_) => open = None,
            Event::Eof => break,
            _ => {}
        }
        if points.time.len() > limits.rows {
            return Err(damaged(&"it has more points than are read; split it"));
        }
        buffer.clear();
    }
    points.into_columns()
}

impl TrackPoints {
    /// Adds a point without values besides its place; `None` if it has no place.
    fn begin_point(&mut self, element: &BytesStart) -> Option<()> {
        let degrees = |name: &str| {
            let attribute = element.try_get_attribute(name).ok()??;
            attribute.value.trim().parse::<f64>().ok()
        };
        self.latitude.push(degrees("lat")?);
        self.longitude.push(degrees("lon")?);
        self.time.push(f64::NAN);
        self.extras.iter_mut().for_each(|values| values.push(f64::NAN));
        Some(())
    }

    /// Sets a value of the last point by the name of its element.
    fn set_value(&mut self, element: &str, text: &str) {
        if element == "time"
            && let (Some(time), Some(seconds)) = (self.time.last_mut(), unix_seconds(text))
        {
            *time = seconds;
        }
        let extra = EXTRAS.iter().position(|(name, ..)| *name == element);
        if let (Some(at), Ok(number)) = (extra, text.parse()) {
            self.extras[at].last_mut().into_iter().for_each(|value| *value = number);
        }
    }

    fn into_columns(self) -> io::Result<MemoryColumns> {
        if !self.time.iter().any(|time| time.is_finite()) {
            let message = "it has no track point with a time; export it with times";
            return Err(io::Error::new(io::ErrorKind::InvalidData, message));
        }
        let mut columns = MemoryColumns::default();
        columns.push_column("time".into(), "unix", self.time);
        columns.push_column("latitude_deg".into(), "deg", self.latitude);
        columns.push_column("longitude_deg".into(), "deg", self.longitude);
        for ((_, name, unit), values) in EXTRAS.into_iter().zip(self.extras) {
            if values.iter().any(|value| value.is_finite()) {
                columns.push_column(name.into(), unit, values);
            }
        }
        Ok(columns)
    }
}

/// Returns the seconds since 1970 of a date and time, in UTC unless a zone is written.
fn unix_seconds(text: &str) -> Option<f64> {
    let stamp = parse_stamp(text, DateOrder::Open)?;
    let StampDate::Known(day) = stamp.date else { return None };
    let of_day = stamp.of_day - stamp.zone.unwrap_or(0);
    Some(day as f64 * DAY_S + of_day as f64 / SECOND as f64)
}
