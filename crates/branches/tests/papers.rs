//! The systems of Kanazawa 2023 in small: the directions that he prints, on a virtual ship. The
//! tables of docs/evidence/branches.md are the same with his sizes.
#![allow(clippy::unwrap_used)]

#[path = "../../../tests/examples/branches/paper_i.rs"]
#[allow(dead_code)]
mod paper_i;
#[path = "../../../tests/examples/branches/paper_iii.rs"]
#[allow(dead_code)]
mod paper_iii;
#[path = "../../../tests/examples/branches/vessel/mod.rs"]
#[allow(dead_code)]
mod vessel;

use paper_i::{Misses, Outcome, Size};

/// Section 3.1: at Beaufort 4 an LSTM beside the foundation is nearer than either alone.
#[test]
fn both_are_nearer_than_the_foundation_and_than_data_alone() {
    let outcomes = paper_i::outcomes(Size { scenarios: 30, epochs: 15, hop: 6 });
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
