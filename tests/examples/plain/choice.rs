//! The plain call against the best of every explicit one, known in hindsight.

use rayon::prelude::*;
use sistership_tests::truth::container::container;
use sistership_tests::truth::ferry::ferry;
use sistership_tests::truth::model_tanker::model_tanker;
use sistership_tests::truth::tanker::tanker;

use crate::arguments::Arguments;
use crate::call::{Call, METHODS, Made};
use crate::data::DataSet;
use crate::data::esso_osaka::{FOLDS, esso_osaka};
use crate::data::sr108::sr108;
use crate::data::synthetic::synthetic;
use crate::judge::{Judged, errors};
use crate::program::Program;
use crate::sources::{names, unrefined};

/// The data sets.
const NAMES: [&str; 6] = ["sr108", "esso-osaka", "tanker", "ferry", "container", "model"];
/// Trials that a call gets of a synthetic ship.
const TRIALS: usize = 6;
/// The plain call may be worse than the best explicit one by so much.
const WITHIN: f64 = 1.10;

/// Prints a row for each data set.
pub fn run(program: &Program, arguments: &Arguments) {
    println!("## Choice: the plain call against every `--source` x `--law` x `--method`\n");
    println!(
        "Standardised mean squared error on unseen trials, mean over u, v, r, psi, x, y; heading \
         as root mean square.\n"
    );
    println!(
        "| data | plain | heading deg | chose | s | MB | unrefined nearest | best explicit | \
         heading deg | s | call | made of tried | plain by best | within 10 % | plain by best of \
         the other half |"
    );
    println!(
        "| --- | --: | --: | --- | --: | --: | --: | --: | --: | --: | --- | --: | --: | --- | \
         --: |"
    );
    let only = arguments.data.as_deref();
    for name in only.map_or(NAMES.to_vec(), |only| vec![only]) {
        match data(name, arguments) {
            Some(data) => row(program, name, &data),
            None => println!("| {name} | skipped: the data are not here |"),
        }
    }
    println!();
}

fn data(name: &str, arguments: &Arguments) -> Option<DataSet> {
    let seed = arguments.seed;
    match name {
        "sr108" => sr108(),
        "esso-osaka" => esso_osaka(Some(0)),
        "tanker" => Some(synthetic(&tanker(), TRIALS, seed)),
        "ferry" => Some(synthetic(&ferry(), TRIALS, seed)),
        "container" => Some(synthetic(&container(), TRIALS, seed)),
        "model" => Some(synthetic(&model_tanker(), TRIALS, seed)),
        "drawn" => Some(synthetic(&*arguments.hull.ship(seed), TRIALS, seed)),
        _ => panic!("--data is one of {} or drawn, not {name}", NAMES.join(", ")),
    }
}

fn row(program: &Program, name: &str, data: &DataSet) {
    // Alone on the machine, as far as this process goes: its time counts.
    let (plain, _) = Call::default().refine(program, data);
    let nearest = unrefined(program, data).nearest;
    let calls = explicit(data);
    let tried = calls.len();
    let made: Vec<(Call, Made)> = calls
        .into_par_iter()
        .map(|call| {
            let (made, _) = call.refine(program, data);
            eprintln!("{name} | {} | {} | {:.1} s", call.name(), cells(&made), made.wall_s);
            (call, made)
        })
        .collect();
    let judged = |made: &Made| made.judged.as_ref().ok().map(|judged| judged.error);
    let count = made.iter().filter(|(_, made)| judged(made).is_some()).count();
    let key = |(_, made): &&(Call, Made)| judged(made).unwrap_or(f64::INFINITY);
    let best = made.iter().min_by(|a, b| key(a).total_cmp(&key(b)));
    let (call, best) = best.map(|(call, made)| (call.name(), made)).expect("a call");
    let ratio = judged(&plain).zip(judged(best)).map(|(plain, best)| plain / best);
    let blind = plain.judged.as_ref().ok().map(|plain| by_other_half(plain, &made));
    let verdict = if ratio.is_some_and(|ratio| ratio <= WITHIN) { "yes" } else { "no" };
    println!(
        "| {name} | {} | {} | {:.1} | {:.0} | {} | {} | {:.1} | {call} | {count} of {tried} | {} | \
         {verdict} | {} |",
        cells(&plain),
        plain.chosen,
        plain.wall_s,
        plain.peak_mb,
        number(nearest),
        cells(best),
        best.wall_s,
        ratio.map_or("-".into(), |ratio| format!("{ratio:.2}")),
        blind.map_or("-".into(), |[first, second]| format!("{first:.2}, {second:.2}")),
    );
}

/// The plain call's error on each half of the unseen trials by that of the explicit call that is
/// best on the other half: what the flags can get where hindsight does not judge itself.
fn by_other_half(plain: &Judged, made: &[(Call, Made)]) -> [f64; 2] {
    let judged = || made.iter().filter_map(|(_, made)| made.judged.as_ref().ok());
    [0, 1].map(|half| {
        let key = |judged: &&Judged| judged.halves[1 - half];
        let best = judged().min_by(|a, b| key(a).total_cmp(&key(b)));
        best.map_or(f64::NAN, |best| plain.halves[half] / best.halves[half])
    })
}

fn cells(made: &Made) -> String {
    match &made.judged {
        Ok(judged) => format!("{:.4} | {:.2}", judged.error, judged.heading_deg),
        Err(reason) => format!("none: {} | -", reason.chars().take(80).collect::<String>()),
    }
}

fn number(value: Option<f64>) -> String {
    value.map_or_else(|| "-".into(), |value| format!("{value:.4}"))
}

/// Every source with its own law and with every other, and none with every law, by every method
/// that takes seconds.
fn explicit(data: &DataSet) -> Vec<Call> {
    let laws: Vec<String> = data.zoo.laws().map(|law| law.name.clone()).collect();
    let mut calls = Vec::new();
    let sources: Vec<Option<String>> = names(data).into_iter().map(Some).chain([None]).collect();
    for source in sources {
        let own =
            source.as_ref().and_then(|name| data.zoo.find_model(name).ok()).map(|model| model.law);
        let others = laws.iter().filter(|law| Some(*law) != own.as_ref()).cloned().map(Some);
        for law in others.chain(own.as_ref().map(|_| None)) {
            for method in METHODS {
                let (source, law) = (source.clone(), law.clone());
                calls.push(Call { source, law, method: Some(method.to_owned()), zoo: None });
            }
        }
    }
    calls
}

/// Esso Osaka by the plain call alone: every file judged by a model that was made without it, and
/// the time for all of them.
pub fn by_file(program: &Program) {
    let folds: Option<Vec<DataSet>> = (0..FOLDS).map(|fold| esso_osaka(Some(fold))).collect();
    let (Some(folds), Some(all)) = (folds, esso_osaka(None)) else { return };
    let whole = Call::default().refine(program, &all).0;
    let mut sum = sistership_simulation::error::SquaredError::default();
    let mut failed = Vec::new();
    for fold in &folds {
        match model_errors(program, fold) {
            Ok(errors) => sum.add(&errors),
            Err(reason) => failed.push(reason),
        }
    }
    let error = sistership_simulation::error::standardised_mse(&sum, &all.deviations) / 6.0;
    println!(
        "\nEsso Osaka by the plain call, every file judged by a model made without it: {error:.4} \
         (aim: at most 0.028){}; all {} files: {:.1} s, {:.0} MB (aim: at most 8 s, 300 MB).",
        if failed.is_empty() { String::new() } else { format!(", without {}", failed.join("; ")) },
        all.seen.len(),
        whole.wall_s,
        whole.peak_mb
    );
}

fn model_errors(
    program: &Program,
    data: &DataSet,
) -> Result<sistership_simulation::error::SquaredError, String> {
    let (made, folder) = Call::default().refine(program, data);
    made.judged?;
    let model = crate::call::read_model(&data.zoo, &folder.path().join(crate::call::MODEL))?;
    errors(&model, data)
}
