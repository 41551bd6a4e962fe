//! Small uploads say as much together as one large one.

use sistership_diagnosis::{Diagnosis, Settings};
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
}
