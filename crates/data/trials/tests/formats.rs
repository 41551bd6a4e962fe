//! Files as people have them, from their bytes to a trial.
#![allow(clippy::unwrap_used)]

use bytes::Bytes;
use sistership_model::trial::{Channel, Trial};
use sistership_trials::{
    Antenna, Derivable, Mapping, TrialFile, check_source, read_in_full, read_trial,
};

fn summed(body: &str) -> String {
    format!("${body}*{:02X}\r\n", body.bytes().fold(0, |sum, byte| sum ^ byte))
}

fn minutes(degrees: f64) -> String {
    format!("{:02}{:010.7}", degrees.floor(), 60.0 * degrees.fract())
}

/// A circle at 5 m/s with 0.02 rad/s, its antenna 10 m before midship, at 1 Hz.
fn nmea() -> String {
    let mut text = String::new();
    for k in 0..300 {
        let (psi, radius) = (0.02 * f64::from(k), 250.0);
        let (x, y) =
            (radius * psi.sin() + 10.0 * psi.cos(), radius * (1.0 - psi.cos()) + 10.0 * psi.sin());
        let latitude = 51.0 + x / 111_253.0;
        let longitude = 3.0 + y / (111_412.0 * 51.0_f64.to_radians().cos() * 1.001_35);
        let at = format!("12{:02}{:02}.00", k / 60, k % 60);
        let place = format!("{},N,0{},E", minutes(latitude), minutes(longitude));
        text += &summed(&format!("GPGGA,{at},{place},1,8,1,1,M,1,M,,"));
        text += &summed(&format!("GPRMC,{at},A,{place},,,010524,,,A"));
        text += &summed(&format!("HEHDT,{:.2},T", psi.to_degrees().rem_euclid(360.0)));
        text += &summed(&format!("AGRSA,{:.1},A,,V", 10.0 + 0.1 * f64::from(k % 2)));
    }
    text
}

fn derived() -> Mapping {
    let mut mapping = Mapping::with_canonical_names();
    mapping.declared.antenna = Some(Antenna { x_m: 10.0, y_m: 0.0 });
    mapping.declared.derive = vec![Derivable::U, Derivable::V, Derivable::R];
    mapping
}

fn middle(trial: &Trial, channel: Channel) -> f64 {
    trial.channel(channel).unwrap()[trial.len() / 2]
}

#[test]
fn a_log_of_a_circle_gives_its_velocities() {
    let source = TrialFile::from_bytes("circle.nmea", Bytes::from(nmea()));
    let reading = read_in_full(source, &derived()).unwrap();
    assert_eq!(reading.start.as_deref(), Some("2024-05-01T12:00:00Z"));
    let trial = &reading.trial;
    assert!((middle(trial, Channel::U) - 5.0).abs() < 0.05, "{}", middle(trial, Channel::U));
    assert!(middle(trial, Channel::V).abs() < 0.05, "{}", middle(trial, Channel::V));
    assert!((middle(trial, Channel::R) - 0.02).abs() < 1e-3);
    assert_eq!(reading.derived.len(), 3);
    for derived in &reading.derived {
        assert_eq!(derived.variance.len(), trial.len());
        assert!(derived.variance.iter().all(|variance| variance.is_finite() && *variance >= 0.0));
    }
    let told = |text: &str| trial.warnings.iter().any(|told| told.message.contains(text));
    assert!(told("derived from positions and heading") && told("first fix"));
}

#[test]
fn a_binary_file_is_named_as_what_it_is() {
    for (bytes, wanted) in [
        (&b"\x89PNG\r\n\x1a\n"[..], "a picture (PNG)"),
        (b"\x89HDF\r\n\x1a\n", "HDF5"),
        (b"MATLAB 7.3 MAT-file", "the HDF5 file cannot be read"),
        (b"PK\x03\x04\x14\0\0\0", "damaged"),
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", ".xlsx"),
    ] {
        let source = TrialFile::from_bytes("a.csv", Bytes::copy_from_slice(bytes));
        let text = read_trial(source, &Mapping::with_canonical_names()).unwrap_err().to_string();
        assert!(text.contains(wanted), "{text}");
    }
}

/// Numbers that follow from each other, for the same damage at every run.
fn next(seed: &mut u64) -> usize {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    usize::try_from(*seed >> 33).unwrap()
}

#[test]
fn damaged_files_neither_panic_nor_give_what_is_no_trial() {
    let csv = "Ship\n\nDate/Time;latitude_deg;longitude_deg;psi_deg;n_s_rpm;speed_kn;course_deg\n\
               ;deg;deg;deg;rpm;kn;deg\n05/13/2024 12:00:00 PM;51,0;3;10;1;2;3\n\
               05/13/2024 12:00:01 PM;51,0;3;10;;2;3\n12/31/9999 11:59:59 PM;51;3;10;1;2;3\n\
               05/14/2024 12:00:02 AM;51,1;3;10;1;2;3\n";
    let mut seed = 1;
    for text in [csv.to_owned(), nmea()[..2000].to_owned()] {
        for _ in 0..3000 {
            let mut bytes = text.clone().into_bytes();
            for _ in 0..=next(&mut seed) % 4 {
                let at = next(&mut seed) % bytes.len();
                match next(&mut seed) % 3 {
                    0 => bytes[at] = b"0123456789:/.-;,\n$*\xff"[next(&mut seed) % 20],
                    1 => bytes.truncate(at.max(1)),
                    _ => bytes[at] ^= 1 << (next(&mut seed) % 8),
                }
            }
            let source = TrialFile::from_bytes("a", Bytes::from(bytes));
            if let Ok(trial) = read_trial(source, &derived()) {
                assert!(trial.t_s.windows(2).all(|pair| pair[0] < pair[1]));
                let all = trial.channels.values().flatten();
                assert!(all.into_iter().all(|value| value.is_finite()));
                assert!(trial.channels.values().all(|values| values.len() == trial.len()));
            }
        }
    }
}

#[test]
fn a_clock_that_alternates_ends() {
    let rows = (0..200_000).map(|k| if k % 2 == 0 { "23:59:59,1,1\n" } else { "00:00:00,1,1\n" });
    let text: String = std::iter::once("time,u_m_s,v_m_s\n").chain(rows).collect();
    let outcome = check_source(TrialFile::from_csv("a", text.as_bytes()), &derived());
    assert_eq!(outcome.rows, 200_000);
}

#[test]
fn numbers_beyond_all_bounds_are_refused() {
    let mut mapping = derived();
    let column =
        |column: &str, unit: &str| sistership_model::manifest::ColumnMapping::new(column, unit);
    mapping.columns = vec![("t".into(), column("day", "excel"))];
    for (rows, count) in [("1e308", 20), ("1e300", 20), ("1e-320", 20)] {
        let rows: String =
            (0..count).map(|k| format!("{k}{rows},{k},1,0.1\n")).collect::<Vec<_>>().concat();
        let text = format!("day,x_m,y_m,psi_rad\n{rows}");
        assert!(read_trial(TrialFile::from_csv("a", text.as_bytes()), &mapping).is_err());
    }
    let tiny: String = (0..20).map(|k| format!("{k}e-310,{k},1,0.1\n")).collect();
    let text = format!("t_s,x_m,y_m,psi_rad\n{tiny}");
    if let Ok(trial) = read_trial(TrialFile::from_csv("a", text.as_bytes()), &derived()) {
        assert!(trial.channels.values().flatten().all(|value| value.is_finite()));
    }
}
