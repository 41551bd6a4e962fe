//! Ships of the truth, in files.

use sistership_tests::truth::files::{write_trials, write_vessel};
use sistership_tests::truth::instruments::Instruments;
use sistership_tests::truth::manoeuvre::{PROGRAMME, UNSEEN};
use sistership_tests::truth::motion::Truth;
use sistership_tests::truth::trials;

use super::DataSet;

/// Simulations start anew after so many lengths.
const RESTART_LENGTHS: f64 = 10.0;

/// The first trials of the programme as the instruments record them; others, without noise, for
/// judgement.
pub fn synthetic(ship: &dyn Truth, count: usize, seed: u64) -> DataSet {
    let size = ship.dimensions();
    let instruments = Instruments::of(ship);
    let seen = trials(ship, &PROGRAMME[..count], &instruments, seed);
    let unseen = trials(ship, &UNSEEN, &instruments.without_noise(), seed);
    let folder = tempfile::tempdir().expect("a folder");
    let vessel = write_vessel(folder.path(), size).display().to_string();
    let manifest = write_trials(folder.path(), &size.name, &seen.iter().collect::<Vec<_>>());
    let restart_s = RESTART_LENGTHS * size.length_time_s();
    DataSet::new(vessel, (manifest, folder), (seen, unseen), restart_s)
}
