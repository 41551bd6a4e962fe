//! The confusion table of the diagnosis: every hidden effect against what is named, with the
//! targets.
//!
//! `cargo run --release -p sistership-tests --example hidden_effects` hides each effect once at the
//! weakest strength, pairs, unlisted effects and nothing. `DIAGNOSIS_CASES=current,wind`,
//! `DIAGNOSIS_STRENGTHS=1,0.5` and `DIAGNOSIS_SEEDS=1` run a part, which is printed and not judged;
//! `DIAGNOSIS_SEEDS=3` runs all of it. `DIAGNOSIS_SOURCE=kcs` starts from another ship. It ends
//! with 1 where a target is missed.

use std::process::ExitCode;

use sistership_tests::hidden_effects::cases::Part;
use sistership_tests::hidden_effects::confusion::confusion;

fn main() -> ExitCode {
    let part = Part::of_environment();
    let misses = confusion(&part);
    let is_missed = part.is_judged && !misses.is_empty();
    misses.iter().for_each(|miss| println!("missed: {miss}"));
    ExitCode::from(u8::from(is_missed))
}
