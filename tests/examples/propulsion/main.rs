//! Coasting, stopping and going astern by models of trials at constant revolutions, beside the same
//! models without a surge balance, and beside the ship itself where the trials are of the truth.
//! `cargo run --release -p sistership-tests --example propulsion [-- zoo|truth] [COUNT]`.
//! docs/evidence/propulsion.md has what came out.

#![allow(clippy::unwrap_used)]

mod ships;
mod speeds;

use std::collections::BTreeMap;

use rayon::prelude::*;
use sistership_identification::refine::RefinementSettings;
use sistership_model::trial::Trial;
use sistership_model::{Model, Zoo};
use sistership_model_selection::{StartRequest, best_start};
use sistership_simulation::Ship;

use ships::{Stranger, of_truth, of_zoo};
use speeds::{Speeds, of_model};

/// What a default refinement makes of a ship's trials.
struct Row {
    ship: String,
    law: String,
    balanced: bool,
    before: Speeds,
    after: Speeds,
    truth: Option<Speeds>,
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let has = |word: &str| arguments.iter().any(|argument| argument == word);
    let most = arguments.iter().find_map(|word| word.parse().ok()).unwrap_or(usize::MAX);
    let zoo = Zoo::load_embedded().unwrap();
    let mut all: Vec<Stranger> = Vec::new();
    if !has("truth") {
        all.extend(of_zoo(&zoo).into_iter().take(most));
    }
    if !has("zoo") {
        all.extend(of_truth().into_iter().take(most));
    }
    println!(
        "| ship | law | balance | stopped, before | after | truth | reversed, before | after \
         | astern, before | after |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
    );
    all.par_iter().for_each(|one| match row(&zoo, one) {
        Ok(row) => println!("{}", row.words()),
        Err(error) => println!("| {} | {error} |", one.vessel.name()),
    });
}

fn row(zoo: &Zoo, stranger: &Stranger) -> Result<Row, String> {
    let trials: Vec<&Trial> = stranger.trials.iter().collect();
    let (champions, settings) = (BTreeMap::new(), RefinementSettings::default());
    let asked = StartRequest {
        zoo,
        target: &stranger.vessel,
        champions: &champions,
        trials: &trials,
        settings: &settings,
        preference: Default::default(),
    };
    let start = best_start(&asked, &|_, _| true).map_err(|error| error.to_string())?;
    let (model, law) = (&start.refinement.model, &*start.entrant.law);
    let without = Model { propulsion: None, ..model.clone() };
    let speeds = |model: &Model| Ship::new(model, law).map(|ship| of_model(&ship));
    Ok(Row {
        ship: stranger.vessel.name().to_owned(),
        law: start.entrant.name(),
        balanced: model.propulsion.is_some(),
        before: speeds(&without).map_err(|error| error.to_string())?,
        after: speeds(model).map_err(|error| error.to_string())?,
        truth: stranger.truth,
    })
}

impl Row {
    fn words(&self) -> String {
        let share =
            |share: Option<f64>| share.map_or("-".to_owned(), |share| format!("{share:.2}"));
        let Self { ship, law, balanced, before, after, truth } = self;
        let truth = share(truth.and_then(|truth| truth.stopped));
        let cells = [
            share(before.stopped),
            share(after.stopped),
            truth,
            share(before.reversed),
            share(after.reversed),
            share(before.astern),
            share(after.astern),
        ];
        let balanced = if *balanced { "yes" } else { "no" };
        format!("| {ship} | {law} | {balanced} | {} |", cells.join(" | "))
    }
}
