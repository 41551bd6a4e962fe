//! CSV files of ROS messages, a column for each field, as `rostopic echo -p`, bagpy and PlotJuggler
//! write them: poses, twists and orientations become channels as in a bag.

use std::io;

use csv::ByteRecord;

use super::message_log::{MessageLog, MessageValue};
use super::ros_topics::{TopicMessage, TypeParts, is_command, motion_values};
use crate::column_source::MemoryColumns;
use crate::layout::likely_separator;
use crate::limits::{FileLimits, too_many_rows};

/// Paths of the parts of a message, the longest first.
const POSITIONS: [&str; 3] = ["pose.pose.position", "pose.position", "position"];
const ORIENTATIONS: [&str; 3] = ["pose.pose.orientation", "pose.orientation", "orientation"];
const LINEAR: [&str; 3] = ["twist.twist.linear", "twist.linear", "linear"];
const ANGULAR: [&str; 4] = ["twist.twist.angular", "twist.angular", "angular", "angular_velocity"];

/// Segments of a path that are no quantity of a trial, or belong to a part of a message.
const NO_QUANTITY: [&str; 13] = [
    "header",
    "seq",
    "stamp",
    "secs",
    "nsecs",
    "frame_id",
    "child_frame_id",
    "position",
    "orientation",
    "linear",
    "angular",
    "angular_velocity",
    "linear_acceleration",
];

/// Message in the columns of a file.
#[derive(Debug, Default)]
struct MessageColumns {
    parts: TypeParts,
    /// Column and path within the message of each number.
    numbers: Vec<(usize, String)>,
    /// The same of the frames.
    frames: Vec<(usize, String)>,
}

/// Columns of a file by what they hold.
#[derive(Debug)]
struct RosHeader {
    time: TimeColumns,
    messages: Vec<MessageColumns>,
    /// Any other number, with its name.
    others: Vec<(usize, String)>,
}

/// Columns of the time.
#[derive(Debug, Clone, Copy, PartialEq)]
enum TimeColumns {
    /// Seconds, milliseconds, microseconds or nanoseconds.
    One(usize),
    /// Seconds and nanoseconds.
    Two(usize, usize),
}

/// Returns true if the first line names the fields of a quaternion or a twist of ROS.
pub(crate) fn is_ros_header(start: &[u8]) -> bool {
    let Some(line) = start.split(|&byte| byte == b'\n').next() else { return false };
    let text = String::from_utf8_lossy(line);
    let names = text.split(char::from(likely_separator(line)));
    let paths: Vec<String> = names.map(|name| field_path(name.trim().trim_matches('"'))).collect();
    let has = |path: String| paths.contains(&path);
    paths.iter().any(|path| match path.rsplit_once('.') {
        Some((base, "w")) if last_segment(base) == "orientation" => {
            ["x", "y", "z"].iter().all(|axis| has(format!("{base}.{axis}")))
        }
        Some((base, "x")) if last_segment(base) == "linear" => {
            has(format!("{}angular.z", &base[..base.len() - "linear".len()]))
        }
        _ => false,
    })
}

/// Reads the messages of all rows.
///
/// # Errors
/// Returns an error if there is no time, or more rows or numbers than the limits allow.
pub(crate) fn read_ros_csv(text: &[u8], limits: FileLimits) -> io::Result<MemoryColumns> {
    let line = text.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let mut reader = csv::ReaderBuilder::new()
        .flexible(true)
        .trim(csv::Trim::All)
        .delimiter(likely_separator(line))
        .from_reader(text);
    let names: Vec<String> = reader.byte_headers()?.iter().map(lossy_text).collect();
    let header = RosHeader::from_names(&names)?;
    let (mut log, mut is_dated) = (MessageLog::new(limits), false);
    for (row, record) in reader.byte_records().enumerate() {
        if row == limits.rows {
            return Err(invalid(too_many_rows(limits.rows)));
        }
        let cells = record?;
        // A row without a time has no place in the log.
        if let Some(time) = header.time.read_seconds(&cells) {
            is_dated |= time > DATED_S;
            header.add_row(&mut log, time, &cells)?;
        }
    }
    log.into_columns(is_dated)
}

/// Seconds above which a time counts from 1970: three years, which no log lasts.
const DATED_S: f64 = 1e8;

fn invalid(message: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, message)
}

fn lossy_text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Returns the path of a field with dots, without the marks of the program that wrote it.
fn field_path(name: &str) -> String {
    let name = name.trim_start_matches(['\u{feff}', '%', '/']).replace('/', ".");
    name.strip_prefix("field.").map_or(name.clone(), str::to_owned)
}

fn last_segment(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or_default()
}

fn read_number(cells: &ByteRecord, at: usize) -> Option<f64> {
    let text = std::str::from_utf8(cells.get(at)?).ok()?;
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

impl TimeColumns {
    /// The recorder's own time, else the stamp of the messages.
    fn from_paths(paths: &[String]) -> Option<Self> {
        let find = |is_one: &dyn Fn(&str) -> bool| paths.iter().position(|path| is_one(path));
        let plain = |path: &str| {
            matches!(
                path.trim_matches('_').to_lowercase().as_str(),
                "time" | "timestamp" | "rosbagtimestamp" | "log_time" | "receive_time"
            )
        };
        let two = |seconds: [&str; 2], rest: [&str; 2]| {
            let ends = |path: &str, names: [&str; 2]| names.iter().any(|name| path.ends_with(name));
            let of = |names: [&str; 2]| find(&|path: &str| ends(path, names));
            Some(Self::Two(of(seconds)?, of(rest)?))
        };
        find(&plain)
            .map(Self::One)
            .or_else(|| two(["stamp.sec", "stamp.secs"], ["stamp.nanosec", "stamp.nsecs"]))
            .or_else(|| find(&|path: &str| last_segment(path) == "stamp").map(Self::One))
    }

    /// Returns the time of a row, s.
    fn read_seconds(self, cells: &ByteRecord) -> Option<f64> {
        match self {
            Self::Two(seconds, rest) => {
                Some(read_number(cells, seconds)? + 1e-9 * read_number(cells, rest)?)
            }
            Self::One(at) => {
                let number = read_number(cells, at)?;
                // Since 1970 these units are a factor of a thousand apart.
                let unit = [(1e17, 1e-9), (1e14, 1e-6), (1e11, 1e-3)];
                let unit = unit.into_iter().find(|(least, _)| number > *least);
                Some(number * unit.map_or(1.0, |(_, seconds)| seconds))
            }
        }
    }
}

impl RosHeader {
    fn from_names(names: &[String]) -> io::Result<Self> {
        let paths: Vec<String> = names.iter().map(|name| field_path(name)).collect();
        let missing = || {
            invalid(
                "it has no column of time, such as `time` or `header.stamp`; add one".to_owned(),
            )
        };
        let time = TimeColumns::from_paths(&paths).ok_or_else(missing)?;
        let messages = find_messages(&paths);
        let is_other = |path: &str| {
            let named =
                |segment: &str| NO_QUANTITY.contains(&segment) || segment.starts_with("covariance");
            !path.split('.').any(named)
        };
        let used = |at: usize| match time {
            TimeColumns::One(one) => at == one,
            TimeColumns::Two(one, other) => at == one || at == other,
        };
        let others = paths.iter().enumerate().filter(|(at, path)| !used(*at) && is_other(path));
        let others = others.map(|(at, path)| (at, plain_name(path))).collect();
        Ok(Self { time, messages, others })
    }

    fn add_row(&self, log: &mut MessageLog, time: f64, cells: &ByteRecord) -> io::Result<()> {
        for (source, message) in (0_u32..).zip(&self.messages) {
            for value in motion_values(&message.parts, &message.read_row(cells)) {
                log.add_value(time, source, value)?;
            }
        }
        for (at, name) in &self.others {
            if let Some(number) = read_number(cells, *at) {
                let value = MessageValue { name: name.clone(), unit: "", number };
                log.add_value(time, u32::MAX, value)?;
            }
        }
        Ok(())
    }
}

/// Name of a plain number: its topic where the field is the whole message.
fn plain_name(path: &str) -> String {
    let topic = path.strip_suffix(".data").or_else(|| path.strip_suffix(".value"));
    topic.unwrap_or(path).to_owned()
}

/// Returns the messages that measure a pose, an orientation or a twist.
fn find_messages(paths: &[String]) -> Vec<MessageColumns> {
    let mut prefixes: Vec<&str> = Vec::new();
    let parts = POSITIONS.iter().chain(&ORIENTATIONS).chain(&LINEAR).chain(&ANGULAR);
    let parts: Vec<&str> = parts.copied().collect();
    for path in paths {
        let base = path.rsplit_once('.').map_or("", |(base, _)| base);
        // The longest part first, so that nothing of a part is left in the prefix.
        let longest = parts.iter().filter(|part| ends_with_path(base, part));
        if let Some(part) = longest.max_by_key(|part| part.len()) {
            let prefix = &base[..base.len() - part.len()];
            if !prefixes.contains(&prefix) && !is_command(prefix) {
                prefixes.push(prefix);
            }
        }
    }
    prefixes.into_iter().map(|prefix| MessageColumns::from_paths(prefix, paths)).collect()
}

fn ends_with_path(base: &str, part: &str) -> bool {
    base.strip_suffix(part).is_some_and(|prefix| prefix.is_empty() || prefix.ends_with('.'))
}

impl MessageColumns {
    fn from_paths(prefix: &str, paths: &[String]) -> Self {
        let own = paths
            .iter()
            .enumerate()
            .filter_map(|(at, path)| path.strip_prefix(prefix).map(|rest| (at, rest.to_owned())));
        let own: Vec<(usize, String)> = own.collect();
        let part = |names: &[&'static str]| {
            let has = |name: &&&str| own.iter().any(|(_, path)| is_axis(path, name));
            names.iter().find(has).copied()
        };
        let parts = TypeParts {
            kind: "",
            position: part(&POSITIONS),
            orientation: part(&ORIENTATIONS),
            linear: part(&LINEAR),
            angular: part(&ANGULAR),
        };
        let all = [parts.position, parts.orientation, parts.linear, parts.angular];
        let is_number = |path: &str| all.iter().flatten().any(|part| is_axis(path, part));
        let is_frame = |path: &str| last_segment(path).ends_with("frame_id");
        let select = |keeps: &dyn Fn(&str) -> bool| {
            own.iter().filter(|(_, path)| keeps(path)).cloned().collect()
        };
        Self { parts, numbers: select(&is_number), frames: select(&is_frame) }
    }

    fn read_row(&self, cells: &ByteRecord) -> TopicMessage {
        let mut message = TopicMessage::default();
        let numbers = self.numbers.iter();
        message.numbers = numbers
            .filter_map(|(at, path)| Some((path.clone(), read_number(cells, *at)?)))
            .collect();
        for (at, path) in &self.frames {
            message.set_frame(path, &cells.get(*at).map(lossy_text).unwrap_or_default());
        }
        message
    }
}

/// Returns true for an axis of a part.
fn is_axis(path: &str, part: &str) -> bool {
    let axis = path.strip_prefix(part).and_then(|rest| rest.strip_prefix('.'));
    axis.is_some_and(|axis| matches!(axis, "x" | "y" | "z" | "w"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::column_source::ColumnSource;

    /// East with 2 m/s, turning to port by 0.1 rad/s as seen from above, a rudder besides.
    fn file(header: &str, row: impl Fn(f64) -> String) -> MemoryColumns {
        let mut text = format!("{header}\n");
        (0..30).for_each(|k| text += &format!("{}\n", row(0.1 * f64::from(k))));
        assert!(is_ros_header(text.as_bytes()), "{header}");
        read_ros_csv(text.as_bytes(), FileLimits::default()).unwrap()
    }

    fn last(columns: &mut MemoryColumns, name: &str) -> f64 {
        let names: Vec<String> = columns.columns().iter().map(|one| one.name.clone()).collect();
        let at = names.iter().position(|one| one == name).unwrap_or_else(|| panic!("{names:?}"));
        columns.read_numbers(&[at]).unwrap()[0][29]
    }

    fn check(mut columns: MemoryColumns, rudder: &str) {
        for (name, wanted) in [
            ("x_m", 7.0),
            ("y_m", 5.8),
            ("psi_rad", std::f64::consts::FRAC_PI_2),
            ("u_m_s", 2.0),
            ("v_m_s", -0.1),
            ("r_rad_s", -0.1),
            (rudder, 12.0),
        ] {
            let found = last(&mut columns, name);
            assert!((found - wanted).abs() < 1e-6, "{name}: {found}");
        }
    }

    #[test]
    fn echoed_topics_have_stamps_in_nanoseconds_and_frames() {
        let columns = file(
            "%time,field.header.seq,field.header.stamp,field.header.frame_id,\
             field.child_frame_id,field.pose.pose.position.x,field.pose.pose.position.y,\
             field.pose.pose.position.z,field.pose.pose.orientation.x,\
             field.pose.pose.orientation.y,field.pose.pose.orientation.z,\
             field.pose.pose.orientation.w,field.pose.covariance0,field.twist.twist.linear.x,\
             field.twist.twist.linear.y,field.twist.twist.linear.z,field.twist.twist.angular.x,\
             field.twist.twist.angular.y,field.twist.twist.angular.z,field.rudder",
            |t| {
                let ns = 1_761_890_000_000_000_000_u64 + (t * 1e9) as u64;
                let x = 2.0 * t;
                format!("{ns},7,{ns},odom,base_link,{x},7,0,0,0,0,1,5,2,0.1,0,0,0,0.1,12")
            },
        );
        assert_eq!(columns.columns()[0].unit, "unix");
        check(columns, "rudder");
    }

    #[test]
    fn merged_topics_have_blanks_between_their_messages() {
        let columns = file(
            "__time,/odom/pose/pose/position/x,/odom/pose/pose/position/y,\
             /odom/pose/pose/orientation/x,/odom/pose/pose/orientation/y,\
             /odom/pose/pose/orientation/z,/odom/pose/pose/orientation/w,\
             /odom/twist/twist/linear/x,/odom/twist/twist/linear/y,\
             /odom/twist/twist/angular/z,/rudder/angle/data,/cmd_vel/linear/x",
            |t| format!("{t},{},7,0,0,0,1,2,0.1,0.1,,\n{t},,,,,,,,,,12,9", 2.0 * t),
        );
        assert_eq!(columns.columns()[0].unit, "s");
        check(columns, "rudder.angle");
    }

    #[test]
    fn a_frame_that_points_down_is_not_turned() {
        let mut columns = file(
            "Time;header.frame_id;orientation.x;orientation.y;orientation.z;orientation.w;\
             angular_velocity.z",
            |t| format!("{t};imu_frd;0;0;0;1;0.1"),
        );
        assert_eq!(last(&mut columns, "r_rad_s"), 0.1);
        assert_eq!(last(&mut columns, "psi_rad"), 0.0);
    }

    #[test]
    fn other_files_are_no_messages_and_one_without_a_time_is_refused() {
        assert!(!is_ros_header(b"t,x,y,z,w\n"));
        assert!(!is_ros_header(b"time,orientation.x,linear.x\n"));
        assert!(is_ros_header(b"time,/cmd/linear/x,/cmd/angular/z\n"));
        assert!(!is_ros_header(b""));
        let text = "orientation.x,orientation.y,orientation.z,orientation.w\n0,0,0,1\n";
        let error = read_ros_csv(text.as_bytes(), FileLimits::default()).unwrap_err();
        assert!(error.to_string().contains("no column of time"), "{error}");
        let limits = FileLimits { rows: 1, ..FileLimits::default() };
        let text = format!("time,{text}").replace("\n0,", "\n0,0,") + "1,0,0,0,1\n";
        let error = read_ros_csv(text.as_bytes(), limits).unwrap_err();
        assert!(error.to_string().contains("more rows"), "{error}");
    }
}
