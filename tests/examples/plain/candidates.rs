//! Random candidates among the sources: does the choice get worse?

use std::path::{Path, PathBuf};

use rand::RngExt;
use rand_chacha::ChaCha12Rng;
use rand_distr::StandardNormal;
use serde_json::{Value, json};
use sistership_model::{Model, Zoo};
use sistership_tests::synthetic::{relative, replica};
use sistership_tests::truth::dimensions::Dimensions;
use sistership_tests::truth::files::particulars;

use crate::arguments::Arguments;
use crate::call::Call;
use crate::data::synthetic::synthetic;
use crate::program::Program;
use crate::statistics::{counted, geometric_mean, largest, median};
use crate::yard;

/// Candidates that are added.
const CANDIDATES: usize = 200;
/// Trials that a call gets.
const TRIALS: usize = 6;
/// Standard deviation of their coefficients by those of the zoo's models, and of their particulars
/// by the ship's.
const SCATTER: [f64; 2] = [0.3, 0.06];
/// The mean error may rise by so much.
const RISE: f64 = 1.03;

/// Prints the rise of the error.
pub fn run(program: &Program, arguments: &Arguments) {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let models = drawn(&zoo, arguments.seed);
    let ships = yard::each(arguments, |seed, ship| {
        let data = synthetic(ship, TRIALS, seed);
        let folder = written(data.folder(), &models, ship.dimensions(), seed);
        let error = |zoo: Option<PathBuf>| {
            let call = Call { zoo, ..Call::default() };
            counted(call.refine(program, &data).0.judged.ok().map(|judged| judged.error))
        };
        let errors = [error(None), error(Some(folder))];
        eprintln!("ship {seed} | {errors:?}");
        errors
    });
    let column = |place: usize| ships.iter().map(|errors| errors[place]).collect::<Vec<_>>();
    let ratios: Vec<f64> = ships.iter().map(|[without, with]| with / without).collect();
    let rise = geometric_mean(&ratios);
    println!("## Candidates: {CANDIDATES} random ones among the sources, {} ships\n", ships.len());
    println!(
        "| error without | with | rise | median | largest | less than 3 % |\n| --: | --: | --: | \
         --: | --: | --- |"
    );
    println!(
        "| {:.4} | {:.4} | {rise:.3} | {:.3} | {:.2} | {} |\n",
        geometric_mean(&column(0)),
        geometric_mean(&column(1)),
        median(&ratios),
        largest(&ratios),
        if rise < RISE { "yes" } else { "no" }
    );
}

/// Models of the zoo with every coefficient scattered, each of which sails the standard manoeuvres.
fn drawn(zoo: &Zoo, seed: u64) -> Vec<Model> {
    let published: Vec<Model> =
        zoo.vessels().filter_map(|vessel| zoo.published_model(vessel, None).ok()).collect();
    let one = |k: usize| {
        let model = &published[k % published.len()];
        let law = zoo.law(&model.law).expect("the law of a zoo model");
        relative(model, law, SCATTER[0], &mut replica(seed, 1000 + k))
    };
    (0..CANDIDATES).map(one).collect()
}

/// A folder for `--zoo` with a vessel file for each candidate, of about the size of the ship.
fn written(folder: &Path, models: &[Model], ship: &Dimensions, seed: u64) -> PathBuf {
    let zoo = folder.join("candidates");
    std::fs::create_dir_all(zoo.join("vessels")).expect("a folder");
    let mut rng = replica(seed, 5);
    for (k, model) in models.iter().enumerate() {
        let name = format!("candidate-{k}");
        let text = vessel(&name, model, &like(ship, &mut rng)).to_string();
        std::fs::write(zoo.join(format!("vessels/{name}.yaml")), text).expect("a candidate");
    }
    zoo
}

fn like(ship: &Dimensions, rng: &mut ChaCha12Rng) -> Dimensions {
    let mut factor = || 1.0 + SCATTER[1] * rng.sample::<f64, _>(StandardNormal).clamp(-2.0, 2.0);
    let mut other = ship.clone();
    other.lpp_m *= factor();
    other.beam_m *= factor();
    other.draught_m *= factor();
    other.block_coefficient = (other.block_coefficient * factor()).clamp(0.5, 0.88);
    other.rudder_area_m2 *= factor();
    other
}

/// A vessel file: JSON is YAML.
fn vessel(name: &str, model: &Model, size: &Dimensions) -> Value {
    let section =
        |values: serde_json::Map<String, Value>| json!({ "source": "drawn", "values": values });
    let plain = |values: &mut dyn Iterator<Item = (String, f64)>| {
        section(values.map(|(name, value)| (name, json!(value))).collect())
    };
    let steering = &model.steering;
    json!({
        "kind": "vessel",
        "name": name,
        "title": "Random candidate",
        "category": size.category,
        "sources": { "drawn": { "citation": "Drawn at random about a ship of the zoo" } },
        "conventions": { "rudder_positive": "starboard_turn" },
        "particulars": plain(&mut particulars(size).into_iter().map(|(n, v)| (n.to_owned(), v))),
        "models": [{
            "name": "drawn",
            "law": model.law,
            "status": "estimated",
            "speed_m_s": model.speed_m_s,
            "revolutions_rps": model.revolutions_rps,
            "steering": {
                "limit_deg": steering.limit_deg,
                "rate_deg_s": steering.rate_deg_s,
                "time_constant_s": steering.time_constant_s,
                "source": "drawn",
            },
            "parameters": plain(&mut model.parameters.iter().map(|(n, q)| (n.clone(), q.value))),
            "coefficients": plain(&mut model.coefficients.iter().map(|(n, q)| (n.clone(),
            q.value))),
        }],
    })
}
