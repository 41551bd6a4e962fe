#![allow(clippy::unwrap_used)]
use std::fmt::Write as _;

use sistership_model::Trial;
use sistership_model::trial::Channel;

use super::*;
use crate::load::{check_path, load_path};
use crate::outcome::Refusal;

/// Trials of a file of 1000 rows, one a second, by entries of a manifest.
fn read(time: impl Fn(u32) -> String, header: &str, entries: &str) -> Vec<Result<Trial, Refusal>> {
    let mut text = format!("{header},u_m_s,delta_deg\n");
    (0..1000).for_each(|k| writeln!(text, "{},{},{}", time(k), 5 + k % 2, k % 7).unwrap());
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("log.csv"), text).unwrap();
    let manifest = format!("kind: trials\nship: a\ntrials:\n{entries}");
    std::fs::write(folder.path().join("m.yaml"), manifest).unwrap();
    load_path(&folder.path().join("m.yaml")).unwrap().trials
}

fn seconds(entries: &str) -> Vec<Result<Trial, Refusal>> {
    read(|k| k.to_string(), "t_s", entries)
}

fn ends(trial: &Result<Trial, Refusal>) -> (f64, f64) {
    let t_s = &trial.as_ref().unwrap().t_s;
    (t_s[0], t_s[t_s.len() - 1])
}

fn refused(trial: &Result<Trial, Refusal>) -> String {
    trial.as_ref().unwrap_err().to_string()
}

#[test]
fn stretches_are_read_from_one_file_in_the_order_of_the_manifest() {
    let entries = "  - { file: log.csv, from: 500, to: 600.5, manoeuvre: turn 35 }\n  \
                   - { file: ./log.csv, from: 900 }\n  - { file: log.csv, to: 99 }\n";
    let read = seconds(entries);
    let times: Vec<(f64, f64)> = read.iter().map(ends).collect();
    assert_eq!(times, [(500.0, 600.0), (900.0, 999.0), (0.0, 99.0)]);
    let first = read[0].as_ref().unwrap();
    assert_eq!((first.name.as_str(), first.len()), ("log.csv#t=500,600.5", 101));
    assert_eq!(first.channel(Channel::U).unwrap()[..2], [5.0, 6.0]);
    assert_eq!(first.manoeuvre.as_deref(), Some("turn 35"));
    assert!(!first.warnings.iter().any(|told| told.message.contains("starts at")));
}

#[test]
fn a_stretch_is_what_the_whole_file_has_there() {
    let whole = seconds("  - { file: log.csv }\n").remove(0).unwrap();
    let part = seconds("  - { file: log.csv, from: 250, to: 349 }\n").remove(0).unwrap();
    assert_eq!(part.t_s, whole.t_s[250..350]);
    for (channel, values) in &part.channels {
        assert_eq!(values[..], whole.channels[channel][250..350], "{channel}");
    }
}

#[test]
fn dates_and_times_of_day_name_a_stretch() {
    let clock = |k: u32| format!("{:02}:{:02}", (k / 60) % 60, k % 60);
    let dated = |k: u32| format!("2024-05-01T23:{}Z", clock(k + 3000).replace("66:", "06:"));
    let entries = "  - { file: log.csv, from: '2024-05-01T23:51:00Z', to: \
                   '2024-05-02T01:52:00+02:00' }\n  - { file: log.csv, from: '23:53:00', to: \
                   '23:54:00' }\n  - { file: log.csv, from: 300, to: 320 }\n";
    let only =
        |k: u32| if k < 600 { dated(k) } else { format!("2024-05-02T00:{}Z", clock(k - 600)) };
    let times: Vec<(f64, f64)> = read(only, "time", entries).iter().map(ends).collect();
    assert_eq!(times, [(60.0, 120.0), (180.0, 240.0), (300.0, 320.0)]);
    let undated = "  - { file: log.csv, from: '00:00:10', to: '00:00:20' }\n";
    let of_day = |k: u32| only(k)[11..19].to_owned();
    assert_eq!(ends(&read(of_day, "time", undated)[0]), (610.0, 620.0));
    let over =
        refused(&read(of_day, "time", &undated.replace("'00:00:10'", "2024-05-01T10:00:00"))[0]);
    assert!(over.contains("`from`") && over.contains("omit the date"), "{over}");
}

#[test]
fn a_stretch_that_is_not_there_names_entry_and_field() {
    for (entry, wanted) in [
        ("from: 2000, to: 3000", "`from`: 2000 s lies after the last row of the file, at 999 s"),
        ("from: -20, to: -10", "`to`: -10 s lies before the first row of the file, at 0 s"),
        ("from: 990, to: 1001", "`to`: 1001 s lies after the last row"),
        ("from: -1, to: 10", "`from`: -1 s lies before the first row"),
        ("from: 10.2, to: 10.8", "no row of the file lies between 10.2 s and 10.8 s"),
        ("from: '09:00:00'", "give seconds"),
    ] {
        let entries =
            format!("  - {{ file: log.csv, {entry} }}\n  - {{ file: log.csv, from: 700 }}\n");
        let read = seconds(&entries.replace(", from: 700", ", from: 700, to: 800"));
        let text = refused(&read[0]);
        assert!(text.starts_with("log.csv#t=") && text.contains(wanted), "{text}");
        assert_eq!(ends(&read[1]), (700.0, 800.0));
    }
    let text = refused(
        &read(
            |k| format!("05/01/2024 10:{:02}:{:02}", k / 60, k % 60),
            "time",
            "  - { file: log.csv, from: 10, to: 20 }\n",
        )[0],
    );
    assert!(text.contains("declare the unit of `t`"), "{text}");
    let text = read(
        |k| format!("2024-01-05 10:{:02}:{:02}", k / 60, k % 60),
        "time",
        "  - { file: log.csv, from: '10:01:00', to: '10:03:00' }\n  \
         - { file: log.csv, from: '2024-01-05 10:02:00', to: 200 }\n",
    );
    assert!(refused(&text[1]).contains("overlaps with `log.csv#t=10:01:00,10:03:00`"));
}

#[test]
fn manifests_refuse_what_is_wrong_without_the_file() {
    let refused = |entries: &str| {
        let text = format!("kind: trials\nship: a\ntrials:\n{entries}");
        crate::manifest::read_manifest_file("m.yaml", &text).unwrap_err().to_string()
    };
    let text = refused("  - { file: a.csv }\n  - { file: log.csv, from: 20, to: 10 }\n");
    assert!(
        text.starts_with("m.yaml:5: trials[1].from: `from` (20) must be before `to` (10)"),
        "{text}"
    );
    let text = refused("  - { file: a.csv, from: .nan }\n");
    assert!(text.contains("trials[0].from") && text.contains("finite"), "{text}");
    let text = refused("  - { file: a.csv, from: noon }\n");
    assert!(text.contains("`noon` is not a time"), "{text}");
    let text = refused("  - { file: a.csv, to: 10 }\n  - { file: a.csv, from: 9, to: 12 }\n");
    assert!(text.contains("trials[1].from: overlaps with `a.csv#t=,10`"), "{text}");
    assert!(refused("  - { file: a.csv, to: 10 }\n  - { file: a.csv }\n").contains("twice"));
}

#[test]
fn rows_outside_of_stretches_may_be_faulty_and_are_not_held() {
    let cell = |k: u32| if k == 50 { "x".to_owned() } else { k.to_string() };
    let entries = "  - { file: log.csv, from: 100, to: 300 }\n";
    assert_eq!(read(cell, "t_s", entries)[0].as_ref().unwrap().len(), 201);
    let folder = tempfile::tempdir().unwrap();
    let (mut text, path) = ("t_s,u_m_s\n".to_owned(), folder.path().join("log.csv"));
    (0..1000).for_each(|k| writeln!(text, "{k},{k}e-3").unwrap());
    std::fs::write(&path, text).unwrap();
    let mapping = |to: f64| crate::Mapping {
        limits: crate::FileLimits { rows: 100, ..crate::FileLimits::default() },
        stretch: Some(FileSegment { from: None, to: Some(FileTime::Seconds(to)) }),
        ..crate::Mapping::with_canonical_names()
    };
    let source = || crate::TrialFile::open("log.csv", &path).unwrap();
    assert!(crate::check_source(source(), &mapping(99.0)).is_accepted());
    let outcome = crate::check_source(source(), &mapping(100.0));
    assert!(outcome.errors[0].message.contains("more rows than the limit of 100"), "{outcome:?}");
    std::fs::write(
        folder.path().join("m.yaml"),
        "kind: trials\nship: a\ntrials:\n  \
        - { file: log.csv, to: 9 }\n  - { file: lost.csv, to: 9 }\n  - { file: lost.csv, from: 10 \
        }\n",
    )
    .unwrap();
    let outcomes = check_path(&folder.path().join("m.yaml")).unwrap();
    let accepted: Vec<bool> = outcomes.iter().map(|outcome| outcome.is_accepted()).collect();
    assert_eq!(accepted, [true, false, false]);
}
