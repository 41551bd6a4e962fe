//! The synthetic ships of many seeds.

use rayon::prelude::*;
use sistership_tests::truth::motion::Truth;

use crate::arguments::Arguments;

/// What comes of each ship, in the order of the seeds; so many at once as jobs are allowed.
pub fn each<T: Send>(arguments: &Arguments, of: impl Fn(u64, &dyn Truth) -> T + Sync) -> Vec<T> {
    let one = |seed: u64| {
        let outcome = of(seed, &*arguments.hull.ship(seed));
        eprintln!("ship {seed} done");
        outcome
    };
    arguments.seeds().into_par_iter().map(one).collect()
}
