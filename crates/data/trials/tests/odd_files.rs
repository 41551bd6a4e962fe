//! Files as strangers' programs write them: headers in two lines, decimal commas, UTF-16, comments,
//! degrees and minutes, times across midnight, one file a sensor.

#![allow(clippy::unwrap_used)]

use std::fmt::Write;
use std::path::{Path, PathBuf};

use sistership_model::manifest::{FileTime, ManifestTrial};
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

/// Imports files of a folder as they are: the trials that they give.
fn import_all(folder: &Path, files: &[PathBuf]) -> Vec<Trial> {
    let paths: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
    let request = ProposalRequest { ship: "", files: &paths, folder: Some(folder), given: &[] };
    let proposal = propose_files(&request).unwrap();
    let place = folder.join("trials.yaml");
    std::fs::write(&place, proposal.manifest.to_yaml().unwrap()).unwrap();
    load_path(&place).unwrap().trials.into_iter().map(|trial| trial.unwrap()).collect()
}

/// Imports files that are one trial.
fn import(folder: &Path, files: &[PathBuf]) -> Trial {
    let mut trials = import_all(folder, files);
    assert_eq!(trials.len(), 1);
    trials.remove(0)
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

/// Degrees and minutes in one number, as in NMEA 0183.
fn joined_minutes(degrees: f64, width: usize) -> String {
    format!("{:0width$}{:08.5}", degrees.floor(), 60.0 * degrees.fract())
}

/// Position of a run off Cape Town, from which south and east count; deg.
fn place_off_cape_town(run: &Zigzag, k: usize) -> (f64, f64) {
    (33.9 - run.x[k] / 110_925.0, 18.3 + run.y[k] / 92_516.0)
}

fn check_track(run: &Zigzag, trial: &Trial) {
    for (channel, truth) in [(Channel::X, &run.x), (Channel::Y, &run.y)] {
        let read = trial.channel(channel).unwrap();
        let made_good = read[ROWS - 1] - read[0];
        let wanted = truth[ROWS - 1] - truth[0];
        assert!((made_good - wanted).abs() < 2.0, "{channel:?}: {made_good} {wanted}");
    }
}

#[test]
fn units_and_hemispheres_in_every_cell() {
    let run = Zigzag::new();
    let row = |run: &Zigzag, k: usize| {
        let (south, east) = place_off_cape_town(run, k);
        let side = if run.delta[k] < 0.0 { "P" } else { "S" };
        vec![
            format!("{:.1}", run.t[k]),
            format!("{:.2} kn", 5.0 / KNOT),
            degrees(run.psi[k]) + "°",
            degrees(60.0 * run.r[k]) + " °/min",
            joined_minutes(south, 2) + " S",
            joined_minutes(east, 3) + " E",
            format!("{} {side}", degrees(run.delta[k].abs())),
            "92 rpm".into(),
        ]
    };
    let header = "Time,SOG,HDG,ROT,Latitude,Longitude,Rudder,RPM\n";
    let trial = import_one(run.table(header, row, ",").as_bytes());
    run.check(&trial);
    check_track(&run, &trial);
    assert!((trial.channel(Channel::R).unwrap()[100] - run.r[100]).abs() < 1e-5);
    assert!((trial.channel(Channel::N).unwrap()[100] - 92.0 / 60.0).abs() < 1e-9);
    assert!((trial.channel(Channel::U).unwrap()[100] - 5.0).abs() < 0.01);
}

#[test]
fn hemispheres_in_columns_of_their_own() {
    let run = Zigzag::new();
    let row = |run: &Zigzag, k: usize| {
        let (south, east) = place_off_cape_town(run, k);
        vec![
            format!("{:.1}", run.t[k]),
            joined_minutes(south, 2),
            "S".into(),
            joined_minutes(east, 3),
            "E".into(),
            degrees(run.psi[k]),
            degrees(run.delta[k]),
        ]
    };
    let header = "Time (s),Lat,N/S,Lon,E/W,Heading (deg),Rudder (deg)\n";
    let trial = import_one(run.table(header, row, ",").as_bytes());
    run.check(&trial);
    check_track(&run, &trial);
}

/// Workbook of sheets of lines with tabs, as an Excel file.
fn workbook(sheets: &[(&str, String)]) -> Vec<u8> {
    const MAIN: &str = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
    const KINDS: &str = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
    const PACKAGE: &str = "http://schemas.openxmlformats.org/package/2006/relationships";
    let relation = |id: usize, kind: &str, target: &str| {
        format!(r#"<Relationship Id="r{id}" Type="{KINDS}/{kind}" Target="{target}"/>"#)
    };
    let relations =
        |all: String| format!(r#"<Relationships xmlns="{PACKAGE}">{all}</Relationships>"#);
    let (mut listed, mut related) = (String::new(), String::new());
    let mut files = vec![(
        "_rels/.rels".to_owned(),
        relations(relation(1, "officeDocument", "xl/workbook.xml")),
    )];
    for (id, (name, text)) in (1..).zip(sheets) {
        listed += &format!(r#"<sheet name="{name}" sheetId="{id}" r:id="r{id}"/>"#);
        related += &relation(id, "worksheet", &format!("sheet{id}.xml"));
        let cell = |cell: &str| match cell.parse::<f64>() {
            Ok(_) => format!("<c><v>{cell}</v></c>"),
            Err(_) => format!(r#"<c t="inlineStr"><is><t>{cell}</t></is></c>"#),
        };
        let row =
            |line: &str| format!("<row>{}</row>", line.split('\t').map(cell).collect::<String>());
        let rows: String = text.lines().map(row).collect();
        let sheet =
            format!(r#"<worksheet xmlns="{MAIN}"><sheetData>{rows}</sheetData></worksheet>"#);
        files.push((format!("xl/sheet{id}.xml"), sheet));
    }
    let book = format!(
        r#"<workbook xmlns="{MAIN}" xmlns:r="{KINDS}"><sheets>{listed}</sheets></workbook>"#
    );
    files.push(("xl/workbook.xml".to_owned(), book));
    files.push(("xl/_rels/workbook.xml.rels".to_owned(), relations(related)));
    let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, text) in files {
        zip.start_file(name, zip::write::SimpleFileOptions::default()).unwrap();
        std::io::Write::write_all(&mut zip, text.as_bytes()).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

#[test]
fn each_sheet_with_a_table_is_a_trial() {
    let run = Zigzag::new();
    let row = |run: &Zigzag, k: usize| {
        let angles = [run.psi[k], run.r[k], run.delta[k]].map(degrees);
        [format!("{:.1}", run.t[k]), "5.0".into()].into_iter().chain(angles).collect()
    };
    let table = run.table(
        "Time [s]\tSurge [m/s]\tHeading [deg]\tRate of turn [deg/s]\tRudder [deg]\n",
        row,
        "\t",
    );
    let sheets = [
        ("About", "Item\tText\tBy\tSeen\n".to_owned() + &"Rudder\t35 deg\tyard\tyes\n".repeat(30)),
        ("Zigzag 10", table.clone()),
        ("Zigzag 20", table),
    ];
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("trials.xlsx");
    std::fs::write(&file, workbook(&sheets)).unwrap();
    let trials = import_all(folder.path(), &[file]);
    let names: Vec<&str> = trials.iter().map(|trial| trial.name.as_str()).collect();
    assert_eq!(names, ["trials.xlsx#part=Zigzag 10", "trials.xlsx#part=Zigzag 20"]);
    trials.iter().for_each(|trial| run.check(trial));
}

/// HDF5 file with a group of that name for each run.
fn groups(names: &[&str], run: &Zigzag) -> Vec<u8> {
    use hdf5_writer::{DatasetBuilder, Hdf5Builder, WriteOptions};
    let speed = vec![5.0; ROWS];
    let mut file = Hdf5Builder::new();
    for name in names {
        let columns = [
            ("time", &run.t),
            ("u", &speed),
            ("x", &run.x),
            ("y", &run.y),
            ("psi", &run.psi),
            ("r", &run.r),
            ("rudder", &run.delta),
        ];
        for (column, values) in columns {
            let path = format!("{name}/{column}");
            file =
                file.dataset(DatasetBuilder::typed_data(path, vec![ROWS as u64], values).unwrap());
        }
    }
    file.into_plan().unwrap().encode(WriteOptions::default()).unwrap()
}

#[test]
fn each_group_with_a_time_of_its_own_is_a_trial() {
    let run = Zigzag::new();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("trials.h5");
    std::fs::write(&file, groups(&["zigzag 10", "zigzag 20"], &run)).unwrap();
    let trials = import_all(folder.path(), &[file]);
    let names: Vec<&str> = trials.iter().map(|trial| trial.name.as_str()).collect();
    assert_eq!(names, ["trials.h5#part=zigzag 10", "trials.h5#part=zigzag 20"]);
    trials.iter().for_each(|trial| run.check(trial));
    // A part is named on the command line as in a manifest.
    let part = folder.path().join("trials.h5#part=zigzag 11");
    let text = format!("{:?}", load_path(&part).unwrap().trials.remove(0).unwrap_err());
    assert!(text.contains("no part `zigzag 11` (zigzag 10, zigzag 20)"), "{text}");
}

#[test]
fn the_only_group_of_a_file_gives_no_column_its_name() {
    let run = Zigzag::new();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("trial.h5");
    // `log.u` is the speed over ground, not that of a log.
    std::fs::write(&file, groups(&["log"], &run)).unwrap();
    let trial = import(folder.path(), &[file]);
    assert_eq!(trial.name, "trial.h5");
    assert!(trial.channel(Channel::U).is_some(), "{:?}", trial.channels.keys());
    run.check(&trial);
}

#[test]
fn a_part_of_a_file_without_parts_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let csv = "t_s,u_m_s,delta_rad\n0,1,0\n1,1,0\n";
    std::fs::write(folder.path().join("a.csv"), csv).unwrap();
    let manifest = "kind: trials\ntrials:\n  - { file: \"a.csv#part=Run 1\" }\n";
    let place = folder.path().join("trials.yaml");
    std::fs::write(&place, manifest).unwrap();
    let read = load_path(&place).unwrap().trials.remove(0);
    let text = format!("{:?}", read.unwrap_err());
    assert!(text.contains("has no parts; remove `#part=NAME`"), "{text}");
}

#[test]
fn trials_side_by_side_are_refused_with_their_columns() {
    let run = Zigzag::new();
    let row = |run: &Zigzag, k: usize| {
        let one = [format!("{:.1}", run.t[k]), degrees(run.psi[k]), degrees(run.delta[k])];
        [one.clone(), one].concat()
    };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("both.csv");
    std::fs::write(&file, run.table("t_1,psi_1,delta_1,t_2,psi_2,delta_2\n", row, ",")).unwrap();
    let request = ProposalRequest { ship: "", files: &[&file], folder: None, given: &[] };
    let refused = propose_files(&request).unwrap_err();
    let message = &refused[0].message;
    assert!(
        message.contains("2 trials side by side") && message.contains("t_2, psi_2"),
        "{message}"
    );
}

#[test]
fn a_segment_of_a_sheet_is_named_by_both() {
    let segment = ManifestTrial {
        from: Some(FileTime::Seconds(60.0)),
        ..ManifestTrial::from_file_name("a.xlsx#part=Run 2")
    };
    assert_eq!(segment.trial_label(), "a.xlsx#part=Run 2&t=60,");
    assert_eq!(segment.file_path(), "a.xlsx");
}

#[test]
fn each_file_derives_what_it_does_not_have() {
    let run = Zigzag::new();
    let row = |run: &Zigzag, k: usize| {
        let place = [run.t[k], run.x[k], run.y[k]].map(|value| format!("{value:.3}"));
        place.into_iter().chain([run.psi[k], run.delta[k]].map(degrees)).collect::<Vec<_>>()
    };
    let over_ground = |run: &Zigzag, k: usize| {
        [row(run, k), vec![degrees(run.psi[k]), format!("{:.3}", 5.0 / KNOT)]].concat()
    };
    let header = "time [s],x [m],y [m],heading [deg],rudder [deg]";
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: String| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let both = format!("{header},COG [deg],SOG [kn]\n");
    let files = [
        write("ground.csv", run.table(&both, over_ground, ",")),
        write("track.csv", run.table(&format!("{header}\n"), row, ",")),
    ];
    let trials = import_all(folder.path(), &files);
    assert_eq!(trials.len(), 2);
    for trial in trials {
        let u = trial.channel(Channel::U).unwrap_or_else(|| panic!("{}", trial.name));
        assert!((u[300] - 5.0).abs() < 0.05, "{}: {}", trial.name, u[300]);
    }
}
