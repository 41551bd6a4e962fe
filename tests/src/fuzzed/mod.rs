//! What must hold of anything that is read, whatever the bytes: one body for each fuzz target
//! (`tests/fuzz`).
//!
//! A body returns where the input is refused, and panics where what was accepted does not hold.

pub mod csv;
pub mod effect;
pub mod formula;
pub mod law;
pub mod manifest;
pub mod parquet;
pub mod version;
pub mod vessel;

use sistership_model::Trial;
use sistership_trials::{FileLimits, Mapping};

/// The input as text, where it is text.
fn text(data: &[u8]) -> Option<&str> {
    std::str::from_utf8(data).ok()
}

/// Bounds small enough that an input of a few kB cannot ask for more.
fn small() -> Mapping {
    let mut mapping = Mapping::with_canonical_names();
    mapping.limits =
        FileLimits { rows: 10_000, columns: 50, line_bytes: 4096, ..FileLimits::default() };
    mapping
}

/// What holds of every trial that is accepted: as many samples in each channel as in time, all
/// finite, time increasing, and the canonical file reads back to the same trial.
fn holds(trial: &Trial) {
    assert!(trial.t_s.windows(2).all(|pair| pair[0] < pair[1]), "time does not increase");
    for (channel, values) in &trial.channels {
        assert_eq!(values.len(), trial.len(), "{channel} is not as long as time");
        assert!(values.iter().all(|value| value.is_finite()), "{channel} holds what is no number");
    }
    let bytes =
        sistership_trials::samples::to_parquet(trial).expect("an accepted trial is written");
    let again = sistership_trials::samples::from_parquet(bytes.into()).expect("and read");
    assert!(*trial == again, "a trial does not read back to itself");
}
