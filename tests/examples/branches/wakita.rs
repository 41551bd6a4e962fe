//! Wakita 2022: recurrent networks of low-speed manoeuvring, Type-1 to Type-5 (Table 7), trained on
//! sequences of states without a foundation, and the first of them beside the refined law.
//!
//! The six files on which the paper judged are not given. In their place stand files of the given
//! set that belong to none of its smaller sets; they are left out of the largest. Networks are
//! narrower than the paper's 200 neurons and see fewer epochs, for a computer without a GPU.

use sistership_learned::recurrent::{
    LossKind, NetworkMemory, NetworkShape, RecordedMotion, RecurrentCell, SequenceTraining,
    TrainedNetwork, train_network,
};
use sistership_model::{Trial, Zoo};
use sistership_simulation::Ship;
use sistership_simulation::plant::PlantWorkspace;
use sistership_simulation::recorded::instants_along;
use sistership_simulation::state::{StateVector, at};

use crate::measured::{law, refined, trials};
use crate::score::RESTART_S;

/// Epochs unless others are asked for; the paper has 1000.
pub const EPOCHS: usize = 30;
/// Neurons of each layer.
const WIDTH: usize = 24;
/// Table 8: samples of a sequence, and of the memory.
const STEPS: usize = 60;
const MEMORY: usize = 10;

/// What is judged on, and what the paper's Table 9 has of its own file of that kind: MMG, Type-1 to
/// Type-5.
const TEST: [(&str, [f64; 6]); 6] = [
    ("random_06-Aug-2020_16_24_25_5", [0.272, 0.236, 0.241, 4834.0, 0.488, 0.262]),
    ("turn_14-Oct-2020_14_08_51", [0.858, 0.713, 0.728, 0.864, 0.701, 0.785]),
    ("zigzag_31-Jul-2020_14_10_05", [1.015, 0.086, 0.124, 761.1, 0.122, 0.856]),
    ("berthing_12-Nov-2020_11_07_23", [0.036, 0.052, 0.058, 634.8, 0.144, 0.055]),
    ("berthing_12-Nov-2020_11_21_46", [0.189, 0.069, 0.140, 91.76, 0.246, 0.182]),
    ("berthing_12-Nov-2020_13_09_11", [0.100, 0.138, 0.167, 1.163, 0.302, 0.294]),
];

/// Its smaller sets (Table 6).
const TZB: [&str; 11] = [
    "turn_14-Sep-2020_13_39_32",
    "turn_14-Sep-2020_14_16_04",
    "turn_14-Sep-2020_15_58_08",
    "turn_cut_14-Sep-2020_16_09_02",
    "zigzag_31-Jul-2020_13_22_52",
    "zigzag_31-Jul-2020_13_29_19",
    "zigzag_31-Jul-2020_13_50_28",
    "zigzag_31-Jul-2020_13_57_45",
    "zigzag_31-Jul-2020_14_03_39",
    "berthing_12-Nov-2020_11_14_47",
    "berthing_12-Nov-2020_13_37_05",
];
const TZRB: [&str; 8] = [
    "random_06-Aug-2020_16_24_25_4",
    "random_06-Aug-2020_16_24_25_6",
    "turn_cut_14-Sep-2020_15_58_08",
    "turn_cut_14-Sep-2020_16_09_02",
    "zigzag_31-Jul-2020_13_22_52",
    "zigzag_31-Jul-2020_13_50_28",
    "berthing_12-Nov-2020_11_14_47",
    "berthing_12-Nov-2020_13_37_05",
];

fn is_of(trial: &Trial, names: &[&str]) -> bool {
    names.iter().any(|name| trial.name.contains(&format!("{name}.csv")))
}

fn training(
    memory: NetworkMemory,
    loss: LossKind,
    cell: RecurrentCell,
    epochs: usize,
) -> SequenceTraining {
    SequenceTraining {
        shape: NetworkShape { cell, memory, inputs: 0, width: WIDTH, outputs: 3 },
        loss,
        steps: STEPS,
        hop: STEPS,
        epochs,
        batch: 16,
        rate: 2e-3,
        seed: 2022,
    }
}

/// Motions of trials, with what a law gives along them.
fn motions(trials: &[&Trial], ship: Option<&Ship>) -> Vec<RecordedMotion> {
    let of = |trial: &&Trial| {
        let instants = ship.map(|ship| instants_along(ship, trial).expect("every channel"));
        RecordedMotion::from_trial(trial, instants.as_deref()).expect("every channel, and numbers")
    };
    trials.iter().flat_map(of).collect()
}

/// What a law gives at a sample and simulated velocities.
fn rate(
    ship: &Ship,
    motion: &RecordedMotion,
    k: usize,
    [u, v, r]: &[f64; 3],
    work: &mut PlantWorkspace,
) -> [f64; 3] {
    let [delta, n, ..] = motion.known[k][..] else { return [0.0; 3] };
    let mut state = StateVector::zeros();
    (state[at::U], state[at::V], state[at::R], state[at::DELTA]) = (*u, *v, *r, delta);
    let rate = ship.rate_at(&state, delta, n, work);
    [rate[at::U], rate[at::V], rate[at::R]]
}

/// Deviations of x, y, psi and u, v, r over the trials judged on.
type Deviations = [[f64; 3]; 2];

/// Eq. 26: simulated anew every 100 s; and the number of samples.
fn score(
    fit: &TrainedNetwork,
    ship: Option<&Ship>,
    test: &[RecordedMotion],
    deviations: &Deviations,
) -> (f64, u32) {
    let (mut sum, mut count, mut work) = (0.0, 0, PlantWorkspace::default());
    for motion in test {
        let length = (RESTART_S / motion.interval_s) as usize;
        for start in (0..motion.len()).step_by(length) {
            let own = start..(start + length).min(motion.len());
            let mut law = |k: usize, velocities: &[f64; 3]| {
                ship.map_or([0.0; 3], |ship| rate(ship, motion, k, velocities, &mut work))
            };
            for (k, (p, v)) in
                fit.simulate_motion(motion, own, MEMORY, &mut law).into_iter().enumerate()
            {
                let there = start + k;
                let off = |a: &[f64; 3], b: &[f64; 3], d: &[f64; 3]| -> f64 {
                    (0..3).map(|axis| ((a[axis] - b[axis]) / d[axis]).powi(2)).sum()
                };
                sum += off(&p, &motion.positions[there], &deviations[0])
                    + off(&v, &motion.velocities[there], &deviations[1]);
                count += 1;
            }
        }
    }
    (sum / f64::from(count), count)
}

fn deviations(test: &[RecordedMotion]) -> Deviations {
    let scales = sistership_learned::recurrent::MotionScales::from_motions(test);
    [scales.positions, scales.velocities]
}

/// A network, and what stands beside it.
struct Entrant<'a> {
    name: &'a str,
    fit: TrainedNetwork,
    ship: Option<&'a Ship>,
}

/// Its name, what it is trained on, its memory, loss and cells, and whether it stands beside the
/// law.
type Plan<'a> = (&'a str, &'a [&'a Trial], NetworkMemory, LossKind, RecurrentCell, bool);

/// `wanted` are some of the plans by name; none are all.
pub fn run(epochs: usize, wanted: &[String]) {
    let Some(trials) = trials() else { return };
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let names = TEST.map(|(name, _)| name);
    let of = |wanted: &dyn Fn(&Trial) -> bool| -> Vec<&Trial> {
        trials.iter().filter(|trial| wanted(trial)).collect()
    };
    let (all, tzb, tzrb) = (
        of(&|trial| !is_of(trial, &names)),
        of(&|trial| is_of(trial, &TZB)),
        of(&|trial| is_of(trial, &TZRB)),
    );
    let model = refined(&zoo, &all);
    let ship = Ship::new(&model, law(&zoo)).unwrap_or_else(|error| panic!("{error}"));
    let (short, long) = (NetworkMemory::Steps(MEMORY), NetworkMemory::All);
    let plans: [Plan<'_>; 9] = [
        ("law alone", &[], short, LossKind::States, RecurrentCell::Rnn, true),
        ("Type-1", &all, short, LossKind::States, RecurrentCell::Rnn, false),
        ("Type-2", &all, long, LossKind::States, RecurrentCell::Rnn, false),
        ("Type-3", &all, short, LossKind::Accelerations, RecurrentCell::Rnn, false),
        ("Type-4", &tzb, short, LossKind::States, RecurrentCell::Rnn, false),
        ("Type-5", &tzrb, short, LossKind::States, RecurrentCell::Rnn, false),
        ("Type-2 on TZRB", &tzrb, long, LossKind::States, RecurrentCell::Rnn, false),
        ("LSTM", &all, short, LossKind::States, RecurrentCell::Lstm, false),
        ("law, Type-1", &all, short, LossKind::States, RecurrentCell::Rnn, true),
    ];
    let mut entrants = Vec::new();
    let asked = |name: &str| wanted.is_empty() || wanted.iter().any(|asked| asked == name);
    for (name, seen, memory, loss, cell, beside) in plans {
        if !asked(name) {
            continue;
        }
        let (ship, begun) = (beside.then_some(&ship), std::time::Instant::now());
        // Alone: a network that has learned nothing, of which nothing is taken.
        let epochs = if seen.is_empty() { 0 } else { epochs };
        let seen = if seen.is_empty() { &tzrb[..] } else { seen };
        let training = training(memory, loss, cell, epochs);
        let mut fit = train_network(&motions(seen, ship), &training).expect("enough samples");
        if epochs == 0 {
            fit.network.numbers.iter_mut().for_each(|number| *number = 0.0);
        }
        let last = fit.validation.iter().copied().fold(f64::INFINITY, f64::min);
        println!("{name:<15} {:6.0} s, validation {last:.4}", begun.elapsed().as_secs_f64());
        entrants.push(Entrant { name, fit, ship });
    }
    table(&trials, &entrants);
}

fn table(trials: &[Trial], entrants: &[Entrant<'_>]) {
    let named = |name: &str| -> Vec<&Trial> {
        trials.iter().filter(|trial| is_of(trial, &[name])).collect()
    };
    let all: Vec<&Trial> = TEST.iter().flat_map(|(name, _)| named(name)).collect();
    let deviations = deviations(&motions(&all, None));
    println!("Eq. 26 on files left out; after them the paper's Table 9, of other files");
    print!("{:<32}", "");
    entrants.iter().for_each(|entrant| print!("{:<15}", entrant.name));
    println!("| MMG, Type-1 to Type-5");
    for (name, printed) in TEST {
        print!("{name:<32}");
        for entrant in entrants {
            let test = motions(&named(name), None);
            print!("{:<15.4}", score(&entrant.fit, entrant.ship, &test, &deviations).0);
        }
        println!("| {printed:?}");
    }
    let test = motions(&all, None);
    print!("{:<32}", "answers a second, one core");
    for entrant in entrants {
        let begun = std::time::Instant::now();
        let (_, count) = score(&entrant.fit, entrant.ship, &test, &deviations);
        print!("{:<15.0}", f64::from(count) / begun.elapsed().as_secs_f64());
    }
    println!();
}
