//! The error on unseen trials by the number of trials that a call gets.

use crate::arguments::Arguments;
use crate::call::{Call, METHODS};
use crate::data::synthetic::synthetic;
use crate::program::Program;
use crate::sources::{Unrefined, unrefined};
use crate::statistics::{counted, geometric_mean, largest, median};
use crate::yard;

/// Numbers of trials.
const COUNTS: [usize; 5] = [1, 2, 4, 8, 12];
/// The plain call may be worse than the source as it is by so much.
const SLACK: f64 = 1.05;

/// One ship with one number of trials.
struct Outcome {
    /// Errors by the calls, in their order; absent where a call makes no model that sails.
    errors: Vec<Option<f64>>,
    unrefined: Unrefined,
}

/// Prints a row for each call.
pub fn run(program: &Program, arguments: &Arguments) {
    let calls = if arguments.alone { vec![Call::default()] } else { calls() };
    let ships = yard::each(arguments, |seed, ship| {
        COUNTS.map(|count| {
            let data = synthetic(ship, count, seed);
            let error = |call: &Call| call.refine(program, &data).0.judged.ok().map(|j| j.error);
            let errors: Vec<Option<f64>> = calls.iter().map(error).collect();
            let unrefined = unrefined(program, &data);
            eprintln!("ship {seed} | {count} | {:?} | {:?}", errors[0], unrefined.nearest);
            Outcome { errors, unrefined }
        })
    });
    println!(
        "## Learning: geometric mean over {} ships of the error on unseen trials\n",
        ships.len()
    );
    println!(
        "A call without a model that sails counts as {}; in brackets, how many of them.\n",
        crate::statistics::WORST
    );
    println!("| call | 1 trial | 2 | 4 | 8 | 12 |\n| --- | --: | --: | --: | --: | --: |");
    for (place, call) in calls.iter().enumerate() {
        row(&call.name(), &ships, |outcome| outcome.errors[place]);
    }
    row("nearest source, unrefined", &ships, |outcome| outcome.unrefined.nearest);
    row("best source in hindsight, unrefined", &ships, |outcome| outcome.unrefined.best);
    against_the_source(&ships);
}

/// The plain one, and every fixed choice: the source that the program takes, or none, under its own
/// law or a general one.
fn calls() -> Vec<Call> {
    let mut calls = vec![Call::default()];
    let auto = Some("auto".to_owned());
    let kinds = [
        (auto.clone(), None),
        (auto.clone(), Some("low-speed")),
        (auto, Some("abkowitz")),
        (None, Some("low-speed")),
        (None, Some("abkowitz")),
    ];
    for (source, law) in kinds {
        for method in METHODS {
            let (law, method) = (law.map(str::to_owned), Some(method.to_owned()));
            calls.push(Call { source: source.clone(), law, method, zoo: None });
        }
    }
    calls
}

fn row(name: &str, ships: &[[Outcome; 5]], of: impl Fn(&Outcome) -> Option<f64>) {
    let cell = |place: usize| {
        let errors: Vec<Option<f64>> = ships.iter().map(|outcomes| of(&outcomes[place])).collect();
        let none = errors.iter().filter(|error| error.is_none()).count();
        let mean = geometric_mean(&errors.into_iter().map(counted).collect::<Vec<_>>());
        if none == 0 { format!("{mean:.4}") } else { format!("{mean:.4} ({none})") }
    };
    let cells: Vec<String> = (0..COUNTS.len()).map(cell).collect();
    println!("| {name} | {} |", cells.join(" | "));
}

/// The plain call by the unrefined nearest source, ship by ship.
fn against_the_source(ships: &[[Outcome; 5]]) {
    println!(
        "\nThe plain call's error by that of the nearest source, unrefined, of ships that have \
         one:\n"
    );
    println!(
        "| trials | ships | median | largest | worse by more than 5 % |\n| --: | --: | --: | --: | \
         --: |"
    );
    for (place, count) in COUNTS.iter().enumerate() {
        let ratio = |outcomes: &[Outcome; 5]| {
            let Outcome { errors, unrefined } = &outcomes[place];
            Some(counted(errors[0]) / counted(Some(unrefined.nearest?)))
        };
        let ratios: Vec<f64> = ships.iter().filter_map(ratio).collect();
        let worse = ratios.iter().filter(|ratio| **ratio > SLACK).count();
        let (middle, most) = (median(&ratios), largest(&ratios));
        println!("| {count} | {} | {middle:.2} | {most:.2} | {worse} |", ratios.len());
    }
    println!();
}
