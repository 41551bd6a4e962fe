//! Small uploads say as much together as one large one.

use sistership_diagnosis::{Diagnosis, Settings, Verdict};
use sistership_tests::hidden_effects::baseline::{BASELINE, diagnosed};
use sistership_tests::hidden_effects::sequence::{Uploads, effect_names, in_sequence};

fn offset_evidence(diagnosis: &Diagnosis) -> f64 {
    let offset = diagnosis.effects.iter().find(|found| found.name == "rudder-offset");
    offset.map_or(0.0, |found| found.evidence)
}

/// Evidence for an offset that a single trial hardly shows adds up, from its first trial on.
#[test]
fn evidence_for_a_small_offset_adds_up() {
    let uploads = Uploads { count: 8, first: 3, offset_rad: 0.03_f64.to_radians() };
    let trials = uploads.trials(1);
    let all = in_sequence(&trials);
    let named: Vec<Vec<&str>> = all.iter().map(effect_names).collect();
    println!("{named:?}");
    assert!(!named[..2].concat().contains(&"rudder-offset"), "{named:?}");
    let alone = diagnosed(&BASELINE, &trials[7..], &Settings::default());
    let (alone, sequence) = (offset_evidence(&alone), offset_evidence(&all[7]));
    assert!(sequence > 3.0 * alone.max(1.0), "{sequence} in sequence, {alone} alone");
    let history = all[7].history.as_ref().unwrap();
    let offset = history.forms.iter().find(|form| form.key == "rudder-offset/constant").unwrap();
    assert_eq!(offset.last_seen.as_deref(), Some("upload 8"));
    assert!(offset.trials < 8, "{offset:?}");

    // A trial that is given again does not count again.
    let after = |upload: usize| Settings { earlier: all[upload].history.clone(), ..<_>::default() };
    let with_known = diagnosed(&BASELINE, &trials[6..], &after(6));
    assert_eq!(offset_evidence(&with_known), sequence);
    assert!(with_known.remarks.iter().any(|told| told.ends_with("twice: upload 7")));
    let known = diagnosed(&BASELINE, &trials[7..], &after(7));
    assert_eq!(known.history, all[7].history);
    assert_eq!(offset_evidence(&known), alone);
}

/// A sound trial after those of a damaged ship is not unexplained, nothing that resembles the damage is
/// named in its place, and the count of its trials begins again.
#[test]
fn trials_after_a_repair_name_nothing() {
    let damaged = Uploads { count: 2, first: 1, offset_rad: 3.0_f64.to_radians() };
    let before = diagnosed(&BASELINE, &damaged.trials(1), &Settings::default());
    assert_eq!(effect_names(&before), ["rudder-offset"]);
    let sound = Uploads { count: 1, first: 2, ..damaged }.trials(20);
    let settings = Settings { earlier: before.history, ..Settings::default() };
    let after = diagnosed(&BASELINE, &sound, &settings);
    assert_eq!((after.verdict, effect_names(&after)), (Verdict::Complete, Vec::new()));
    let history = after.history.unwrap();
    let offset = history.forms.iter().find(|form| form.key == "rudder-offset/constant").unwrap();
    assert_eq!(offset.trials, 1, "{offset:?}");
}
