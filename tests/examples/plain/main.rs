//! What `sistership refine` makes when it is asked plainly, against the best that its flags can
//! get, on trials that no call saw.
//!
//! `cargo run --release -p sistership-tests --example plain -- choice` (or `by-file`, `learning`,
//! `candidates`, `coverage`, `all`); `--ships 50`, `--seed 1000` (below 1000 is for work, from
//! 1000 on for judgement), `--hull twin-screw` for ships with two propellers and rudders, `--data
//! tanker` for one data set of `choice` (`drawn`: the ship of `--seed` and `--hull`), `--calls
//! plain` for the plain call alone in `learning`, `--program FILE` for another program than this
//! tree's, `--jobs 2` for calls at once where no time is measured, `--limit 300` seconds after
//! which a call is given up. `docs/evidence/plain.md` has the results and what they mean.
//!
//! `... -- foreign [--kinds outboard,pods] [--seeds 1..3] [--trials 1,2,4,8,12] [--program FILE]`
//! judges the default call on ships that are foreign to the zoo (`truth::foreign` has the kinds);
//! seeds as above, the last excluded. `docs/evidence/foreign_ships.md` has the results.
//! `foreign-coverage` with the same flags holds the bands of manoeuvres and of the response on a
//! straight course against these ships.

mod arguments;
mod call;
mod candidates;
mod choice;
mod coverage;
mod data;
mod foreign;
mod judge;
mod learning;
mod program;
mod sources;
mod statistics;
mod yard;

use arguments::{Arguments, Part};
use program::Program;

fn main() {
    let arguments = Arguments::given();
    let program = Program::new(&arguments);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.jobs).build();
    let pool = pool.expect("threads");
    println!("{}\n", arguments.said());
    for part in arguments.parts() {
        pool.install(|| match part {
            Part::Choice => choice::run(&program, &arguments),
            Part::ByFile => choice::by_file(&program),
            Part::Learning => learning::run(&program, &arguments),
            Part::Candidates => candidates::run(&program, &arguments),
            Part::Coverage => coverage::run(&program, &arguments),
            Part::Foreign => foreign::run(&program, &arguments.foreign),
            Part::ForeignCoverage => foreign::coverage::run(&program, &arguments.foreign),
        });
    }
}
