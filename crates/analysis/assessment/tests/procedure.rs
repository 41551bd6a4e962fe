//! A validation of a model by trials that it sailed itself, and by those of another ship.
#![allow(clippy::unwrap_used)]

use sistership_assessment::validation::{TrialOfShip, Validation, Verdict, validate};
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Model, Zoo};
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_turn, simulate_zigzag};
use sistership_simulation::state::{RECORDED_CHANNELS, Trajectory, at};

/// A record of a track by instruments that show lengths and headings wrong by a share.
fn record(name: &str, track: &Trajectory, wrong: f64) -> Trial {
    let columns = RECORDED_CHANNELS[..6].iter().chain(&[(Channel::Delta, at::DELTA)]);
    let shown = |channel: Channel, values: Vec<f64>| match channel {
        Channel::X | Channel::Y | Channel::Psi => {
            values.into_iter().map(|value| value * (1.0 + wrong)).collect()
        }
        _ => values,
    };
    let channels = columns
        .map(|&(channel, place)| (channel, shown(channel, track.state_column(place))))
        .collect();
    Trial {
        name: format!("{name} {wrong}"),
        manoeuvre: Some(name.to_owned()),
        t_s: track.t_s.clone(),
        channels,
        ..Trial::default()
    }
}

/// Three turns and three zigzags of a model, each after a straight run.
fn trials(zoo: &Zoo, model: &Model) -> Vec<Trial> {
    let ship = Ship::new(model, zoo.law(&model.law).unwrap()).unwrap();
    let settings = ManoeuvreSettings {
        run_in_s: 10.0,
        duration_s: Some(500.0),
        step_s: Some(0.5),
        ..ManoeuvreSettings::default()
    };
    let turned = simulate_turn(&ship, 35.0, &settings).unwrap().track;
    let swung = simulate_zigzag(&ship, 20.0, 20.0, &settings).unwrap().track;
    let wrong = [0.005, -0.006, 0.002];
    let turns = wrong.map(|wrong| record("turn", &turned, wrong));
    turns.into_iter().chain(wrong.map(|wrong| record("zigzag 20/20", &swung, wrong))).collect()
}

fn mariner(zoo: &Zoo, rudder: f64) -> Model {
    let mut model = zoo.find_model("mariner").unwrap();
    for name in ["Y_delta", "N_delta"] {
        model.coefficients.get_mut(name).unwrap().value *= rudder;
    }
    model
}

fn validated(
    zoo: &Zoo,
    model: &Model,
    trials: &[Trial],
    draws: &[Model],
    fitted: bool,
) -> Validation {
    let of_ship: Vec<TrialOfShip<'_>> =
        trials.iter().map(|trial| TrialOfShip { name: &trial.name, trial, fitted }).collect();
    let vessel = zoo.vessel("mariner").unwrap();
    validate(vessel, model, zoo.law(&model.law).unwrap(), draws, &of_ship).unwrap()
}

fn recorded(of: &Validation) -> Vec<(&str, Verdict, f64)> {
    let known = of.quantities.iter().filter(|one| one.records.is_some());
    known
        .map(|one| (one.quantity.as_str(), one.verdict, one.comparison_error_percent.unwrap()))
        .collect()
}

#[test]
fn a_model_is_validated_by_its_own_trials_and_not_by_those_of_a_ship_with_a_weaker_rudder() {
    let zoo = Zoo::load_embedded().unwrap();
    let own = mariner(&zoo, 1.0);
    let trials_of = |rudder| trials(&zoo, &mariner(&zoo, rudder));
    let draws = [0.999, 1.001].map(|rudder| mariner(&zoo, rudder));
    let by_own = validated(&zoo, &own, &trials_of(1.0), &draws, false);
    for (quantity, verdict, error) in recorded(&by_own) {
        println!("{quantity}: {verdict:?}, E {error:.2} % D");
        assert_eq!(verdict, Verdict::Validated, "{quantity}: {by_own:#?}");
        assert!(error.abs() < 1.0, "{quantity}: {error} %");
    }
    assert!(recorded(&by_own).len() >= 6, "{by_own:?}");
    let by_other = validated(&zoo, &own, &trials_of(0.7), &draws, false);
    for (quantity, verdict, error) in recorded(&by_other) {
        println!("{quantity}, of a weaker rudder: {verdict:?}, E {error:.2} % D");
    }
    let advance = by_other.quantities.iter().find(|one| one.quantity == "turn 35 deg: advance");
    let advance = advance.unwrap();
    assert_eq!(advance.verdict, Verdict::NotValidated);
    // With less rudder it goes further: D is above S.
    assert!(advance.comparison_error.unwrap() > 0.0);
    let bare = validated(&zoo, &own, &trials_of(0.7), &[], false);
    let advance = bare.quantities.iter().find(|one| one.quantity == "turn 35 deg: advance");
    assert_eq!(advance.unwrap().verdict, Verdict::AboveWhatIsKnown);
}

#[test]
fn trials_that_a_model_was_fitted_on_and_single_records_judge_nothing() {
    let zoo = Zoo::load_embedded().unwrap();
    let own = mariner(&zoo, 1.0);
    let all = trials(&zoo, &own);
    let fitted = validated(&zoo, &own, &all, &[], true);
    assert!(recorded(&fitted).is_empty());
    assert!(fitted.remarks.iter().any(|remark| remark.contains("6 trials are not used")));
    let single = validated(&zoo, &own, &all[..1], &[], false);
    assert!(
        single.quantities.iter().filter(|one| one.records.is_some()).all(|one| {
            one.verdict == Verdict::Undecided && one.validation_uncertainty.is_none()
        })
    );
}
