//! The default call on ships that are foreign to the zoo, judged through the program alone, so that
//! a program of another tree can be judged as well.

mod case;
pub mod coverage;
mod documents;
mod table;
mod verdict;

use rayon::prelude::*;
use sistership_tests::truth::foreign::Kind;

use crate::arguments::ForeignCases;
use crate::program::Program;
use case::CraftFiles;
use verdict::Verdict;

/// One craft with one number of trials.
struct Row {
    kind: Kind,
    seed: u64,
    count: usize,
    verdict: Verdict,
}

/// Prints a row for each case as it is judged, and a summary by kind.
pub fn run(program: &Program, cases: &ForeignCases) {
    println!("{}", table::HEAD);
    let seeds = || cases.seeds.clone().into_par_iter();
    let craft = cases.kinds.par_iter().flat_map(|kind| seeds().map(|seed| (*kind, seed)));
    let rows: Vec<Row> =
        craft.flat_map_iter(|(kind, seed)| judged(program, &cases.counts, kind, seed)).collect();
    println!("\n{}", table::summary(&rows, &cases.counts));
}

fn judged(program: &Program, counts: &[usize], kind: Kind, seed: u64) -> Vec<Row> {
    let files = CraftFiles::new(kind, seed);
    let one = |count: &usize| {
        let verdict = Verdict::new(program, &files, *count);
        let row = Row { kind, seed, count: *count, verdict };
        println!("{}", table::row(&row));
        row
    };
    counts.iter().map(one).collect()
}
