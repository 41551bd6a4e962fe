//! One ship: refined on two trials, planned for, sailed by either programme, refined again.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde_json::Value;
use sistership_model::Trial;
use sistership_tests::synthetic::replica;
use sistership_tests::truth::files::{write_trials, write_vessel};
use sistership_tests::truth::instruments::Instruments;
use sistership_tests::truth::manoeuvre::{Approach, Manoeuvre, figures};
use sistership_tests::truth::motion::Truth;

use crate::call;
use crate::figures::{Bands, bands};

/// What is sailed before anything is planned.
const FIRST: [Manoeuvre; 2] = [Manoeuvre::Zigzag(20.0, 20.0), Manoeuvre::Turn(35.0)];

/// Lengths of the recorded approach, as a plan has it.
const APPROACH: f64 = 2.0;

/// A manoeuvre as a programme has it.
struct Ordered {
    manoeuvre: Manoeuvre,
    speed: f64,
    duration_s: f64,
}

/// What came of a ship.
pub struct Outcome {
    pub name: String,
    pub truth: BTreeMap<String, f64>,
    /// Bands on the first trials, after the plan, after IMO's manoeuvres.
    pub first: Bands,
    pub planned: Bands,
    pub standard: Bands,
    pub plan: Value,
}

/// Runs a ship.
///
/// # Errors
/// A call refuses.
pub fn run(ship: &dyn Truth, seed: u64, budget_min: f64) -> Result<Outcome, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let vessel = write_vessel(folder.path(), ship.dimensions());
    let place = |name: &str| {
        let place = folder.path().join(name);
        std::fs::create_dir(&place).expect("a folder");
        place
    };
    let time_s = ship.dimensions().length_time_s();
    let ordered = |manoeuvre: Manoeuvre, lengths: f64| Ordered {
        manoeuvre,
        speed: 1.0,
        duration_s: lengths * time_s,
    };
    let first: Vec<Ordered> =
        FIRST.map(|manoeuvre| ordered(manoeuvre, manoeuvre.lengths())).into_iter().collect();
    let sailed = trials(ship, &first, seed, 0);
    let refined = |name: &str, more: &[Ordered], number: usize| -> Result<PathBuf, String> {
        let more = trials(ship, more, seed, number);
        let all: Vec<&Trial> = sailed.iter().chain(&more).collect();
        refined(&vessel, &ship.dimensions().name, &place(name), &all)
    };
    let model = refined("first", &[], 0)?;
    let plan = call::plan(&model, budget_min)?;
    let planned = refined("planned", &of_plan(&plan, ship), 1)?;
    let standard = refined("standard", &of_standard(&plan), 2)?;
    let of = |model: &Path| call::bands(model).map(|document| bands(&document));
    Ok(Outcome {
        name: ship.dimensions().name.clone(),
        truth: figures(ship),
        first: of(&model)?,
        planned: of(&planned)?,
        standard: of(&standard)?,
        plan,
    })
}

/// A programme as the instruments record it.
fn trials(ship: &dyn Truth, programme: &[Ordered], seed: u64, number: usize) -> Vec<Trial> {
    let one = |(place, ordered): (usize, &Ordered)| {
        let approach = Approach { speed: ordered.speed, lengths: APPROACH };
        let track = ordered.manoeuvre.sailed_for(ship, approach, ordered.duration_s);
        let name = format!("{number}_{place}_{}.csv", ordered.manoeuvre.name());
        let mut rng = replica(seed, 1000 * number + place);
        Instruments::of(ship).record(ship, &name, &track, &mut rng)
    };
    programme.iter().enumerate().map(one).collect()
}

fn refined(vessel: &Path, name: &str, folder: &Path, trials: &[&Trial]) -> Result<PathBuf, String> {
    let manifest = write_trials(folder, name, trials);
    let out = folder.join("model.yaml");
    call::refine(vessel, &manifest, &out)?;
    Ok(out)
}

/// The trials of a plan.
fn of_plan(plan: &Value, ship: &dyn Truth) -> Vec<Ordered> {
    let number = |value: &Value| value.as_f64().expect("a number");
    let one = |trial: &Value| Ordered {
        manoeuvre: match trial["switch_deg"].as_f64() {
            Some(switch) => Manoeuvre::Zigzag(number(&trial["rudder_deg"]), switch),
            None => Manoeuvre::Turn(number(&trial["rudder_deg"])),
        },
        speed: number(&trial["speed_m_s"]) / ship.dimensions().speed_m_s,
        duration_s: 60.0 * number(&trial["manoeuvre_min"]),
    };
    plan["trials"].as_array().expect("trials").iter().map(one).collect()
}

/// IMO's manoeuvres in the same time.
fn of_standard(plan: &Value) -> Vec<Ordered> {
    let trials = plan["standard"]["trials"].as_array().expect("trials");
    let one = |trial: &Value| Ordered {
        manoeuvre: named(trial["manoeuvre"].as_str().expect("a name")),
        speed: 1.0,
        duration_s: 60.0 * trial["manoeuvre_min"].as_f64().expect("a number"),
    };
    trials.iter().map(one).collect()
}

/// `turn 35 deg` or `zigzag -10/10`.
fn named(name: &str) -> Manoeuvre {
    let words: Vec<&str> = name.split([' ', '/']).collect();
    let number = |place: usize| words[place].parse::<f64>().expect("a number");
    if words[0] == "turn" {
        Manoeuvre::Turn(number(1))
    } else {
        Manoeuvre::Zigzag(number(1), number(2))
    }
}
