//! `trajectory` against `cma-es`: hundreds of coefficients of an Abkowitz-MMG hybrid from two hours
//! of random manoeuvres.
//!
//! `cargo run --release -p sistership-tests --example hybrid_race -- --minutes 60 --out race` makes
//! the trials of a modular MMG model, refines the derived law of third order without a source by
//! either method, and keeps what each passes by: seconds, evaluations, its own objective, and the
//! error of simulations of manoeuvres that neither has seen (standardised mean squared error of u,
//! v and r together, started anew every 100 s). The curves in the folder are complete whenever it
//! is stopped. On a machine that others use, `--minutes 300 --cpu-minutes 120` gives the search an
//! hour of two cores. `--method trajectory` or `cma-es` runs one of them; `--spread`, `--seed` and
//! `--rk4` change the search.

mod curve;
mod law;
mod truth;

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use sistership_identification::refine::{
    CmaEs, EstimationMethod, FitIterate, RefinementSettings, RefinementSpec, TermFamily,
    refine_watched,
};
use sistership_model::{Law, Model, Trial, Vessel, Zoo};
use sistership_simulation::Method as Integration;
use sistership_simulation::error::standard_deviations;

use curve::{Curve, Folder, held_out_error};

/// Seconds over which simulations are judged.
const SUBSEQUENCE_S: f64 = 100.0;

struct Arguments {
    minutes: f64,
    cpu_minutes: Option<f64>,
    out: String,
    method: Option<EstimationMethod>,
    search: CmaEs,
}

fn main() {
    let arguments = arguments();
    let race = Race::new();
    let folder = Folder::new(&arguments.out);
    println!(
        "{} coefficients, {:.0} s of trials, {:.0} s held out",
        race.blank.coefficients.len(),
        race.duration_s(),
        race.held_out_s()
    );
    let runs = |method: EstimationMethod| arguments.method.is_none_or(|only| only == method);
    for method in [EstimationMethod::Trajectory, EstimationMethod::CmaEs]
        .into_iter()
        .filter(|method| runs(*method))
    {
        race.run(method, &arguments, &folder);
        folder.show();
    }
}

fn arguments() -> Arguments {
    let mut arguments = Arguments {
        minutes: 60.0,
        cpu_minutes: None,
        out: "hybrid-race".into(),
        method: None,
        search: CmaEs::default(),
    };
    let mut given = std::env::args().skip(1);
    while let Some(flag) = given.next() {
        if flag == "--rk4" {
            arguments.search.integration = Integration::Rk4;
            continue;
        }
        let value = given.next().unwrap_or_else(|| panic!("{flag} needs a value"));
        let number = || {
            value.parse::<f64>().unwrap_or_else(|_| panic!("{flag} needs a number, not {value}"))
        };
        match flag.as_str() {
            "--minutes" => arguments.minutes = number(),
            "--cpu-minutes" => arguments.cpu_minutes = Some(number()),
            "--out" => arguments.out = value,
            "--method" => {
                arguments.method = Some(EstimationMethod::by_name(&value).expect("an estimator"))
            }
            "--seed" => arguments.search.seed = number() as u64,
            "--spread" => arguments.search.spread = number(),
            "--box" => arguments.search.box_width = number(),
            _ => panic!(
                "there are --minutes, --cpu-minutes, --out, --method, --seed, --spread, --box and \
                 --rk4, not {flag}"
            ),
        }
    }
    arguments
}

/// Trials, those held out, and a law without coefficients.
struct Race {
    vessel: Arc<Vessel>,
    blank: Model,
    law: Law,
    trials: Vec<Trial>,
    held_out: Vec<Trial>,
}

impl Race {
    fn new() -> Self {
        let zoo = Zoo::load_embedded().expect("the zoo");
        let vessel = zoo.vessel("kvlcc2-7m").expect("a ship of the zoo").clone();
        let truth = zoo.find_model("kvlcc2-7m").expect("a model of the zoo");
        let of_truth = zoo.law(&truth.law).expect("a law of the zoo");
        let law = law::hybrid();
        let trials = truth::trials(&truth, of_truth, 12, 617.0, 1);
        let held_out = truth::trials(&truth, of_truth, 3, 400.0, 2);
        Self { blank: law::blank(&truth, &law), vessel, law, trials, held_out }
    }

    fn duration_s(&self) -> f64 {
        self.trials.iter().map(Trial::duration_s).sum()
    }

    fn held_out_s(&self) -> f64 {
        self.held_out.iter().map(Trial::duration_s).sum()
    }

    fn run(&self, method: EstimationMethod, arguments: &Arguments, folder: &Folder) {
        let training: Vec<&Trial> = self.trials.iter().collect();
        let deviations = standard_deviations(&training);
        let curve = Mutex::new(Curve::new(method.name(), folder));
        let settings = settings(method, arguments);
        let request = RefinementSpec {
            target: &self.vessel,
            source: &self.blank,
            source_law: None,
            law: &self.law,
            trials: &training,
            population: &[],
            settings: &settings,
        };
        let look = |glimpse: &FitIterate<'_>| {
            let error = || {
                held_out_error(
                    &(glimpse.model)(),
                    &self.law,
                    &self.held_out,
                    &deviations,
                    SUBSEQUENCE_S,
                )
            };
            curve.lock().expect("a curve").see(
                glimpse.evaluations,
                glimpse.objective,
                method == EstimationMethod::Trajectory,
                &error,
            );
        };
        // The race ends with the fit on all trials: fits with trials left out, with which a search
        // is weighed, are not part of it.
        let over = AtomicBool::new(false);
        let progress = |_: f64, what: &str| {
            eprintln!("\r{} {what}        ", method.name());
            let stop = what.starts_with("the search without");
            over.fetch_or(stop, Ordering::Relaxed);
            !stop
        };
        let refined = refine_watched(&request, &progress, &look);
        let mut curve = curve.into_inner().expect("a curve");
        match refined {
            Ok(refinement) => {
                println!("{}: took {}", method.name(), chosen(&refinement.options));
                for option in &refinement.options {
                    println!(
                        "  {:<36} error {:?} {}",
                        option.step,
                        option.error,
                        option.reason.as_deref().unwrap_or_default()
                    );
                }
                let error = || {
                    held_out_error(
                        &refinement.model,
                        &self.law,
                        &self.held_out,
                        &deviations,
                        SUBSEQUENCE_S,
                    )
                };
                curve.end(&error);
            }
            Err(_) if over.load(Ordering::Relaxed) => {}
            Err(error) => panic!("{}: {error}", method.name()),
        }
    }
}

fn chosen(options: &[sistership_identification::refine::StepOption]) -> &str {
    options.iter().find(|option| option.chosen).map_or("nothing", |option| option.step.as_str())
}

fn settings(method: EstimationMethod, arguments: &Arguments) -> RefinementSettings {
    let search = CmaEs {
        evaluations: usize::MAX,
        wall_s: Some(60.0 * arguments.minutes),
        cpu_s: arguments.cpu_minutes.map(|m| 60.0 * m),
        ..arguments.search.clone()
    };
    let cma_es = (method == EstimationMethod::CmaEs).then_some(search);
    RefinementSettings {
        method,
        families: vec![TermFamily::Own],
        restart_s: Some(SUBSEQUENCE_S),
        folds: 4,
        cma_es,
        ..RefinementSettings::default()
    }
}
