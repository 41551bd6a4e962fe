//! Tapes for tests.
#![allow(clippy::unwrap_used)]

use sistership_formula::parse;

use super::{Tape, TapeBuilder};

/// Tape of one formula of `u` and `v`.
pub(super) fn parse_tape(text: &str) -> Tape {
    let mut builder = TapeBuilder::new(&["u", "v"], |_| None);
    builder.add_output(&parse(text).unwrap()).unwrap();
    builder.finish()
}
