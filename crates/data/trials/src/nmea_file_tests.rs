#![allow(clippy::unwrap_used)]
use sistership_model::trial::Channel;

use super::*;
use crate::testing::finding_messages;

fn summed(body: &str) -> String {
    format!("${body}*{:02X}\r\n", body.bytes().fold(0, |sum, byte| sum ^ byte))
}

/// A fix each second over midnight, and two headings between; the rudder pauses.
fn log() -> String {
    let mut text = String::new();
    for k in 0..20 {
        let second = (86_390 + k) % 86_400;
        let (h, m, s) = (second / 3600, second / 60 % 60, second % 60);
        text += &summed(&format!(
            "GPGGA,{h:02}{m:02}{s:02}.00,5130.0{k:02},N,00930.000,E,1,8,1,1,M,1,M,,"
        ));
        text += &summed(&format!(
            "GPRMC,{h:02}{m:02}{s:02}.00,A,5130.0{k:02},N,00930.000,E,10,0,010524,,,A"
        ));
        text += &summed(&format!("HEHDT,{}.0,T", (355 + k) % 360));
        if !(8..14).contains(&k) {
            text += &summed("AGRSA,5.0,A,,V");
        }
        text += &summed(&format!("HEHDT,{}.5,T", (355 + k) % 360));
    }
    text
}

fn run(text: &str) -> (Option<Table>, String) {
    let mut findings = Findings::default();
    let table = read_nmea(text.as_bytes(), &Mapping::with_canonical_names(), &mut findings);
    (table, finding_messages(findings))
}

#[test]
fn sensors_meet_on_the_times_of_the_fixes_and_pauses_stay_gaps() {
    let (table, text) = run(&log());
    let table = table.unwrap();
    let of = |target| {
        let at = table.columns.iter().position(|column| column.target == target).unwrap();
        &table.values[at]
    };
    assert_eq!(table.start.as_ref().unwrap().text, "2024-05-01T23:59:50Z");
    let t = of(ColumnTarget::Time);
    assert!(t.windows(2).all(|pair| pair[0] < pair[1]) && t.contains(&18.0), "{t:?}");
    assert!(!t.contains(&10.0) && t.contains(&15.0), "{t:?} {text}");
    assert!(text.contains("AGRSA") && text.contains("which are skipped"), "{text}");
    let psi = of(ColumnTarget::Channel(Channel::Psi));
    assert!(psi.iter().all(|psi| psi.is_finite()));
    // Before the first heading, and before the rudder is back.
    assert_eq!(table.resumed.len(), 2);
}

#[test]
fn the_logs_own_time_goes_before_that_of_the_sentences() {
    let lines = (0..6).map(|k| format!("2024-05-01T12:00:0{k}.500,{}", summed("HEHDT,90.0,T")));
    let (table, text) = run(&lines.collect::<String>());
    let table = table.unwrap();
    assert_eq!(table.values[0], [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    assert_eq!(table.start.as_ref().unwrap().text, "2024-05-01T12:00:00.5");
    assert!(text.contains("before each sentence"), "{text}");
}

#[test]
fn damaged_and_timeless_sentences_are_counted() {
    let damaged = log().replace("355.0,T", "356.0,T");
    assert!(run(&damaged).1.contains("1 sentences skipped: their checksum"));
    let (table, text) = run(&summed("HEHDT,90.0,T"));
    assert!(table.is_none() && text.contains("there is no time"), "{text}");
    let mut mapping = Mapping::with_canonical_names();
    mapping.limits.rows = 10;
    let mut findings = Findings::default();
    assert!(read_nmea(log().as_bytes(), &mapping, &mut findings).is_none());
    assert!(finding_messages(findings).contains("more than 10 lines"));
}
