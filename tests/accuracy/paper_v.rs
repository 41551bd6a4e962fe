//! The case study of Kanazawa's Paper V: the Mariner's coefficients refined into a model of SR108,
//! Table 5.
//!
//! What the paper leaves open is set as the README of `shared/data/sr108` says, and two things that
//! it does not say:
//! - Distances are counted from where a prediction starts, 6 s after the execution, across as well
//!   as along the course. Counted from the first course, transfer at 120 rpm is 0.14 m short of the
//!   paper's.
//! - The printed true radii carry measurement noise. The true turns to both sides mirror each
//!   other, the printed radii do not; all six come out within 0.3 m with one error of -0.0023 deg/s
//!   in the last yaw rate, at 650 s. Against the printed truth, SP's errors in the radius come out
//!   within 0.1 points too.

mod plain;
mod published;
mod refined;
mod truth;
mod turn;
mod weak;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use sistership_model::law::Law;
use sistership_model::quantity::Quantity;
use sistership_model::{Model, Zoo};
use sistership_priors::transfer::{TrialApproach, transfer_model};
use sistership_simulation::recorded::{ReplaySettings, replay_trial};
use sistership_simulation::{Method, Ship, Trajectory};

use published::{Block, TABLE_5};
use refined::refinements;
use truth::{PREDICTED, STEP_S, Truth, recorded};
use turn::{Metrics, NAMES, RADIUS, SPEED_LOSS};

/// The seed on which the test stands; fixed before any result was seen.
const SEED: u64 = 1;

/// Turns that no choice was made with, deg, and their noise.
const OTHER_TURNS: [f64; 4] = [5.0, -5.0, 10.0, -10.0];
const SPEEDS_RPM: [f64; 3] = [80.0, 100.0, 120.0];
const OTHER_SEED: u64 = 11;

/// A block of the table as it came out.
struct Row {
    paper: &'static Block,
    truth: Metrics,
    source: Metrics,
    /// SP's radius against the printed true radius, which is not free of noise, %.
    source_radius_by_paper: f64,
    refined: Metrics,
}

#[test]
fn table_5_of_paper_v_comes_out() {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let rows = table(&zoo, SEED);
    print(&rows);
    for seed in 1..=5 {
        println!("MR, mean of 24 cells, seed {seed}: {:.2} %", mean_of_cells(&table(&zoo, seed)));
    }
    rows.iter().for_each(check_truth);
    rows.chunks(2).for_each(check_true_radius);
    rows.iter().for_each(check_source);
    rows.iter().for_each(check_refined);
    assert!((mean_of_cells(&rows) - 5.06).abs() <= 0.3);
}

/// The weak form beside the paper's own refinement, chosen by manoeuvres left out.
#[test]
fn the_weak_form_beats_the_published_refinement_on_paper_v() {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let plane = by_weak(&zoo, "abkowitz", &weak::single());
    let roll = by_weak(&zoo, "abkowitz-roll", &weak::single());
    let pooled = by_weak(&zoo, "abkowitz-roll", &weak::pooled());
    println!(
        "                    MR paper   weak   weak, roll   weak, roll, pooled  (errors in %; seed \
         {SEED})"
    );
    for (k, block) in TABLE_5.iter().enumerate() {
        for (i, name) in NAMES.iter().enumerate() {
            let [plane, roll, pooled] = [&plane, &roll, &pooled].map(|errors| errors[k].0[i]);
            let paper = block.refined.0[i];
            println!(
                "{:3.0} rpm {:+} {name:3} {paper:10.1} {plane:7.2} {roll:10.2} {pooled:12.2}",
                block.n_rpm, block.rudder_deg
            );
        }
    }
    let [plane, roll, pooled] = [&plane, &roll, &pooled].map(|errors| mean_of(errors));
    println!("mean of 24 cells      {:.2} {plane:7.2} {roll:10.2} {pooled:12.2}", 5.03);
    assert!(plane <= 2.7 && pooled <= 0.5, "{plane} {pooled}");
    assert!(roll <= 1.9, "{roll}");
}

/// The same on turns that are in no table, with other noise: what was settled with the table in
/// sight is judged here.
#[test]
#[ignore = "half a minute; for people"]
fn the_weak_form_on_turns_of_5_and_10_degrees() {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let mean = |law: &str, sets: &[Vec<(f64, f64)>]| {
        let mut rng = ChaCha8Rng::seed_from_u64(OTHER_SEED);
        let of_speed = |n_rpm| by_weak_on(&zoo, law, sets, (n_rpm, &OTHER_TURNS), &mut rng);
        mean_of(&SPEEDS_RPM.into_iter().flat_map(of_speed).collect::<Vec<_>>())
    };
    let [plane, roll] = ["abkowitz", "abkowitz-roll"].map(|law| mean(law, &weak::single()));
    let pooled = mean("abkowitz-roll", &weak::pooled());
    println!("mean of 48 cells: weak {plane:.2}, weak with roll {roll:.2}, pooled {pooled:.2} %");
    assert!(plane <= 2.7 && roll <= 1.9 && pooled <= 0.5);
}

/// The plain call on each single data set and on all of them in one, roll recorded.
#[test]
#[ignore = "minutes; for people"]
fn the_plain_call_on_paper_v() {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let [single, pooled] = [weak::single(), weak::pooled()].map(|sets| by_plain(&zoo, &sets));
    let (single, pooled) = (mean_of(&single), mean_of(&pooled));
    println!("mean of 24 cells: plain call, single {single:.2}, pooled {pooled:.2} %");
    assert!(single <= 2.0 && pooled <= 0.31, "1.82 and 0.30; docs/evidence/plain.md");
}

fn by_plain(zoo: &Zoo, sets: &[Vec<(f64, f64)>]) -> Vec<Metrics> {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let mut errors = Vec::new();
    for blocks in TABLE_5.chunks(2) {
        let truth = Truth::new(zoo, blocks[0].n_rpm);
        let refined: Vec<(Model, Law)> =
            sets.iter().map(|set| plain::refined(zoo, &truth, set, &mut rng)).collect();
        for block in blocks {
            let track = truth.turn(block.rudder_deg);
            let one =
                |(model, law): &(Model, Law)| judged(std::slice::from_ref(model), law, &track);
            errors.push(Metrics::mean(&refined.iter().map(one).collect::<Vec<_>>()));
        }
    }
    errors
}

fn mean_of(errors: &[Metrics]) -> f64 {
    errors.iter().flat_map(|metrics| metrics.0).sum::<f64>() / (NAMES.len() * errors.len()) as f64
}

/// Errors of each block of the table by the weak form, the mean over the data sets; the noise is
/// one stream.
fn by_weak(zoo: &Zoo, law: &str, sets: &[Vec<(f64, f64)>]) -> Vec<Metrics> {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let speeds = TABLE_5.chunks(2).flat_map(|blocks| {
        let rudders: Vec<f64> = blocks.iter().map(|block| block.rudder_deg).collect();
        by_weak_on(zoo, law, sets, (blocks[0].n_rpm, &rudders), &mut rng)
    });
    speeds.collect()
}

/// The same for turns at one speed.
fn by_weak_on(
    zoo: &Zoo,
    law: &str,
    sets: &[Vec<(f64, f64)>],
    (n_rpm, rudders_deg): (f64, &[f64]),
    rng: &mut ChaCha8Rng,
) -> Vec<Metrics> {
    let [law, plane] = [law, "abkowitz"].map(|name| zoo.law(name).expect("a law of the zoo"));
    let truth = Truth::new(zoo, n_rpm);
    let source = source(zoo, plane, &truth);
    let source = if law.has_roll() { weak::with_roll(&source, law, &truth) } else { source };
    let models: Vec<Model> =
        sets.iter().map(|set| weak::refined(zoo, law, &source, &truth, set, rng)).collect();
    rudders_deg.iter().map(|&rudder_deg| judged(&models, law, &truth.turn(rudder_deg))).collect()
}

/// Mean errors of models on a turn; they are of continuous time, and so is the method that
/// simulates them.
fn judged(models: &[Model], law: &Law, track: &Trajectory) -> Metrics {
    let actual = Metrics::of(&track.states[PREDICTED]);
    let errors: Vec<Metrics> = models
        .iter()
        .map(|model| actual.errors(&predicted(model, law, track, Method::Rk4)))
        .collect();
    Metrics::mean(&errors)
}

/// Everything from one stream of random numbers.
fn table(zoo: &Zoo, seed: u64) -> Vec<Row> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    // Both turns at a speed share the five data sets.
    TABLE_5.chunks(2).flat_map(|blocks| case(zoo, blocks, &mut rng)).collect()
}

/// Both turns at one speed.
fn case(zoo: &Zoo, blocks: &'static [Block], rng: &mut ChaCha8Rng) -> Vec<Row> {
    let law = zoo.law("abkowitz").expect("a law of the zoo");
    let truth = Truth::new(zoo, blocks[0].n_rpm);
    let source = source(zoo, law, &truth);
    let refinements = refinements(&source, law, &truth, rng);
    let row = |paper: &'static Block| {
        let track = truth.turn(paper.rudder_deg);
        let actual = Metrics::of(&track.states[PREDICTED]);
        let by_source = predicted(&source, law, &track, Method::Euler);
        let errors: Vec<Metrics> = refinements
            .iter()
            .map(|model| actual.errors(&predicted(model, law, &track, Method::Euler)))
            .collect();
        Row {
            paper,
            truth: actual,
            source: actual.errors(&by_source),
            source_radius_by_paper: paper.truth.errors(&by_source).0[RADIUS],
            refined: Metrics::mean(&errors),
        }
    };
    blocks.iter().map(row).collect()
}

/// The source parameters: the Mariner's coefficients on SR108's length, with SR108's own mass and
/// added mass.
fn source(zoo: &Zoo, law: &Law, truth: &Truth) -> Model {
    let mariner = zoo.find_model("mariner").unwrap_or_else(|error| panic!("{error}"));
    let sr108 = zoo.vessel("sr108").expect("a ship of the zoo");
    let mut model = transfer_model(
        &mariner,
        law,
        sr108,
        Some(TrialApproach { speed_m_s: truth.speed_m_s, n_rps: None }),
    );
    let own = |name: &str| truth.model.parameters[name].value;
    // Son and Nomoto's matrix has m_y alpha_y off its diagonal, where the Abkowitz law has m x_G
    // less the derivative.
    let coupling = -own("m_y") * own("alpha_y");
    let masses = [
        ("m", own("m")),
        ("I_z", own("I_z")),
        ("x_G", 0.0),
        ("X_udot", -own("m_x")),
        ("Y_vdot", -own("m_y")),
        ("Y_rdot", coupling),
        ("N_vdot", coupling),
        ("N_rdot", -own("J_z")),
    ];
    model.parameters.extend(
        masses.map(|(name, value)| {
            (name.to_owned(), Quantity::new(value, truth.model.name.as_str()))
        }),
    );
    model
}

/// A model's turn, started from the true state and steered by the true rudder.
fn predicted(model: &Model, law: &Law, track: &Trajectory, method: Method) -> Metrics {
    let ship = Ship::new(model, law).expect("a ready ship");
    let settings = ReplaySettings { restart_s: None, method, step_s: STEP_S };
    let run = replay_trial(&ship, &recorded(track, PREDICTED), &settings)
        .expect("every channel that the law needs");
    assert_eq!(run.stopped, None);
    Metrics::of(&run.track.states)
}

fn mean_of_cells(rows: &[Row]) -> f64 {
    rows.iter().flat_map(|row| row.refined.0).sum::<f64>() / (NAMES.len() * rows.len()) as f64
}

fn print(rows: &[Row]) {
    println!(
        "                   true             SP %          MR %     (m and m/s; ours, paper; seed \
         {SEED})"
    );
    for row in rows {
        for (i, name) in NAMES.iter().enumerate() {
            println!(
                "{:3.0} rpm {:+} {name:3} {:7.2} {:6.1}   {:5.2} {:4.1}   {:5.2} {:4.1}",
                row.paper.n_rpm,
                row.paper.rudder_deg,
                row.truth.0[i],
                row.paper.truth.0[i],
                row.source.0[i],
                row.paper.source.0[i],
                row.refined.0[i],
                row.paper.refined.0[i],
            );
        }
    }
}

/// How far a cell is from the paper's.
fn off(ours: &Metrics, paper: &Metrics, i: usize) -> f64 {
    (ours.0[i] - paper.0[i]).abs()
}

fn check_truth(row: &Row) {
    for (i, name) in NAMES.iter().enumerate().filter(|(i, _)| *i != RADIUS) {
        // Speed losses are printed to 0.1 m/s.
        let within = if i == SPEED_LOSS { 0.05 } else { 0.1 };
        assert!(
            off(&row.truth, &row.paper.truth, i) <= within,
            "true {name} at {} rpm",
            row.paper.n_rpm
        );
    }
}

/// The mean over both sides of a turn, in which the error of the yaw rate cancels.
fn check_true_radius(sides: &[Row]) {
    let mean = |of: &dyn Fn(&Row) -> f64| sides.iter().map(of).sum::<f64>() / sides.len() as f64;
    let off = mean(&|row| row.truth.0[RADIUS]) - mean(&|row| row.paper.truth.0[RADIUS]);
    assert!(off.abs() <= 0.3, "true radius at {} rpm", sides[0].paper.n_rpm);
}

fn check_source(row: &Row) {
    for (i, name) in NAMES.iter().enumerate() {
        let within = if i == RADIUS { 0.7 } else { 0.1 };
        assert!(
            off(&row.source, &row.paper.source, i) <= within,
            "{name} by SP at {} rpm",
            row.paper.n_rpm
        );
    }
    let off = row.source_radius_by_paper - row.paper.source.0[RADIUS];
    assert!(off.abs() <= 0.1, "radius by SP against the printed truth at {} rpm", row.paper.n_rpm);
}

/// The mean of all cells would hide differences that cancel.
fn check_refined(row: &Row) {
    for (i, name) in NAMES.iter().enumerate() {
        assert!(
            off(&row.refined, &row.paper.refined, i) <= 1.5,
            "{name} by MR at {} rpm",
            row.paper.n_rpm
        );
    }
}
