//! The forms in which trials are written. The first is the canonical one.

use sistership_model::Trial;
use sistership_model::trial::Channel;

use super::containers;
use super::table::Table;
use crate::sea_trials::csv;

/// Files by their names.
pub type Files = Vec<(String, Vec<u8>)>;

/// A way to write a trial.
pub struct Form {
    pub name: &'static str,
    /// The files of a trial and its number.
    pub write: fn(&Trial, usize) -> Files,
}

pub const FORMS: [Form; 26] = [
    Form { name: "canonical", write: |trial, k| one(k, "csv", csv(trial)) },
    Form { name: "ISO 8601 in UTC", write: |trial, k| timed(trial, k, "time", &iso) },
    Form {
        name: "local time with a blank",
        write: |trial, k| timed(trial, k, "Date/Time", &blank),
    },
    Form { name: "day.month.year", write: |trial, k| timed(trial, k, "timestamp", &dotted) },
    Form { name: "time of day over midnight", write: |trial, k| timed(trial, k, "time", &clock) },
    Form {
        name: "serial days of a sheet",
        write: |trial, k| timed(trial, k, "Date Time", &serial),
    },
    Form { name: "lines above the header", write: above },
    Form { name: "units in a line of their own", write: units_below },
    Form { name: "semicolons and decimal commas", write: decimal_commas },
    Form { name: "tabs", write: |trial, k| one(k, "txt", joined(trial, "\t")) },
    Form { name: "Latin-1 with a degree sign", write: latin },
    Form { name: "byte-order mark", write: marked },
    Form { name: "an empty column", write: empty_column },
    Form { name: "columns that nobody needs", write: more_columns },
    Form { name: "knots", write: knots },
    Form { name: "heading from 0 to 360", write: compass },
    Form { name: "port and starboard rudders", write: pair },
    Form { name: "latitude and longitude", write: |trial, k| one(k, "csv", fixes(trial, true)) },
    Form {
        name: "position and heading only",
        write: |trial, k| one(k, "csv", fixes(trial, false)),
    },
    Form { name: "course and speed over ground", write: over_ground },
    Form { name: "CRLF and blanks in cells", write: padded },
    Form { name: "Parquet", write: containers::parquet },
    Form { name: "an Excel sheet", write: containers::workbook },
    Form { name: "a MATLAB file", write: containers::matlab },
    Form { name: "an NMEA 0183 log", write: containers::nmea },
    Form { name: "a file for each sensor, at its own rate", write: containers::sensors },
];

pub fn one(k: usize, ending: &str, bytes: Vec<u8>) -> Files {
    vec![(format!("trial_{k}.{ending}"), bytes)]
}

pub fn seconds(header: &str, trial: &Trial) -> Table {
    Table::new().text(header, trial, |_, t| format!("{t:.3}"))
}

pub fn plain(trial: &Trial) -> Table {
    seconds("time [s]", trial).motion(trial)
}

fn joined(trial: &Trial, separator: &str) -> Vec<u8> {
    (plain(trial).lines(separator).join("\n") + "\n").into_bytes()
}

/// Time by a function of seconds.
fn timed(trial: &Trial, k: usize, header: &str, of: &dyn Fn(f64) -> String) -> Files {
    let table = Table::new().text(header, trial, |_, t| of(t)).motion(trial);
    one(k, "csv", table.csv())
}

/// Hours, minutes and seconds of seconds after an hour.
fn hms(hour: u32, t: f64) -> String {
    let (minutes, seconds) = ((t / 60.0).floor(), t % 60.0);
    let hours = f64::from(hour) + (minutes / 60.0).floor();
    format!("{:02.0}:{:02.0}:{seconds:06.3}", hours % 24.0, minutes % 60.0)
}

fn iso(t: f64) -> String {
    format!("2024-05-01T{}Z", hms(9, t))
}

fn blank(t: f64) -> String {
    format!("2024-05-01 {}", hms(9, t))
}

fn dotted(t: f64) -> String {
    format!("21.05.2024 {}", hms(9, t))
}

fn clock(t: f64) -> String {
    hms(23, t + 3500.0)
}

/// Days since 1899-12-30.
fn serial(t: f64) -> String {
    format!("{:.10}", 45_413.4 + t / 86_400.0)
}

fn above(trial: &Trial, k: usize) -> Files {
    let text = format!("Logger 7\nVoyage,12\n\n{}\n", plain(trial).lines(",").join("\n"));
    one(k, "csv", text.into_bytes())
}

fn units_below(trial: &Trial, k: usize) -> Files {
    let mut lines = plain(trial).lines(",");
    let header = lines.remove(0);
    let split = |cell: &str| {
        let (name, unit) = cell.split_once(" [").unwrap_or((cell, ""));
        (name.to_owned(), format!("[{}]", unit.trim_end_matches(']')))
    };
    let (names, units): (Vec<String>, Vec<String>) = header.split(',').map(split).unzip();
    let text = format!("{}\n{}\n{}\n", names.join(","), units.join(","), lines.join("\n"));
    one(k, "csv", text.into_bytes())
}

fn decimal_commas(trial: &Trial, k: usize) -> Files {
    let lines = plain(trial).lines(";");
    let rows = lines[1..].iter().map(|line| line.replace('.', ","));
    let all: Vec<String> = std::iter::once(lines[0].clone()).chain(rows).collect();
    one(k, "csv", (all.join("\n") + "\n").into_bytes())
}

fn latin(trial: &Trial, k: usize) -> Files {
    let text = String::from_utf8(plain(trial).csv()).expect("text");
    let text = text.replace("[deg]", "[\u{b0}]").replace("[deg/s]", "[\u{b0}/s]");
    let bytes = text.chars().map(|c| u8::try_from(u32::from(c)).expect("Latin-1")).collect();
    one(k, "csv", bytes)
}

fn marked(trial: &Trial, k: usize) -> Files {
    one(k, "csv", [b"\xef\xbb\xbf".to_vec(), plain(trial).csv()].concat())
}

fn empty_column(trial: &Trial, k: usize) -> Files {
    let table = plain(trial).text("wind speed [m/s]", trial, |_, _| String::new());
    one(k, "csv", table.csv())
}

fn more_columns(trial: &Trial, k: usize) -> Files {
    let table = plain(trial).text("engine load [%]", trial, |k, _| (40 + k % 7).to_string()).text(
        "remark",
        trial,
        |_, _| "ok".into(),
    );
    one(k, "csv", table.csv())
}

fn knots(trial: &Trial, k: usize) -> Files {
    let to_knots = |speed: f64| speed / 0.514_444_444_444;
    let table = seconds("t [s]", trial)
        .channel("surge [kn]", trial, Channel::U, to_knots)
        .channel("sway [kn]", trial, Channel::V, to_knots)
        .channel("ROT [deg/min]", trial, Channel::R, |r| 60.0 * r.to_degrees())
        .steering(trial)
        .position(trial);
    one(k, "csv", table.csv())
}

fn compass(trial: &Trial, k: usize) -> Files {
    let table = seconds("t [s]", trial)
        .velocities(trial)
        .channel("HDG [deg]", trial, Channel::Psi, |psi| psi.to_degrees().rem_euclid(360.0))
        .channel("rudder [deg]", trial, Channel::Delta, f64::to_degrees)
        .revolutions(trial)
        .position(trial);
    one(k, "csv", table.csv())
}

fn pair(trial: &Trial, k: usize) -> Files {
    let table = seconds("t [s]", trial)
        .velocities(trial)
        .channel("heading [deg]", trial, Channel::Psi, f64::to_degrees)
        .channel("rudder port [deg]", trial, Channel::Delta, |d| d.to_degrees() - 0.1)
        .channel("rudder starboard [deg]", trial, Channel::Delta, |d| d.to_degrees() + 0.1)
        .revolutions(trial)
        .position(trial);
    one(k, "csv", table.csv())
}

/// Position in degrees on a sphere's local plane: a few hundred metres lose nothing by it.
fn fixes(trial: &Trial, with_velocities: bool) -> Vec<u8> {
    let latitude = |x: f64| 51.0 + x / 111_253.0;
    let longitude = |y: f64| 3.0 + y / (111_412.9 * 51.0_f64.to_radians().cos() * 1.001_93);
    let table = seconds("t [s]", trial);
    let table = if with_velocities { table.velocities(trial) } else { table };
    let values = |channel| trial.channel(channel).expect("a position");
    let (x, y) = (values(Channel::X), values(Channel::Y));
    table
        .steering(trial)
        .text("Latitude [deg]", trial, |k, _| format!("{:.9}", latitude(x[k])))
        .text("Longitude [deg]", trial, |k, _| format!("{:.9}", longitude(y[k])))
        .csv()
}

fn over_ground(trial: &Trial, k: usize) -> Files {
    let values = |channel| trial.channel(channel).expect("a velocity");
    let (u, v, psi) = (values(Channel::U), values(Channel::V), values(Channel::Psi));
    let course = |k: usize| (psi[k] + v[k].atan2(u[k])).to_degrees().rem_euclid(360.0);
    let table = seconds("t [s]", trial)
        .text("COG [deg]", trial, |k, _| format!("{:.7}", course(k)))
        .text("SOG [m/s]", trial, |k, _| format!("{:.7}", u[k].hypot(v[k])))
        .channel("yaw rate [deg/s]", trial, Channel::R, f64::to_degrees)
        .steering(trial)
        .position(trial);
    one(k, "csv", table.csv())
}

fn padded(trial: &Trial, k: usize) -> Files {
    let lines: Vec<String> =
        plain(trial).lines(",").iter().map(|line| line.replace(',', " , ")).collect();
    one(k, "csv", (lines.join("\r\n") + "\r\n").into_bytes())
}
