//! Files as strangers' programs write them: headers in two lines, decimal commas, UTF-16, comments,
//! degrees and minutes, times across midnight, one file a sensor.

#![allow(clippy::unwrap_used)]

use std::fmt::Write;
use std::path::{Path, PathBuf};

use sistership_model::trial::{Channel, Trial};
use sistership_trials::{ProposalRequest, load_path, propose_files};

const STEP_S: f64 = 0.5;
const ROWS: usize = 600;
const KNOT: f64 = 1852.0 / 3600.0;

/// A zigzag of a ship of 5 m/s by Nomoto's equation of first order.
#[derive(Default)]
struct Zigzag {
    t: Vec<f64>,
    x: Vec<f64>,
    y: Vec<f64>,
    psi: Vec<f64>,
    r: Vec<f64>,
    delta: Vec<f64>,
}

impl Zigzag {
    fn new() -> Self {
        let mut run = Self::default();
        let (mut x, mut y, mut psi, mut r, mut delta, mut side) = (0.0, 0.0, 0.4, 0.0, 0.0, 1.0);
        for k in 0..ROWS {
            run.t.push(STEP_S * k as f64);
            for (column, value) in [
                (&mut run.x, x),
                (&mut run.y, y),
                (&mut run.psi, psi),
                (&mut run.r, r),
                (&mut run.delta, delta),
            ] {
                column.push(value);
            }
            side = if side * (psi - 0.4) > 0.35 { -side } else { side };
            delta += (0.35 * side - delta).clamp(-0.04, 0.04);
            r += STEP_S * (0.12 * delta - r) / 8.0;
            psi += STEP_S * r;
            x += STEP_S * 5.0 * psi.cos();
            y += STEP_S * 5.0 * psi.sin();
        }
        run
    }

    /// Lines of cells, each written by the row's index.
    fn table(&self, header: &str, row: impl Fn(&Self, usize) -> Vec<String>, by: &str) -> String {
        let mut text = header.to_owned();
        for k in 0..ROWS {
            writeln!(text, "{}", row(self, k).join(by)).unwrap();
        }
        text
    }

    fn check(&self, trial: &Trial) {
        for (channel, truth, within) in
            [(Channel::Psi, &self.psi, 2e-3), (Channel::Delta, &self.delta, 2e-3)]
        {
            let read = trial.channel(channel).unwrap();
            assert_eq!(read.len(), ROWS, "{channel:?}");
            for (k, (read, truth)) in read.iter().zip(truth).enumerate() {
                assert!((read - truth).abs() < within, "{channel:?} {k}: {read} {truth}");
            }
        }
        assert!((trial.t_s[ROWS - 1] - trial.t_s[0] - self.t[ROWS - 1]).abs() < 1e-6);
    }
}

fn degrees(angle: f64) -> String {
    format!("{:.3}", angle.to_degrees())
}

/// Imports files of a folder as they are: the one trial that they give.
fn import(folder: &Path, files: &[PathBuf]) -> Trial {
    let paths: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
    let request = ProposalRequest { ship: "", files: &paths, folder: Some(folder), given: &[] };
    let proposal = propose_files(&request).unwrap();
    let place = folder.join("trials.yaml");
    std::fs::write(&place, proposal.manifest.to_yaml().unwrap()).unwrap();
    let trials = load_path(&place).unwrap().trials;
    assert_eq!(trials.len(), 1);
    trials.into_iter().next().unwrap().unwrap()
}

fn import_one(bytes: &[u8]) -> Trial {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("run.txt");
    std::fs::write(&file, bytes).unwrap();
    import(folder.path(), &[file])
}

#[test]
fn names_in_two_lines_with_units_below() {
    let run = Zigzag::new();
    let header = "Sea trial 7\t\t\t\t\t\nTime\tPosition\t\tHeading\tSteering\tYaw\n\
                  \tNorth\tEast\t\tRudder\t\n[s]\t[m]\t[m]\t[deg]\t[deg]\t[deg/s]\n";
    let row = |run: &Zigzag, k: usize| {
        let place = [run.t[k], run.x[k], run.y[k]].map(|value| format!("{value:.3}"));
        let angles = [run.psi[k], run.delta[k], run.r[k]].map(degrees);
        place.into_iter().chain(angles).collect()
    };
    let trial = import_one(run.table(header, row, "\t").as_bytes());
    run.check(&trial);
    assert!((trial.channel(Channel::R).unwrap()[100] - run.r[100]).abs() < 1e-4);
    assert!((trial.channel(Channel::Y).unwrap()[100] - run.y[100]).abs() < 0.01);
}

#[test]
fn decimal_commas_in_latin_1_and_a_rudder_to_port() {
    let run = Zigzag::new();
    let header = "Probefahrt;03.05.2024\n\nZeit [s];Kurs [\u{b0}];Drehrate [\u{b0}/min];\
                  Ruderlage [\u{b0}] (Bb +);Fahrt \u{fc}ber Grund [kn]\n";
    let row = |run: &Zigzag, k: usize| {
        let cells = [
            format!("{:.1}", run.t[k]),
            degrees(run.psi[k]),
            degrees(60.0 * run.r[k]),
            degrees(-run.delta[k]),
            format!("{:.3}", 5.0 / KNOT),
        ];
        cells.map(|cell| cell.replace('.', ",")).to_vec()
    };
    let text = run.table(header, row, ";");
    let bytes: Vec<u8> = text.chars().map(|letter| letter as u8).collect();
    run.check(&import_one(&bytes));
}

#[test]
fn utf_16_as_excel_saves_it() {
    let run = Zigzag::new();
    let row = |run: &Zigzag, k: usize| {
        vec![
            format!("{:.1}", run.t[k]),
            degrees(run.psi[k]),
            "5.0".into(),
            degrees(run.r[k]),
            degrees(run.delta[k]),
        ]
    };
    let header = "Time [s]\tHeading [°]\tSurge [m/s]\tRate of turn [°/s]\tRudder [°]\n";
    let text = format!("\u{feff}{}", run.table(header, row, "\t"));
    let bytes: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    run.check(&import_one(&bytes));
}

#[test]
fn a_header_in_comments_above_columns_of_blanks() {
    let run = Zigzag::new();
    let header =
        "% Free running test 4\n%  time  psi   u   r   delta\n% (s) (deg) (m/s) (deg/s) (deg)\n";
    let row = |run: &Zigzag, k: usize| {
        let angles = [run.psi[k], run.r[k], run.delta[k]].map(degrees);
        let [psi, r, delta] = angles.map(|angle| format!("{angle:>9}"));
        vec![format!(" {:8.2}", run.t[k]), psi, "  5.000".into(), r, delta]
    };
    let trial = import_one(run.table(header, row, " ").as_bytes());
    run.check(&trial);
    assert!((trial.channel(Channel::U).unwrap()[5] - 5.0).abs() < 1e-9);
}

#[test]
fn degrees_and_minutes_and_signs_of_degrees_in_cells() {
    let run = Zigzag::new();
    let minutes = |degrees: f64| format!("{}°{:08.5}'", degrees.floor(), 60.0 * degrees.fract());
    let row = |run: &Zigzag, k: usize| {
        let latitude = 34.0 + run.x[k] / 110_930.0;
        let longitude = 135.0 + (run.y[k] + 300.0) / 92_384.0;
        vec![
            format!("{:.1}", run.t[k]),
            minutes(latitude) + "N",
            minutes(longitude) + "E",
            degrees(run.psi[k]) + "°",
            degrees(run.delta[k]) + "°",
        ]
    };
    let trial = import_one(run.table("Time;Lat;Lon;Heading;Rudder\n", row, ";").as_bytes());
    run.check(&trial);
    let x = trial.channel(Channel::X).unwrap();
    assert!((x[ROWS - 1] - x[0] - run.x[ROWS - 1]).abs() < 2.0, "{}", x[ROWS - 1] - x[0]);
}

#[test]
fn times_of_day_across_midnight() {
    let run = Zigzag::new();
    let clock = |t: f64| {
        let s = (86_340.0 + t).rem_euclid(86_400.0);
        format!("{:02}:{:02}:{:04.1}", (s / 3600.0) as u32, (s / 60.0) as u32 % 60, s % 60.0)
    };
    let row = |run: &Zigzag, k: usize| {
        let angles = [run.psi[k], 60.0 * run.r[k], run.delta[k]].map(degrees);
        [clock(run.t[k]), "9.719".into()].into_iter().chain(angles).collect()
    };
    let header = "Local time,SOG (kn),Heading (deg),ROT (deg/min),\"Rudder (deg, +ve to stbd)\"\n";
    run.check(&import_one(run.table(header, row, ",").as_bytes()));
}

#[test]
fn a_folder_with_a_file_a_sensor() {
    let run = Zigzag::new();
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: String| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let gyro = |run: &Zigzag, k: usize| {
        vec![format!("{:.1}", run.t[k]), degrees(run.psi[k]), degrees(60.0 * run.r[k])]
    };
    let log = |run: &Zigzag, k: usize| vec![format!("{:.1}", run.t[k]), "5.00".into()];
    // The name of the rudder has a comma, and its cells are separated by semicolons.
    let rudder = |run: &Zigzag, k: usize| vec![format!("{:.1}", run.t[k]), degrees(-run.delta[k])];
    let files = [
        write("gyro.csv", run.table("time_s,heading_deg,rot_deg_min\n", gyro, ",")),
        write("log.csv", run.table("time_s,surge_m_s\n", log, ",")),
        write("rudder.csv", run.table("time_s;rudder angle (deg, port positive)\n", rudder, ";")),
    ];
    run.check(&import(folder.path(), &files));
}
