//! Bands of the default call on foreign ships against the ships themselves.

use std::path::Path;

use rayon::prelude::*;
use sistership_assessment::course::course_figures;
use sistership_model::Zoo;
use sistership_tests::truth::foreign::Kind;
use sistership_tests::truth::foreign::course::straight_response;
use sistership_tests::truth::foreign::craft::Craft;
use sistership_tests::truth::foreign::simulate::every_figure;

use super::case::CraftFiles;
use crate::arguments::ForeignCases;
use crate::call::{MODEL, read_model};
use crate::coverage::{Covered, Held, bands, held, print};
use crate::program::Program;

/// Prints the share of true figures inside their bands, for each number of trials.
pub fn run(program: &Program, cases: &ForeignCases) {
    let seeds = || cases.seeds.clone().into_par_iter();
    let craft = cases.kinds.par_iter().flat_map(|kind| seeds().map(|seed| (*kind, seed)));
    let all: Vec<(String, Vec<Covered>)> =
        craft.map(|(kind, seed)| covered(program, &cases.counts, kind, seed)).collect();
    for (place, count) in cases.counts.iter().enumerate() {
        let (names, ships): (Vec<&str>, Vec<Covered>) =
            all.iter().map(|(name, ships)| (name.as_str(), ships[place].clone())).unzip();
        print(&format!("{} foreign ships, {count} trials each", ships.len()), &ships);
        println!("Ships: {}\n", names.join(", "));
    }
}

/// A craft by name, and its figures for each number of trials.
fn covered(program: &Program, counts: &[usize], kind: Kind, seed: u64) -> (String, Vec<Covered>) {
    let files = CraftFiles::new(kind, seed);
    let ships = counts.iter().map(|count| refined(program, &files, *count)).collect();
    eprintln!("{} {seed} done", kind.name());
    (format!("{} {seed}", kind.name()), ships)
}

fn refined(program: &Program, files: &CraftFiles, count: usize) -> Covered {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let model = folder.path().join(MODEL);
    let [vessel, trials, out] =
        [&files.vessel, &files.trials(count), &model].map(|path| path.display().to_string());
    let call = ["refine", "--ship", &vessel, "--trials", &trials, "--out", &out, "--json"];
    program.run(&call.map(str::to_owned), folder.path()).answer?;
    let mut figures = held(&every_figure(&files.craft), &bands(program, folder.path())?);
    figures.extend(course(&files.craft, &model)?);
    Ok(figures)
}

/// Response on a straight course. A craft without an angle has its stability alone.
fn course(craft: &Craft, path: &Path) -> Result<Vec<Held>, String> {
    let zoo = Zoo::load_embedded().map_err(|error| error.to_string())?;
    let model = read_model(&zoo, path)?;
    let law = zoo.law(&model.law).ok_or("a law that the zoo lacks")?;
    let own = course_figures(&model, law);
    let truth = straight_response(craft);
    let judged = own.iter().zip(truth).enumerate();
    let judged = judged.filter(|(k, _)| *k == 2 || !craft.steers_by_difference());
    Ok(judged
        .map(|(_, (figure, truth))| Held::new(&figure.name, truth, figure.value, figure.half_width))
        .collect())
}
