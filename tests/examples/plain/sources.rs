//! Sources as they are, not refined.

use sistership_model::Model;
use sistership_priors::transfer::{transfer_model, trial_approach};

use crate::data::DataSet;
use crate::judge::judge;
use crate::program::Program;

/// Errors of sources put on the ship's particulars; absent where there is none that sails.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Unrefined {
    /// Of the first eligible ship of the ranking.
    pub nearest: Option<f64>,
    /// The smallest of all, known only in hindsight.
    pub best: Option<f64>,
}

/// The unrefined sources of a data set.
pub fn unrefined(program: &Program, data: &DataSet) -> Unrefined {
    let error = |name: &String| {
        let model = data.zoo.find_model(name).ok()?;
        judge(&transferred(&model, data)?, data).ok().map(|judged| judged.error)
    };
    let errors: Vec<f64> = names(data).iter().filter_map(error).collect();
    let best = errors.into_iter().min_by(f64::total_cmp);
    Unrefined { nearest: nearest(program, data).and_then(|name| error(&name)), best }
}

/// The models of the zoo, that of the ship itself left out.
pub fn names(data: &DataSet) -> Vec<String> {
    let published =
        data.zoo.vessels().filter_map(|vessel| data.zoo.published_model(vessel, None).ok());
    published.map(|model| model.name).filter(|name| !data.is_own(name)).collect()
}

fn transferred(source: &Model, data: &DataSet) -> Option<Model> {
    let law = data.zoo.law(&source.law)?;
    let text = std::fs::read_to_string(&data.ship).ok();
    let vessel = match text {
        Some(text) => std::sync::Arc::new(sistership_model::Vessel::parse("ship", &text).ok()?),
        None => data.zoo.vessel(&data.ship)?.clone(),
    };
    let approach = trial_approach(&data.seen.iter().collect::<Vec<_>>());
    Some(transfer_model(source, law, &vessel, approach))
}

/// The model that the program's own ranking has first among the eligible.
fn nearest(program: &Program, data: &DataSet) -> Option<String> {
    let folder = tempfile::tempdir().expect("a folder");
    let trials = data.trials.display().to_string();
    let words = ["similar", &data.ship, "--trials", &trials, "--json"].map(str::to_owned);
    let answer = program.run(&words, folder.path()).answer.ok()?;
    let ranking = answer["ranking"].as_array()?.clone();
    let eligible = ranking.iter().find(|ranked| ranked["eligible"] == true)?;
    eligible["model"].as_str().map(str::to_owned)
}
