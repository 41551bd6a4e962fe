//! What one zigzag, and four trials, make of each prior: the same law is fitted by all, so that
//! nothing but the prior differs.

use rayon::prelude::*;
use sistership_identification::refine::{
    EstimationMethod, Prior, RefinementSettings, RefinementSpec, refine,
};
use sistership_model::categories::are_comparable;
use sistership_model::trial::Trial;
use sistership_model::{Model, Zoo};
use sistership_priors::estimates::{LAW, RegressionLibrary, estimate_ship};
use sistership_simulation::Ship;
use sistership_simulation::error::{SquaredError, standard_deviations, standardised_mse};
use sistership_simulation::recorded::{ReplaySettings, replay_trial};

use crate::figures::{error, sailed};
use crate::sailing::{Sailed, Strangers, strangers};
use crate::ships::{MEASURES, kin, likeness};
use crate::statistics::{bootstrap, mean, median};

/// What is fitted: a law that every prior can say something in, and none is of.
const FITTED: &str = "low-speed";
/// What a model that cannot be made or sails nowhere counts, as the logarithm of a ratio and as a
/// standardised error: as if it were wrong by a factor of 5, or as wide as the trials themselves.
const LOST: [f64; 2] = [1.6, 1.0];
/// How many trials are fitted.
const COUNTS: [usize; 3] = [1, 2, 4];
/// The default order of the program (correlation), and the best one of particulars alone.
const SHOWN: [usize; 2] = [0, 3];

/// Errors of one refinement: of the figures, and of unseen trials.
type Errors = [f64; 2];

/// What a stranger makes of each prior.
struct Row {
    ship: String,
    category: String,
    own_law: bool,
    estimate: Errors,
    /// By measure of similarity: the source alone, and in the mixture.
    sources: Vec<Option<[Errors; 2]>>,
}

/// Prints the tables of some strangers.
pub fn run(of: &Strangers) {
    let (zoo, library) =
        (Zoo::load_embedded().unwrap(), RegressionLibrary::parse_embedded().unwrap());
    let all = strangers(&zoo, of);
    for count in COUNTS {
        let rows: Vec<Row> =
            all.par_iter().filter_map(|one| row(&zoo, &library, one, count)).collect();
        println!("\n## {count} of the trials\n");
        each(&rows);
        for (k, what) in ["figures", "unseen trials"].into_iter().enumerate() {
            println!("\nErrors of the {what}.\n");
            priors(&rows, k);
        }
    }
}

fn row(zoo: &Zoo, library: &RegressionLibrary, stranger: &Sailed, count: usize) -> Option<Row> {
    let speed = stranger.vessel.particular("service_speed_m_s")?;
    let trials: Vec<&Trial> = stranger.trials.iter().take(count).collect();
    let estimated = estimate_ship(library, &stranger.vessel, zoo.law(LAW)?, speed).ok()?;
    let errors = |source: &Model, prior| errors(zoo, stranger, source, prior, &trials);
    let sources = (0..MEASURES.len()).map(|measure| {
        let source = chosen(zoo, stranger, measure).filter(|_| SHOWN.contains(&measure))?;
        Some([errors(&source, Prior::Source), errors(&source, Prior::Mixture)])
    });
    Some(Row {
        ship: stranger.vessel.name().to_owned(),
        category: stranger.vessel.file.category.clone(),
        own_law: stranger.own_law,
        estimate: errors(&estimated.model, Prior::Source),
        sources: sources.collect(),
    })
}

/// The source that a measure chooses: of all ships by correlation, of the category by difference.
fn chosen(zoo: &Zoo, stranger: &Sailed, measure: usize) -> Option<Model> {
    let target = &stranger.vessel;
    let others = zoo.vessels().filter(|vessel| {
        let alike = measure < 2 || are_comparable(&vessel.file.category, &target.file.category);
        alike && !kin(vessel.name(), target.name())
    });
    let known = others.filter_map(|vessel| {
        Some((likeness(target, vessel)[measure]?, zoo.published_model(vessel, None).ok()?))
    });
    known.max_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, model)| model)
}

fn errors(zoo: &Zoo, stranger: &Sailed, source: &Model, prior: Prior, trials: &[&Trial]) -> Errors {
    refined(zoo, stranger, source, prior, trials)
        .and_then(|model| Some([figures(zoo, stranger, &model)?, unseen(zoo, stranger, &model)?]))
        .unwrap_or(LOST)
}

fn refined(
    zoo: &Zoo,
    stranger: &Sailed,
    source: &Model,
    prior: Prior,
    trials: &[&Trial],
) -> Option<Model> {
    let settings = RefinementSettings {
        method: EstimationMethod::Weak,
        prior,
        hold_out_parts: trials.len() < 3,
        ..RefinementSettings::default()
    };
    let request = RefinementSpec {
        target: &stranger.vessel,
        source,
        source_law: zoo.law(&source.law).map(|law| &**law),
        law: zoo.law(FITTED)?,
        trials,
        population: &[],
        settings: &settings,
    };
    Some(refine(&request, &|_, _| true).ok()?.model)
}

fn figures(zoo: &Zoo, stranger: &Sailed, model: &Model) -> Option<f64> {
    Some(error(&sailed(zoo, model)?, &stranger.figures).min(LOST[0]))
}

/// The root of the mean square over all channels, by their deviations; every trial from its first
/// sample to its end.
fn unseen(zoo: &Zoo, stranger: &Sailed, model: &Model) -> Option<f64> {
    let ship = Ship::new(model, zoo.law(&model.law)?).ok()?;
    let deviations = standard_deviations(&stranger.unseen.iter().collect::<Vec<_>>());
    let one = |trial: &Trial| {
        let replay = replay_trial(&ship, trial, &ReplaySettings::default()).ok()?;
        let is_whole = replay.stopped.is_none();
        let mse = standardised_mse(&SquaredError::from_trial(trial, &replay), &deviations);
        Some(if is_whole { mse.min(LOST[1].powi(2)) } else { LOST[1].powi(2) })
    };
    let all: Option<Vec<f64>> = stranger.unseen.iter().map(one).collect();
    Some(mean(&all?).sqrt())
}

fn each(rows: &[Row]) {
    println!(
        "| stranger | category | its law | estimate | source (Mei) | mixture | source (difference) \
         | mixture |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    for row in rows {
        let cell = |errors: &Errors| format!("{:.2}, {:.3}", errors[0], errors[1]);
        let source = |measure: usize| {
            row.sources[measure].as_ref().map_or("- | -".to_owned(), |[alone, mixed]| {
                format!("{} | {}", cell(alone), cell(mixed))
            })
        };
        println!(
            "| `{}` | {} | {} | {} | {} |",
            row.ship,
            row.category,
            if row.own_law { "in the zoo" } else { "another" },
            cell(&row.estimate),
            SHOWN.map(source).join(" | ")
        );
    }
}

/// By measure: source alone, estimate alone and mixture, and by what factor the mixture is better.
fn priors(rows: &[Row], k: usize) {
    println!(
        "| source chosen by | of | strangers | source: median | estimate | mixture | source by \
         mixture | estimate by mixture |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    for (measure, name) in MEASURES.iter().enumerate() {
        for (of, wanted) in [("all", None), ("the zoo", Some(true)), ("other laws", Some(false))] {
            let known: Vec<[f64; 3]> = rows
                .iter()
                .filter(|row| wanted.is_none_or(|own| row.own_law == own))
                .filter_map(|row| {
                    let [alone, mixed] = row.sources[measure].as_ref()?;
                    Some([alone[k], row.estimate[k], mixed[k]])
                })
                .collect();
            print_prior(name, of, &known);
        }
    }
}

fn print_prior(name: &str, of: &str, known: &[[f64; 3]]) {
    if known.is_empty() {
        return;
    }
    let column = |place: usize| known.iter().map(|one| one[place]).collect::<Vec<f64>>();
    let factor = |place: usize| {
        let ratios: Vec<f64> =
            known.iter().map(|one| (one[place].max(1e-3) / one[2].max(1e-3)).ln()).collect();
        let (low, high) = bootstrap(&ratios, 3);
        format!("{:.2} ({:.2} to {:.2})", mean(&ratios).exp(), low.exp(), high.exp())
    };
    println!(
        "| {name} | {of} | {} | {:.3} | {:.3} | {:.3} | {} | {} |",
        known.len(),
        median(&column(0)),
        median(&column(1)),
        median(&column(2)),
        factor(0),
        factor(1)
    );
}
