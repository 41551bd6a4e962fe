//! The diagnosis by plain calls, on ships whose laws no law of the zoo contains, with effects in
//! forms that no effect of the library has.
//!
//! `cargo run --release -p sistership-tests --example unseen -- work` (or `judgement`: other
//! ships, with cases that are not looked at while the diagnosis is worked on); `--only wind,clean`
//! for the cases whose labels begin so, `--ship NAME`, `--seeds 3` for as many sets of random
//! numbers, `--sizes 1,0.5` for other shares of the size that is hidden, `--limits 0.5,1.5` for
//! effects at shares of the detection limits that the diagnosis of clean trials states, `--winds
//! 5,10,15` for steady winds of these speeds, `--changes true` for what begins within trials or
//! between them, `--clean-sets 10` for so many sets of clean trials of each of twenty ships
//! (`--clean-trials 8`: with models of so many trials), `--drawn 1401,1402` for ships that these numbers draw in place of those of the
//! half (`--hull twin-screw`: with two propellers and rudders), `--program FILE` for another
//! program than this tree's, `--models FOLDER` to keep the refined models there and take them
//! again, `--jobs 2` for cases at once. `docs/evidence/diagnosis_unseen.md` has the results and
//! what they mean.

mod arguments;
mod cases;
mod changing;
mod diagnosed;
mod false_alarms;
mod limits;
mod listed;
mod outcome;
mod program;
mod ships;
mod table;

use std::time::Instant;

use arguments::Arguments;
use cases::Case;
use outcome::Outcome;
use program::Program;
use rayon::prelude::*;
use ships::{Refined, TrueShip};

fn main() {
    let arguments = Arguments::given();
    let program = Program::new(&arguments);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.jobs).build();
    let begun = Instant::now();
    let outcomes = pool.expect("threads").install(|| outcomes(&program, &arguments));
    if arguments.clean_sets > 0 {
        false_alarms::print(&outcomes);
    } else if arguments.limits.is_empty() {
        table::print(&outcomes);
    } else {
        limits::print(&outcomes, &arguments.limits);
    }
    println!("\n{} cases in {:.0} s", outcomes.len(), begun.elapsed().as_secs_f64());
}

fn outcomes(program: &Program, arguments: &Arguments) -> Vec<Outcome> {
    let ships = ships::of(arguments);
    let models: Vec<Refined> = ships.par_iter().map(|ship| ship.refined(program)).collect();
    let pairs: Vec<(&TrueShip, &Refined)> = ships.iter().zip(&models).collect();
    if !arguments.limits.is_empty() {
        let tested =
            |(ship, model): &(&TrueShip, &Refined)| limits::tested(program, ship, model, arguments);
        return pairs.par_iter().flat_map(tested).collect();
    }
    let of_ship = |&(ship, model)| {
        cases::cases(ship, arguments).into_iter().map(move |case| (ship, model, case))
    };
    let mut cases: Vec<(&TrueShip, &Refined, Case)> = pairs.iter().flat_map(of_ship).collect();
    // The first case of every ship comes before the second of any.
    cases.sort_by_key(|(ship, _, case)| case.seed - 1000 * ship.seed);
    cases.into_par_iter().map(|(s, m, case)| diagnosed::run(program, s, m, case)).collect()
}
