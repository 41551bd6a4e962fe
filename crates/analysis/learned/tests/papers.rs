//! The systems of Kanazawa 2023 in small: the directions that he prints, on a virtual ship. The
//! tables of docs/evidence/branches.md are the same with his sizes.

use crate::paper_i::{Misses, Outcome, Size};
use crate::{paper_ii, paper_iii, paper_iv, paper_vi, vessel};

/// Section 3.1: at Beaufort 4 an LSTM beside the foundation is nearer than either alone.
#[test]
fn both_are_nearer_than_the_foundation_and_than_data_alone() {
    let outcomes = crate::paper_i::outcomes(Size { scenarios: 30, epochs: 15, hop: 6 });
    let Outcome { force, misses } = &outcomes[1];
    let [foundation, data, both] = misses.each_ref().map(Misses::mean);
    println!("Beaufort {force}: foundation {foundation:.2}, data {data:.2}, both {both:.2} m");
    assert!(both < 0.5 * foundation && both < data, "{foundation} {data} {both}");
}

/// Section 3.2: docking, the branch is nearer over a minute than the foundation.
#[test]
fn docking_is_predicted_nearer_with_the_branch() {
    let size = paper_iii::Size { trained: 16, judged: 6, epochs: 10 };
    let [foundation, both] = paper_iii::outcomes(size).map(|row| row[2].0);
    println!("60 s ahead: foundation {foundation:.2}, both {both:.2} m");
    assert!(both < foundation, "{foundation} {both}");
}

/// Section 3.3: of one trial a perceptron that saw the foundation's simulations makes more.
#[test]
fn simulations_before_a_trial_help() {
    let size = paper_ii::Size { simulations: 40, trials: &[1], draws: 1, judged: 4, epochs: 90 };
    let outcome = &paper_ii::outcomes(size).by_amount[0];
    let (untrained, pretrained) = (outcome.untrained, outcome.pretrained);
    println!("one trial: without {untrained:.2}, with simulations {pretrained:.2} m");
    assert!(pretrained < untrained, "{untrained} {pretrained}");
}

/// Chapter 4: more manoeuvres help, and with few of them a foundation does.
#[test]
fn data_and_foundation_make_up_for_each_other() {
    let foundations = &paper_iv::Size::PAPER.foundations[2..3];
    let size = paper_iv::Size { judged: 8, amounts: &[5, 30], foundations, epochs: 60 };
    let map = paper_iv::map(vessel::hull::VESSEL, size);
    let [both, data] = [&map[0].errors, &map[1].errors];
    println!("foundation {:?}: both {both:.2?}, data alone {data:.2?} m", map[0].foundation);
    assert!(both[0] < data[0] && both[1] < both[0] && data[1] < data[0], "{both:?} {data:?}");
}

/// Section 3.4: the factor takes off what the closed-form roll has too much of.
#[test]
fn a_factor_takes_off_what_the_responses_have_too_much_of_in_roll() {
    for draw in 0..2 {
        let [_, _, roll] = paper_vi::errors(draw);
        let [responses, factor, _] = roll.all;
        assert!(factor < 0.5 * responses, "{draw}: {roll:?}");
    }
}
