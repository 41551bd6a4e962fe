//! What an hour of planned trials is worth beside the same hour of IMO's manoeuvres, by plain calls
//! on ships whose laws the zoo does not have.
//!
//! `cargo run --release -p sistership-tests --example plan -- --ships 20 --seed 1300` (seeds below
//! 1000 are for work, from 1000 on for judgement); `--budget 60` minutes, `--jobs 2` for ships at
//! once. Each ship is refined on two trials, a plan is made of that model, and both programmes are
//! sailed for what the plan says that they take; then it is refined on the two with either.
//! `docs/evidence/plan.md` has the results.

mod arguments;
mod call;
mod figures;
mod ship;
mod table;

use arguments::Arguments;
use rayon::prelude::*;
use sistership_tests::truth::family;

fn main() {
    let arguments = Arguments::given();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.jobs).build();
    let one = |seed: u64| {
        let outcome = ship::run(&family::single_screw(seed), seed, arguments.budget_min);
        eprintln!("ship {seed} done");
        outcome.inspect_err(|error| println!("ship {seed}: {error}")).ok()
    };
    let seeds = arguments.seed..arguments.seed + arguments.ships;
    let outcomes = pool
        .expect("threads")
        .install(|| seeds.into_par_iter().filter_map(one).collect::<Vec<_>>());
    table::print(&outcomes);
}
