//! What begins within a trial is found with its time.

use sistership_diagnosis::{ChangeCourse, DiagnosisInputs, Settings, Verdict, diagnose};
use sistership_model::Trial;

use sistership_tests::hidden_effects::baseline::{BASELINE, library};
use sistership_tests::hidden_effects::cases::programme;
use sistership_tests::hidden_effects::truth::{Hidden, Unlisted, trials};

/// Half time of the trials, s.
const BEGINS_S: f64 = 325.0;

#[test]
fn lost_thrust_is_dated_and_named_a_resistance_or_a_propeller() {
    let lost = Some(Unlisted::ThrustLoss { share: 0.3 });
    let whole = trials(&Hidden::default(), &programme(), 31);
    let hidden = trials(&Hidden { unlisted: lost, ..Hidden::default() }, &programme(), 32);
    // One trial of six.
    let sailed: Vec<&Trial> = hidden.iter().take(1).chain(whole.iter().skip(1)).collect();
    let (settings, effects) = (Settings::default(), library());
    let request = DiagnosisInputs {
        model: &BASELINE.model,
        law: &BASELINE.law,
        effects: &effects,
        trials: &sailed,
        settings: &settings,
    };
    let diagnosis = diagnose(&request, &|_, _| true).unwrap();
    println!("{:?} {:?} {:?}", diagnosis.verdict, diagnosis.unexplained, diagnosis.changes);
    assert_eq!(diagnosis.verdict, Verdict::Unexplained);
    let [change] = diagnosis.changes.as_slice() else { panic!("{:?}", diagnosis.changes) };
    assert_eq!((change.trial.as_str(), change.course), (&*sailed[0].name, ChangeCourse::Begins));
    assert!(["extra-resistance", "propeller-damage"].contains(&change.effect.as_str()));
    let ([first, last], at_s) = (change.between_s.unwrap(), change.at_s.unwrap());
    assert!((at_s - BEGINS_S).abs() < 15.0 && first < at_s && at_s < last, "{change:?}");
}
