//! How long a refinement takes.

use sistership_identification::refine::{EstimationMethod, RefinementSpec, refine};
use sistership_model::{Trial, Zoo};
use sistership_priors::transfer::{blank_model, trial_approach};
use sistership_tests::{esso_osaka, shared};

use super::compared;
use super::score::KINDS;

/// The files of Wakita et al. 2022's Train-TZRB.
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

/// How long a refinement takes on one core, with the options among which it chooses by trials left
/// out: until the fit is chosen, and with errors, standard manoeuvres and their bands. Run with
/// `--release -- --ignored --nocapture`; it judges nothing.
#[test]
#[ignore = "prints times"]
fn the_time_of_a_fit_on_one_core() {
    let Some(folder) = shared::data("esso-osaka") else { return };
    let all = esso_osaka::trials(&folder, &KINDS);
    let few: Vec<Trial> = all
        .iter()
        .filter(|trial| TZRB.iter().any(|name| trial.name.contains(name)))
        .cloned()
        .collect();
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    for (what, trials) in [("every file", &all), ("Train-TZRB", &few)] {
        for method in [EstimationMethod::Weak, EstimationMethod::Trajectory] {
            let (fit_s, whole_s, taken) = one.install(|| timed(trials, method));
            println!(
                "{what:<10} {:<10} fit {fit_s:.2} s, whole {whole_s:.2} s; taken: {taken}",
                method.name()
            );
        }
    }
}

fn timed(trials: &[Trial], method: EstimationMethod) -> (f64, f64, String) {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let (target, law) = (
        zoo.vessel("esso-osaka-3m").expect("in the zoo"),
        zoo.law("low-speed").expect("in the zoo"),
    );
    let trials: Vec<&Trial> = trials.iter().collect();
    let source =
        blank_model(law, target, trial_approach(&trials)).unwrap_or_else(|error| panic!("{error}"));
    let settings = compared(method);
    let request = RefinementSpec {
        target,
        source: &source,
        source_law: None,
        law,
        trials: &trials,
        population: &[],
        settings: &settings,
    };
    let begun = std::time::Instant::now();
    let fitted_s = std::sync::Mutex::new(0.0);
    let told = |fraction: f64, _: &str| {
        if fraction == 0.9 {
            *fitted_s.lock().unwrap_or_else(std::sync::PoisonError::into_inner) =
                begun.elapsed().as_secs_f64();
        }
        true
    };
    let refinement = refine(&request, &told).unwrap_or_else(|error| panic!("{error}"));
    let taken = refinement
        .options
        .into_iter()
        .find(|option| option.chosen)
        .map_or(String::new(), |option| option.step);
    (fitted_s.into_inner().unwrap_or_default(), begun.elapsed().as_secs_f64(), taken)
}
