//! Faults planted into a trial at known rows: found, and few sound values taken for faults. The
//! table of `docs/evidence/import.md` is by the same planting, on trials of a simulated ship.
#![allow(clippy::unwrap_used)]

#[path = "../../../../tests/src/planted_faults/plant.rs"]
#[allow(dead_code)]
mod plant;

use std::collections::{BTreeMap, BTreeSet};

use plant::{FaultKind, PlantedTrial};
use rand::SeedableRng;
use rand_chacha::ChaCha12Rng;
use rand_distr::{Distribution, Normal};
use sistership_model::trial::{Channel, Trial};
use sistership_trials::samples::to_csv;
use sistership_trials::{load_cleaned, load_path, read_manifest_file};

/// A zigzag at 2 Hz around north with the noise of a sea trial.
fn zigzag(rng: &mut ChaCha12Rng) -> Trial {
    let mut scatter = |deviation: f64| Normal::new(0.0, deviation).unwrap().sample(rng);
    let mut channels: BTreeMap<Channel, Vec<f64>> = BTreeMap::new();
    let (mut psi, mut x, mut y) = (0.0, 0.0, 0.0);
    let t_s: Vec<f64> = (0..1200).map(|k| 0.5 * f64::from(k)).collect();
    for t in &t_s {
        let r = 0.008 * (t / 20.0).sin();
        let (u, v) = (8.0 + 0.3 * (t / 10.0).cos(), -50.0 * r);
        psi += 0.5 * r;
        x += 0.5 * (u * f64::cos(psi) - v * f64::sin(psi));
        y += 0.5 * (u * f64::sin(psi) + v * f64::cos(psi));
        let values = [
            (Channel::X, x + scatter(0.5)),
            (Channel::Y, y + scatter(0.5)),
            (Channel::Psi, psi - 0.16 + scatter(1.5e-3)),
            (Channel::U, u + scatter(0.03)),
            (Channel::V, v + scatter(0.03)),
            (Channel::R, r + scatter(3e-4)),
            (Channel::Delta, 0.17 * (t / 20.0).cos().signum()),
        ];
        values.into_iter().for_each(|(one, value)| channels.entry(one).or_default().push(value));
    }
    Trial { name: "zigzag.csv".into(), t_s, channels, ..Trial::default() }
}

/// Outcome of an import of a trial with faults.
struct ImportOutcome {
    /// Channel, or nothing for whole rows, and row of each excluded value.
    excluded: BTreeSet<(String, usize)>,
    /// True if the trial is read with its faults, and without them.
    is_read_faulty: bool,
    is_read_cleaned: bool,
}

impl ImportOutcome {
    fn new(planted: &PlantedTrial) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("trials.yaml");
        let file = std::fs::File::create(folder.path().join("zigzag.csv")).unwrap();
        to_csv(file, &planted.trial).unwrap();
        let text = "kind: trials\nship: a\nconventions: { missing: bridge }\ntrials: [{ file: \
                    zigzag.csv }]\n";
        std::fs::write(&place, text).unwrap();
        let is_read_faulty = load_path(&place).unwrap().trials[0].is_ok();
        let cleaned = load_cleaned(&place).unwrap();
        // The manifest with the exclusions reads the same trial.
        let mut manifest = read_manifest_file("trials.yaml", text).unwrap();
        manifest.declarations.exclude.clone_from(&cleaned.excluded);
        std::fs::write(&place, manifest.to_yaml().unwrap()).unwrap();
        let again = load_path(&place).unwrap().trials.remove(0).unwrap();
        let is_read_cleaned = cleaned.trials[0]
            .as_ref()
            .is_ok_and(|one| one.t_s == again.t_s && one.channels == again.channels);
        let mut excluded = BTreeSet::new();
        for one in cleaned.excluded {
            let channel = one.channel.unwrap_or_default();
            let rows = one.rows.into_iter().flat_map(|rows| rows.0).flatten();
            // The first row of the file is its header.
            excluded.extend(rows.map(|row| (channel.clone(), row as usize - 2)));
        }
        Self { excluded, is_read_faulty, is_read_cleaned }
    }
}

/// Kinds of faults, and the least fraction of them that is found.
const KINDS: [(FaultKind, f64); 6] = [
    (FaultKind::WrappedAverage, 0.95),
    (FaultKind::Spike, 0.98),
    (FaultKind::Frozen, 0.98),
    (FaultKind::StaleRepeat, 0.95),
    (FaultKind::BackwardTime, 0.98),
    (FaultKind::PositionJump, 0.95),
];
/// Largest fraction of sound values that are excluded, beside planted faults.
const FALSE_ALARMS: f64 = 5e-4;

#[test]
fn planted_faults_are_found_and_sound_values_are_not_taken_for_them() {
    println!("| fault | rate, % | planted | found, % | false alarms |");
    for (kind, least) in KINDS {
        for rate in [0.001, 0.003, 0.01, 0.03] {
            let mut rng = ChaCha12Rng::seed_from_u64(5);
            let planted = plant::plant(&zigzag(&mut rng), kind, rate, &mut rng);
            let outcome = ImportOutcome::new(&planted);
            let found = planted.faults.intersection(&outcome.excluded).count();
            let share = found as f64 / planted.faults.len() as f64;
            let alarms = outcome.excluded.difference(&planted.faults).count();
            let (name, percent) = (kind.name(), 100.0 * rate);
            let planted_count = planted.faults.len();
            println!("| {name} | {percent} | {planted_count} | {:.1} | {alarms} |", 100.0 * share);
            assert!(share >= least, "{name} at {rate}: {share} found");
            let values = planted.trial.len() * planted.trial.channels.len();
            assert!(alarms as f64 <= FALSE_ALARMS * values as f64, "{name} at {rate}: {alarms}");
            assert!(outcome.is_read_cleaned, "{name} at {rate}: the trial is refused");
        }
    }
}

#[test]
fn a_sound_trial_loses_nothing_and_a_faulty_one_would_be_refused() {
    let mut rng = ChaCha12Rng::seed_from_u64(6);
    let sound = zigzag(&mut rng);
    let clean = PlantedTrial { trial: sound.clone(), faults: BTreeSet::new() };
    let outcome = ImportOutcome::new(&clean);
    assert_eq!(outcome.excluded, BTreeSet::new());
    assert!(outcome.is_read_faulty && outcome.is_read_cleaned);
    let planted = plant::plant(&sound, FaultKind::BackwardTime, 0.01, &mut rng);
    assert!(!ImportOutcome::new(&planted).is_read_faulty);
}

#[test]
fn a_single_jump_of_position_ends_a_segment_and_is_no_refusal() {
    let mut trial = zigzag(&mut ChaCha12Rng::seed_from_u64(7));
    let north = trial.channels.get_mut(&Channel::X).unwrap();
    north[600..].iter_mut().for_each(|x| *x += 500.0);
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("zigzag.csv");
    to_csv(std::fs::File::create(&place).unwrap(), &trial).unwrap();
    let read = load_path(&place).unwrap().trials.remove(0).unwrap();
    assert_eq!((read.len(), read.segments().len()), (trial.len() - 1, 2));
    assert!(read.warnings.iter().any(|one| one.message.contains("is not fitted across it")));
}
