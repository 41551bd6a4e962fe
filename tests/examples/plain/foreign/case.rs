//! Files of one craft: trials for refinement and diagnosis, and what a model of it is judged on.

use std::path::{Path, PathBuf};

use rand_chacha::ChaCha12Rng;
use sistership_tests::synthetic::replica;
use sistership_tests::truth::foreign::Kind;
use sistership_tests::truth::foreign::coasting::Coasting;
use sistership_tests::truth::foreign::craft::Craft;
use sistership_tests::truth::foreign::programme::{further, programme, slow_speed, unseen};
use sistership_tests::truth::foreign::record::{Columns, Instruments, write_trials, write_vessel};
use sistership_tests::truth::foreign::simulate::{Run, Track, turning};

/// Simulations of unseen manoeuvres start anew after so many lengths.
const RESTART_LENGTHS: f64 = 10.0;
/// Samples of a run with the propeller stopped or reversed, by the time of a length.
const COASTING_SAMPLES: f64 = 10.0;

/// A craft in files.
pub struct CraftFiles {
    /// Vessel file.
    pub vessel: PathBuf,
    /// Manifest of the unseen manoeuvres, without noise.
    pub unseen: PathBuf,
    /// Manifest of one trial more than any refinement is given.
    pub further: PathBuf,
    /// Manifests of the runs with the propeller stopped and reversed, without noise.
    pub coasting: [PathBuf; 2],
    /// Their ends.
    pub ends: Ends,
    /// Time after which simulations start anew, s.
    pub restart_s: f64,
    /// Tactical diameters at 35 deg to starboard and port, m.
    pub diameters_m: [f64; 2],
    seen: Vec<(String, Columns)>,
    /// The craft.
    pub craft: Craft,
    folder: tempfile::TempDir,
}

/// Speeds and times of the craft with its propeller stopped and reversed.
pub struct Ends {
    /// Speed of the approach, m/s.
    pub approach_m_s: f64,
    /// When it is at rest with the propeller reversed, s.
    pub rest_s: Option<f64>,
    /// Last speed with the propeller stopped and reversed, m/s.
    pub last_m_s: [f64; 2],
}

impl CraftFiles {
    /// Simulates and writes everything but the trials of a refinement.
    ///
    /// # Panics
    /// A file cannot be written.
    pub fn new(kind: Kind, seed: u64) -> Self {
        let craft = kind.craft(seed);
        let folder = tempfile::tempdir().expect("a folder");
        let (slow, instruments) = (slow_speed(seed), Instruments::of(&craft));
        let noisy = |index: usize, run: &Run| {
            let mut rng = replica(seed, 600 + index);
            (run.name(), instruments.columns(&craft, &run.simulate(&craft), &mut rng))
        };
        let perfect = Instruments::perfect(instruments.interval_s);
        let exact = |run: &Run| (run.name(), columns(&perfect, &craft, &run.simulate(&craft)));
        let at = |name: &str, trials: &[(String, Columns)]| {
            write_trials(&subfolder(folder.path(), name), craft.size(), trials)
        };
        let runs = Coasting::simulate(&craft);
        let sparse = Instruments::perfect(interval_s(&craft));
        let coasting = [("stopped", &runs.stopped), ("reversed", &runs.reversed)]
            .map(|(name, run)| at(name, &[(name.to_owned(), columns(&sparse, &craft, run))]));
        Self {
            vessel: write_vessel(folder.path(), craft.size()),
            unseen: at("unseen", &unseen(slow).iter().map(exact).collect::<Vec<_>>()),
            further: at("further", &[noisy(99, &further())]),
            coasting,
            ends: ends(&craft, &runs),
            restart_s: RESTART_LENGTHS * craft.size().length_time_s(),
            diameters_m: [35.0, -35.0].map(|angle| {
                turning(&craft, angle).tactical_diameter_m.expect("every craft turns")
            }),
            seen: programme(slow).iter().enumerate().map(|(k, run)| noisy(k, run)).collect(),
            craft,
            folder,
        }
    }

    /// Manifest of the first trials of the programme.
    pub fn trials(&self, count: usize) -> PathBuf {
        let folder = subfolder(self.folder.path(), &format!("seen-{count}"));
        write_trials(&folder, self.craft.size(), &self.seen[..count])
    }
}

fn columns(instruments: &Instruments, craft: &Craft, track: &Track) -> Columns {
    let mut unused: ChaCha12Rng = replica(0, 0);
    instruments.columns(craft, track, &mut unused)
}

/// A tenth of the time of a length, in tenths of a second.
fn interval_s(craft: &Craft) -> f64 {
    (10.0 * craft.size().length_time_s() / COASTING_SAMPLES).ceil() / 10.0
}

fn ends(craft: &Craft, runs: &Coasting) -> Ends {
    let last = |track: &Track| track.speeds()[track.t_s.len() - 1];
    Ends {
        approach_m_s: craft.size().speed_m_s,
        rest_s: runs.rest_s,
        last_m_s: [last(&runs.stopped), last(&runs.reversed)],
    }
}

fn subfolder(folder: &Path, name: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::create_dir_all(&path).expect("a folder");
    path
}
