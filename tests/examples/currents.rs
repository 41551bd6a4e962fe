//! Currents planted into the trials of a ship whose law the zoo lacks: what import estimates of
//! them, and the error of a refinement in calm water with the current subtracted and without.
//!
//! `cargo run -p sistership-tests --example currents`

use std::path::{Path, PathBuf};

use sistership_model::Trial;
use sistership_model::trial::Channel;
use sistership_tests::planted_faults::{RefinementJudge, judge_circles};
use sistership_trials::samples::to_csv;
use sistership_trials::{
    ManifestFile, ProposalRequest, TrialCurrent, estimate_currents, load_path, propose_files,
};

/// Velocities to the north and to the east, m/s.
const PLANTED: [(f64, f64); 6] =
    [(0.0, 0.0), (0.05, 0.0), (0.0, 0.1), (0.2, -0.1), (-0.3, 0.4), (0.8, 0.6)];
/// Replicas with other noise.
const SEEDS: [u64; 3] = [1, 2, 3];

fn main() {
    let judge = RefinementJudge::new();
    println!(
        "| planted, m/s | largest error of a stated current, m/s | stated of {} trials | not \
         subtracted: u, v m/s, r deg/s | subtracted |",
        4 * SEEDS.len()
    );
    println!("| --- | --- | --- | --- | --- |");
    for planted in PLANTED {
        let cases = SEEDS.map(|seed| ImportedCase::new(seed, planted));
        let stated = cases.iter().flat_map(|case| &case.currents);
        let worst = stated.clone().map(|one| distance(one, planted)).fold(0.0, f64::max);
        println!(
            "| {:.2}, {:.2} | {worst:.3} | {} | {} | {} |",
            planted.0,
            planted.1,
            stated.count(),
            mean_errors(&judge, cases.iter().map(|case| case.recorded.as_slice())),
            mean_errors(&judge, cases.iter().map(|case| case.corrected.as_slice())),
        );
    }
}

/// Trials in a current, as recorded and as import reads them.
struct ImportedCase {
    recorded: Vec<Trial>,
    corrected: Vec<Trial>,
    currents: Vec<TrialCurrent>,
}

impl ImportedCase {
    fn new(seed: u64, planted: (f64, f64)) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let recorded: Vec<Trial> =
            judge_circles(seed).into_iter().map(|trial| with_current(trial, planted)).collect();
        let mut manifest = proposed_manifest(folder.path(), &recorded);
        let place = folder.path().join("trials.yaml");
        let recorded = read_trials(&place, &manifest);
        let currents = estimate_currents(&recorded);
        manifest.declarations.currents.clone_from(&currents);
        let corrected = read_trials(&place, &manifest);
        Self { recorded, corrected, currents }
    }
}

/// Returns the trial over the ground of one through the water: a steady current only adds to it.
fn with_current(mut trial: Trial, (north, east): (f64, f64)) -> Trial {
    let psi = trial.channel(Channel::Psi).expect("a heading").to_vec();
    let t_s = trial.t_s.clone();
    let mut add = |channel: Channel, amount: &dyn Fn(usize) -> f64| {
        let values = trial.channels.get_mut(&channel).expect("a channel");
        values.iter_mut().enumerate().for_each(|(k, value)| *value += amount(k));
    };
    add(Channel::U, &|k| north * psi[k].cos() + east * psi[k].sin());
    add(Channel::V, &|k| east * psi[k].cos() - north * psi[k].sin());
    add(Channel::X, &|k| north * t_s[k]);
    add(Channel::Y, &|k| east * t_s[k]);
    trial
}

fn proposed_manifest(folder: &Path, trials: &[Trial]) -> ManifestFile {
    let write = |trial: &Trial| {
        let path = folder.join(&trial.name);
        to_csv(std::fs::File::create(&path).expect("a file"), trial).expect("written");
        path
    };
    let files: Vec<PathBuf> = trials.iter().map(write).collect();
    let paths: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
    let request = ProposalRequest { ship: "", files: &paths, folder: Some(folder), given: &[] };
    propose_files(&request).expect("a proposal").manifest
}

fn read_trials(place: &Path, manifest: &ManifestFile) -> Vec<Trial> {
    std::fs::write(place, manifest.to_yaml().expect("a manifest")).expect("written");
    let read = load_path(place).expect("a manifest").trials;
    read.into_iter().map(|trial| trial.expect("a trial")).collect()
}

fn distance(found: &TrialCurrent, planted: (f64, f64)) -> f64 {
    (found.north_m_s - planted.0).hypot(found.east_m_s - planted.1)
}

/// Returns the root mean square errors in surge, sway and yaw over the cases.
fn mean_errors<'a>(judge: &RefinementJudge, cases: impl Iterator<Item = &'a [Trial]>) -> String {
    let channels = [Channel::U, Channel::V, Channel::R];
    let each: Option<Vec<[f64; 3]>> =
        cases.map(|trials| judge.unseen_errors(trials, channels)).collect();
    let Some(each) = each else { return "no model".to_owned() };
    let mean = |at: usize| {
        let squares: f64 = each.iter().map(|errors| errors[at].powi(2)).sum();
        (squares / each.len() as f64).sqrt()
    };
    format!("{:.4}, {:.4}, {:.4}", mean(0), mean(1), mean(2).to_degrees())
}
