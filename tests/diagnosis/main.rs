//! Accuracy of the diagnosis: hidden effects are named, on simulated and on measured trials.
//! Figures are printed; `--nocapture` shows them. The whole table is `--example hidden_effects`.
#![allow(clippy::unwrap_used)]

mod changes;
mod confusion;
mod esso_osaka;
mod examples;
mod sequence;
mod systematic_errors;
