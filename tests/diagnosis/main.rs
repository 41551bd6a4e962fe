//! Accuracy of the diagnosis: a true ship that nobody fitted hides an effect, and the diagnosis must name it. Figures are
//! printed; `--nocapture` shows them.
//!
//! `DIAGNOSIS_CASES=current,wind`, `DIAGNOSIS_STRENGTHS=1,0.5` and `DIAGNOSIS_SEEDS=1` run a part of the table, which then
//! is printed and not judged; `DIAGNOSIS_SEEDS=3` runs all of it. `DIAGNOSIS_SOURCE=kcs` starts from another ship.
#![allow(clippy::unwrap_used)]

mod baseline;
mod cases;
mod confusion;
mod esso_osaka;
mod examples;
mod systematic_errors;
mod timing;
mod truth;
