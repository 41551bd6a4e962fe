//! The bodies of the targets, which are those of the tests (`tests/src/fuzzed`).

#[path = "../../src/fuzzed/mod.rs"]
pub mod fuzzed;
