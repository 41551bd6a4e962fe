//! What the plain call selects and what its models leave on manoeuvres that it did not see, of
//! ships with equations that no law of the library has: the four of `truth`, the same with a rudder
//! that stalls, and with a propeller that pushes the stern to one side.
//!
//! `cargo run -p sistership-tests --example selection -- [TRIALS [SEEDS [SHIPS]]]`; the program is
//! the one that `SISTERSHIP_PROGRAM` names, else that of this tree.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use serde_json::Value;
use sistership_identification::refine::RefinementSettings;
use sistership_learned::{BranchKind, BranchSettings, train_corrected_model};
use sistership_model::trial::Channel;
use sistership_model::{Model, Trial, Vessel, Zoo};
use sistership_model_selection::{StartRequest, best_start};
use sistership_simulation::Ship;
use sistership_simulation::error::{SquaredError, standard_deviations, standardised_mse};
use sistership_simulation::recorded::{ReplaySettings, replay_trial};
use sistership_simulation::state::{StateVector, at, straight_state};

#[path = "../src/esso_osaka.rs"]
#[allow(dead_code, unused_imports)]
mod esso_osaka;
#[path = "../src/synthetic.rs"]
#[allow(dead_code, unused_imports)]
mod synthetic;
#[path = "../src/truth/mod.rs"]
#[allow(dead_code, unused_imports)]
mod truth;

use truth::container::container;
use truth::dimensions::Dimensions;
use truth::family::single_screw;
use truth::ferry::ferry;
use truth::files::{vessel, write_trials};
use truth::instruments::Instruments;
use truth::manoeuvre::{PROGRAMME, UNSEEN};
use truth::model_tanker::model_tanker;
use truth::motion::{Inertia, Truth};
use truth::stalled::Stalled;
use truth::tanker::tanker;
use truth::trials;

/// A ship with its trials and those that it is judged on.
struct Case {
    vessel: String,
    seen: Vec<Trial>,
    unseen: Vec<Trial>,
    restart_s: f64,
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let numbers = |place: usize, default: &str| -> Vec<u64> {
        let text = arguments.get(place).map_or(default, String::as_str);
        text.split(',').map(|number| number.parse().expect("numbers, with commas")).collect()
    };
    let (counts, seeds) = (numbers(0, "12"), numbers(1, "1"));
    let wanted = arguments.get(2).map_or("", String::as_str);
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    println!(
        "| ship | seed | trials | selected | fitted | held out | unseen | heading, deg | best \
         correction | held out | taken | unseen | heading, deg | s |"
    );
    println!(
        "| --- | --: | --: | --- | --: | --: | --: | --: | --- | --: | --- | --: | --: | --: |"
    );
    let mut sums: BTreeMap<u64, Vec<f64>> = BTreeMap::new();
    for name in NAMES.into_iter().filter(|name| wanted.split('/').any(|part| name.contains(part))) {
        for &seed in &seeds {
            let case = case(&zoo, name, seed);
            for count in counts
                .iter()
                .filter(|_| name != "esso-osaka")
                .copied()
                .chain((name == "esso-osaka").then_some(case.seen.len() as u64))
            {
                let seen: Vec<&Trial> = case.seen.iter().take(count as usize).collect();
                let (row, error) = row(&zoo, &case, &seen);
                println!("| {name} | {seed} | {count} | {row} |");
                sums.entry(count).or_default().push(error.ln());
            }
        }
    }
    for (count, logs) in sums {
        let mean = (logs.iter().sum::<f64>() / logs.len() as f64).exp();
        println!("\n{count} trials, {} cases: {mean:.6} in the geometric mean", logs.len());
    }
}

const NAMES: [&str; 14] = [
    "tanker",
    "ferry",
    "container ship",
    "model",
    "tanker, stalls",
    "ferry, stalls",
    "container ship, stalls",
    "model, stalls",
    "tanker, walks",
    "ferry, walks",
    "container ship, walks",
    "model, walks",
    "family",
    "esso-osaka",
];

fn ship(name: &str, seed: u64) -> Box<dyn Truth> {
    match name {
        "tanker" => Box::new(tanker()),
        "ferry" => Box::new(ferry()),
        "container ship" => Box::new(container()),
        "model" => Box::new(model_tanker()),
        "tanker, stalls" => Box::new(Stalled(tanker())),
        "ferry, stalls" => Box::new(Stalled(ferry())),
        "container ship, stalls" => Box::new(Stalled(container())),
        "model, stalls" => Box::new(Stalled(model_tanker())),
        "tanker, walks" => Box::new(Walking(tanker())),
        "ferry, walks" => Box::new(Walking(ferry())),
        "container ship, walks" => Box::new(Walking(container())),
        "model, walks" => Box::new(Walking(model_tanker())),
        _ => Box::new(single_screw(seed)),
    }
}

fn case(zoo: &Zoo, name: &str, seed: u64) -> Case {
    if name == "esso-osaka" {
        return measured(zoo, seed);
    }
    let ship = ship(name, seed);
    let instruments = Instruments::of(&*ship);
    Case {
        vessel: vessel(ship.dimensions()),
        seen: trials(&*ship, &PROGRAMME, &instruments, seed),
        unseen: trials(&*ship, &UNSEEN, &instruments.without_noise(), seed),
        restart_s: 10.0 * ship.dimensions().length_time_s(),
    }
}

/// Esso Osaka: every fourth file is unseen.
fn measured(zoo: &Zoo, fold: u64) -> Case {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/esso-osaka");
    let all = esso_osaka::trials(&folder, &["random", "turning", "zigzag", "berthing"]);
    let is_out = |k: usize, trial: &Trial| {
        let part = if trial.name.contains("15_58_08") { 0 } else { k as u64 % 4 };
        part == fold % 4
    };
    let all = all.into_iter().enumerate();
    let (unseen, seen): (Vec<_>, Vec<_>) = all.partition(|(k, trial)| is_out(*k, trial));
    let trials = |all: Vec<(usize, Trial)>| all.into_iter().map(|(_, trial)| trial).collect();
    let vessel = zoo.vessel("esso-osaka-3m").map(|vessel| vessel.name().to_owned());
    Case {
        vessel: vessel.expect("a ship of the zoo"),
        seen: trials(seen),
        unseen: trials(unseen),
        restart_s: 100.0,
    }
}

/// A ship whose propeller pushes the stern to one side as much as a rudder angle would that is not
/// amidships, and whose rudder does more to one side than to the other.
struct Walking<T>(T);

/// That angle, rad, and the share by which the rudder does more to starboard; chosen.
const WALK_RAD: f64 = 3.0 * std::f64::consts::PI / 180.0;
const MORE: f64 = 0.1;

impl<T: Truth> Truth for Walking<T> {
    fn dimensions(&self) -> &Dimensions {
        self.0.dimensions()
    }

    fn accelerations(&self, state: &StateVector, n_rps: f64) -> [f64; 4] {
        let mut acted = *state;
        acted[at::DELTA] += MORE * state[at::DELTA].abs();
        let ahead = straight_state(self.dimensions().speed_m_s);
        let mut turned = ahead;
        turned[at::DELTA] = WALK_RAD;
        let by_ship = self.0.accelerations(&acted, n_rps);
        let [walk, none] = [turned, ahead].map(|state| self.0.accelerations(&state, n_rps));
        std::array::from_fn(|axis| by_ship[axis] + walk[axis] - none[axis])
    }

    fn inertia(&self) -> &Inertia {
        self.0.inertia()
    }

    fn revolutions_rps(&self) -> f64 {
        self.0.revolutions_rps()
    }

    fn rudder_rate_rad_s(&self) -> f64 {
        self.0.rudder_rate_rad_s()
    }
}

fn row(zoo: &Zoo, case: &Case, seen: &[&Trial]) -> (String, f64) {
    let begun = Instant::now();
    let (ladder, model) = refined(zoo, case, seen);
    let took_s = begun.elapsed().as_secs_f64();
    let alone = judged(zoo, &model.without_correction(), case);
    let lines = ladder["lines"].as_array().cloned().unwrap_or_default();
    let chosen = lines.iter().find(|line| line["chosen"] == true).cloned().unwrap_or_default();
    let text = |value: &Value| value.as_str().unwrap_or("none").to_owned();
    let row = format!(
        "{}, {}, {} | {} | {:.5} | {:.6} | {:.2} | {} | {took_s:.1}",
        text(&chosen["source"]),
        text(&chosen["law"]),
        text(&chosen["rung"]),
        chosen["coefficients"],
        chosen["error"].as_f64().unwrap_or(f64::NAN),
        alone.0,
        alone.1,
        correction(zoo, (&ladder, &model), (case, seen))
    );
    (row, alone.0)
}

/// The kind of correction that left least on trials held out, whether it was taken, and what it
/// leaves on unseen manoeuvres where it is taken all the same.
fn correction(
    zoo: &Zoo,
    (ladder, model): (&Value, &Model),
    (case, seen): (&Case, &[&Trial]),
) -> String {
    let choice = &ladder["branch"];
    let tried = choice["tried"].as_array().cloned().unwrap_or_default();
    let error = |one: &Value| one["branch"].as_f64().unwrap_or(f64::INFINITY);
    let best = tried.iter().min_by(|a, b| error(a).total_cmp(&error(b)));
    eprintln!("{}", choice["reason"].as_str().unwrap_or_default());
    let Some(best) = best else { return "- | - | - | - | -".to_owned() };
    let kind: BranchKind = serde_json::from_value(best["kind"].clone()).expect("a kind");
    let law = zoo.law(&model.law).expect("a law of the zoo");
    let foundation = model.without_correction();
    let training =
        BranchSettings::default().with_kind(kind).complete_training(&foundation, law, seen);
    let training = training.unwrap_or_else(|error| panic!("{error}"));
    let both = train_corrected_model(&foundation, law, seen, &training);
    let both = judged(zoo, &both.unwrap_or_else(|error| panic!("{error}")), case);
    let taken = if choice["taken"].is_null() { "no" } else { "yes" };
    format!(
        "{} | {:.5} of {:.5} | {taken} | {:.6} | {:.2}",
        kind.name(),
        error(best),
        best["foundation"].as_f64().unwrap_or(f64::NAN),
        both.0,
        both.1
    )
}

/// What the plain call tried, and its model.
fn refined(zoo: &Zoo, case: &Case, seen: &[&Trial]) -> (Value, Model) {
    if let Some(program) = std::env::var_os("SISTERSHIP_PROGRAM") {
        return by_program(zoo, (case, seen), Path::new(&program));
    }
    let named = zoo.vessel(&case.vessel).map(|vessel| (**vessel).clone());
    let target = named.unwrap_or_else(|| {
        Vessel::parse("ship.yaml", &case.vessel).unwrap_or_else(|error| panic!("{error}"))
    });
    let (champions, settings) = (BTreeMap::new(), RefinementSettings::default());
    let asked = StartRequest {
        zoo,
        target: &target,
        champions: &champions,
        trials: seen,
        settings: &settings,
        preference: Default::default(),
    };
    let start = best_start(&asked, &|_, _| true).unwrap_or_else(|error| panic!("{error}"));
    if std::env::var_os("LADDER").is_some() {
        for line in &start.ladder.lines {
            eprintln!("{line:?}");
        }
        eprintln!("{}\n{:?}", start.ladder.reference_summary(), start.settings);
        for option in &start.refinement.options {
            eprintln!("{option:?}");
        }
    }
    let ladder = serde_json::to_value(&start.ladder).expect("JSON");
    (ladder, start.refinement.model)
}

fn by_program(zoo: &Zoo, (case, seen): (&Case, &[&Trial]), program: &Path) -> (Value, Model) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let ship = match zoo.vessel(&case.vessel) {
        Some(_) => case.vessel.clone(),
        None => {
            std::fs::write(path("ship.yaml"), &case.vessel).expect("a file");
            path("ship.yaml")
        }
    };
    let named =
        |(k, trial): (usize, &&Trial)| Trial { name: format!("{k}.csv"), ..(*trial).clone() };
    let trials: Vec<Trial> = seen.iter().enumerate().map(named).collect();
    let trials: Vec<&Trial> = trials.iter().collect();
    write_trials(folder.path(), "a", &trials);
    let (manifest, out) = (path("trials.yaml"), path("model.yaml"));
    let words = ["refine", "--ship", &ship, "--trials", &manifest, "--out", &out, "--json"];
    let output = Command::new(program).args(words).output().expect("the program runs");
    let answer: Value = serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|_| panic!("{}", String::from_utf8_lossy(&output.stderr)));
    let text = std::fs::read_to_string(&out).expect("a model");
    let model = Model::parse("model.yaml", &text, &|law| zoo.law(law).map(|law| (**law).clone()));
    (answer["ladder"].clone(), model.unwrap_or_else(|error| panic!("{error}")))
}

/// The mean over u, v, r, psi, x, y of the standardised squared error of simulations that start
/// anew every ten lengths, and the root mean square of the heading of whole ones, deg. One that
/// leaves the physical range counts as 10.
fn judged(zoo: &Zoo, model: &Model, case: &Case) -> (f64, f64) {
    let law = zoo.law(&model.law).expect("a law of the zoo");
    let mut ship = Ship::new(model, law).unwrap_or_else(|error| panic!("{error}"));
    let fastest = |trial: &Trial| {
        let speeds = trial.channel(Channel::U).into_iter().flatten();
        speeds.fold(0.0, |most: f64, u| most.max(u.abs()))
    };
    ship.set_envelope_speed(case.unseen.iter().map(fastest).fold(0.0, f64::max));
    let errors = |restart_s: Option<f64>| {
        let settings = ReplaySettings { restart_s, ..ReplaySettings::default() };
        let mut sum = SquaredError::default();
        for trial in &case.unseen {
            let run =
                replay_trial(&ship, trial, &settings).unwrap_or_else(|error| panic!("{error}"));
            if run.stopped.is_some() {
                return None;
            }
            sum.add(&SquaredError::from_trial(trial, &run));
        }
        Some(sum)
    };
    let all: Vec<&Trial> = case.seen.iter().chain(&case.unseen).collect();
    let by = if case.restart_s == 100.0 { all } else { case.unseen.iter().collect() };
    let deviations = standard_deviations(&by);
    let error =
        errors(Some(case.restart_s)).map_or(10.0, |sum| standardised_mse(&sum, &deviations) / 6.0);
    let heading = errors(None).and_then(|sum| sum.channel_rmse(Channel::Psi));
    (error, heading.map_or(180.0, f64::to_degrees))
}
