//! Trials in files that are no text, in logs of sentences and of frames, and in a file for each sensor.

use std::io::{Cursor, Write};

use sistership_model::Trial;
use sistership_model::trial::Channel;
use sistership_trials::samples::to_parquet;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::forms::{Files, one, plain, seconds};
use crate::sea_trials::csv;

pub fn parquet(trial: &Trial, k: usize) -> Files {
    one(k, "parquet", to_parquet(trial).expect("Parquet"))
}

const NAMESPACE: &str = "http://schemas.openxmlformats.org";

/// A workbook with one sheet, its headers as text in the cells themselves.
pub fn workbook(trial: &Trial, k: usize) -> Files {
    let lines = plain(trial).lines(",");
    let row =
        |line: &String| format!("<row>{}</row>", line.split(',').map(cell).collect::<String>());
    let main = format!("{NAMESPACE}/spreadsheetml/2006/main");
    let kinds = format!("{NAMESPACE}/officeDocument/2006/relationships");
    let related = |kind: &str, target: &str| {
        format!(
            r#"<Relationships xmlns="{NAMESPACE}/package/2006/relationships"><Relationship Id="r1" Type="{kinds}/{kind}" Target="{target}"/></Relationships>"#
        )
    };
    let rows: String = lines.iter().map(row).collect();
    let parts = [
        ("_rels/.rels", related("officeDocument", "xl/workbook.xml")),
        ("xl/_rels/workbook.xml.rels", related("worksheet", "worksheets/sheet1.xml")),
        (
            "xl/workbook.xml",
            format!(
                r#"<workbook xmlns="{main}" xmlns:r="{kinds}"><sheets><sheet name="Trial" sheetId="1" r:id="r1"/></sheets></workbook>"#
            ),
        ),
        (
            "xl/worksheets/sheet1.xml",
            format!(r#"<worksheet xmlns="{main}"><sheetData>{rows}</sheetData></worksheet>"#),
        ),
    ];
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, text) in parts {
        zip.start_file(name, SimpleFileOptions::default()).expect("a file in the workbook");
        zip.write_all(text.as_bytes()).expect("written to memory");
    }
    one(k, "xlsx", zip.finish().expect("a workbook").into_inner())
}

fn cell(text: &str) -> String {
    match text.parse::<f64>() {
        Ok(_) => format!("<c><v>{text}</v></c>"),
        Err(_) => format!(r#"<c t="inlineStr"><is><t>{text}</t></is></c>"#),
    }
}

/// A vector of doubles for each channel, after MathWorks, MAT-File Format (level 5).
pub fn matlab(trial: &Trial, k: usize) -> Files {
    let mut bytes = format!("{:<124}", "MATLAB 5.0 MAT-file").into_bytes();
    bytes.extend([0, 1, b'I', b'M']);
    let text = String::from_utf8(csv(trial)).expect("text");
    let mut lines = text.lines();
    let headers: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let number = |cell: &str| cell.parse::<f64>().expect("a number");
    let rows: Vec<Vec<f64>> = lines.map(|line| line.split(',').map(number).collect()).collect();
    for (at, header) in headers.iter().enumerate() {
        bytes.extend(vector(header, &rows.iter().map(|row| row[at]).collect::<Vec<_>>()));
    }
    one(k, "mat", bytes)
}

fn vector(name: &str, values: &[f64]) -> Vec<u8> {
    let rows = i32::try_from(values.len()).expect("a trial");
    let (class_of_doubles, data): (u32, Vec<u8>) =
        (6, values.iter().flat_map(|value| value.to_le_bytes()).collect());
    let mut content = element(6, &[class_of_doubles.to_le_bytes(), [0; 4]].concat());
    content.extend(element(5, &[rows.to_le_bytes(), 1_i32.to_le_bytes()].concat()));
    content.extend(element(1, name.as_bytes()));
    content.extend(element(9, &data));
    element(14, &content)
}

fn element(kind: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = kind.to_le_bytes().to_vec();
    bytes.extend(u32::try_from(data.len()).expect("short").to_le_bytes());
    bytes.extend(data);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

/// Fixes, heading, rate of turn, rudder, revolutions and velocities over the ground, all at once.
pub fn nmea(trial: &Trial, k: usize) -> Files {
    let mut log = String::new();
    for (at, t) in trial.t_s.iter().enumerate() {
        let value = |channel| trial.channel(channel).expect("a channel")[at];
        let deg = |channel| value(channel).to_degrees();
        let (x, y) = (value(Channel::X), value(Channel::Y));
        let (north, east) = (51.0 + x / 111_253.0, 3.0 + y / 70_250.0);
        let minutes = |angle: f64, width: usize| {
            format!("{:0width$.0}{:010.7}", angle.floor(), 60.0 * angle.fract())
        };
        let of_day = 9.0 * 3600.0 + t;
        let (hours, rest) = ((of_day / 3600.0).floor(), of_day % 3600.0);
        let time = format!("{hours:02.0}{:02.0}{:06.3}", (rest / 60.0).floor(), rest % 60.0);
        let (lat, lon) = (minutes(north, 2), minutes(east, 3));
        let knots = |channel| value(channel) / 0.514_444_444_444;
        for body in [
            format!("GPGGA,{time},{lat},N,{lon},E,1,8,1,1,M,1,M,,"),
            format!("HEHDT,{:.6},T", deg(Channel::Psi).rem_euclid(360.0)),
            format!("TIROT,{:.6},A", 60.0 * deg(Channel::R)),
            format!("AGRSA,{:.6},A,,V", deg(Channel::Delta)),
            format!("IIRPM,S,1,{:.6},100,A", 60.0 * value(Channel::N)),
            format!("VDVBW,,,V,{:.7},{:.7},A", knots(Channel::U), knots(Channel::V)),
        ] {
            let sum = body.bytes().fold(0, |sum, byte| sum ^ byte);
            log += &format!("${body}*{sum:02X}\r\n");
        }
    }
    one(k, "nmea", log.into_bytes())
}

/// Frames of NMEA 2000 as `candump -L` writes them, all values at once.
pub fn nmea2000(trial: &Trial, k: usize) -> Files {
    let mut log = String::new();
    for (at, t) in trial.t_s.iter().enumerate() {
        let value = |channel| trial.channel(channel).expect("a channel")[at];
        let (u, v, psi) = (value(Channel::U), value(Channel::V), value(Channel::Psi));
        let turn = std::f64::consts::TAU;
        let degrees = |first: f64, metres: f64, each: f64| {
            (((first + metres / each) * 1e7).round() as i32).to_le_bytes()
        };
        let word = |number: f64| (number.round() as i64 as u16).to_le_bytes();
        let angle = |radians: f64| word(1e4 * radians.rem_euclid(turn));
        let mut frame = |identifier: u32, parts: &[&[u8]]| {
            let data: String = parts.concat().iter().map(|byte| format!("{byte:02X}")).collect();
            log += &format!("({:.6}) can0 {identifier:08X}#{data}\n", 1_714_554_000.0 + t);
        };
        let (north, east) = (value(Channel::X), value(Channel::Y));
        frame(0x09F8_0123, &[&degrees(51.0, north, 111_253.0), &degrees(3.0, east, 70_250.0)]);
        frame(0x09F1_1223, &[&[0], &angle(psi), &[0xff, 0x7f, 0xff, 0x7f, 0xfc]]);
        let rate = ((value(Channel::R) / 3.125e-8).round() as i32).to_le_bytes();
        frame(0x09F1_1323, &[&[0], &rate, &[0xff; 3]]);
        let rudder = word(1e4 * value(Channel::Delta));
        frame(0x09F1_0D23, &[&[0, 0xff, 0xff, 0x7f], &rudder, &[0xff; 2]]);
        frame(0x09F2_0023, &[&[0], &word(240.0 * value(Channel::N)), &[0xff; 5]]);
        let course = angle(psi + v.atan2(u));
        frame(0x09F8_0223, &[&[0, 0xfc], &course, &word(100.0 * u.hypot(v)), &[0xff; 2]]);
    }
    one(k, "log", log.into_bytes())
}

/// Velocities and position in one file, heading and rudder in another at half the rate.
pub fn sensors(trial: &Trial, k: usize) -> Files {
    let motion = seconds("t [s]", trial).velocities(trial).position(trial);
    let mut slower = trial.clone();
    let halved = |values: &[f64]| values.iter().copied().step_by(2).collect::<Vec<_>>();
    slower.t_s = halved(&trial.t_s);
    slower.channels.values_mut().for_each(|values| *values = halved(values));
    let steering = seconds("t [s]", &slower).steering(&slower);
    vec![(format!("motion_{k}.csv"), motion.csv()), (format!("steering_{k}.csv"), steering.csv())]
}
