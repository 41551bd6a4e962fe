//! Each ship of the zoo in turn is a stranger, of which particulars alone are known: what do the
//! other ships' models, carried over, say of its manoeuvres, and is the most similar one the best?
//! `cargo run --release -p sistership-tests --example strangers`; `-- misfit` prints how far
//! sources and estimates are from the truth in accelerations, `-- work` and `-- judgement` what
//! one, two and four trials make of each prior, `-- drawn 3001 3041` the same of ships that these
//! seeds draw. docs/evidence/strangers.md has what came out.

#![allow(clippy::unwrap_used)]

mod figures;
mod misfit;
mod sailing;
mod ships;
mod statistics;
mod with_trials;

use std::sync::Arc;

use sistership_model::categories::are_comparable;
use sistership_model::{Model, Vessel, Zoo};
use sistership_priors::estimates::{LAW, RegressionLibrary, estimate_ship};
use sistership_priors::transfer::transfer_model;

use figures::{Figures, error, sailed};
use sailing::Strangers;
use ships::{MEASURES, bare, kin, likeness};
use statistics::{bootstrap, mean, median, rank_correlation};

/// A source's prediction for a stranger.
struct Candidate {
    ship: String,
    group: bool,
    figures: Figures,
    error: f64,
    likeness: Vec<Option<f64>>,
}

/// A stranger with what all others say of it.
struct Stranger {
    ship: String,
    own: Figures,
    candidates: Vec<Candidate>,
    estimated: Option<Figures>,
}

fn main() {
    match std::env::args().nth(1).as_deref() {
        Some("misfit") => misfit::run(),
        Some("work") => with_trials::run(&Strangers::Work),
        Some("judgement") => with_trials::run(&Strangers::Judgement),
        Some("drawn") => with_trials::run(&drawn()),
        _ => particulars_alone(),
    }
}

/// Ships of the truth from the first seed given up to before the second.
fn drawn() -> Strangers {
    let seed = |place: usize| std::env::args().nth(place).unwrap().parse().unwrap();
    Strangers::Drawn(seed(2)..seed(3))
}

fn particulars_alone() {
    let (zoo, library) =
        (Zoo::load_embedded().unwrap(), RegressionLibrary::parse_embedded().unwrap());
    let ships: Vec<(Arc<Vessel>, Model)> = zoo
        .vessels()
        .filter(|vessel| !vessel.file.models.is_empty())
        .map(|vessel| (Arc::clone(vessel), zoo.published_model(vessel, None).unwrap()))
        .collect();
    let strangers: Vec<Stranger> =
        ships.iter().filter_map(|one| stranger(&zoo, &library, &ships, one)).collect();
    println!(
        "| stranger | sources | best | its error | most similar (Mei) | its error | estimate |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    strangers.iter().for_each(print_stranger);
    measures(&strangers);
    priors(&strangers, 0, false);
    priors(&strangers, 3, true);
}

fn stranger(
    zoo: &Zoo,
    library: &RegressionLibrary,
    ships: &[(Arc<Vessel>, Model)],
    (target, model): &(Arc<Vessel>, Model),
) -> Option<Stranger> {
    let needed = ["lpp_m", "beam_m", "draught_m", "displacement_m3"];
    needed.iter().all(|name| target.particular(name).is_some()).then_some(())?;
    let own = sailed(zoo, model)?;
    let bare = bare(target, model);
    let others = ships.iter().filter(|(vessel, _)| !kin(vessel.name(), target.name()));
    let candidates = others.filter_map(|(vessel, source)| {
        let law = zoo.law(&source.law)?;
        let figures = sailed(zoo, &transfer_model(source, law, &bare, None))?;
        Some(Candidate {
            ship: vessel.name().to_owned(),
            group: are_comparable(&vessel.file.category, &target.file.category),
            error: error(&figures, &own),
            figures,
            likeness: likeness(target, vessel),
        })
    });
    let candidates: Vec<Candidate> = candidates.collect();
    let law = zoo.law(LAW)?;
    let speed = model.speed_m_s?;
    let estimated = estimate_ship(library, &bare, law, speed).ok();
    let estimated = estimated.and_then(|estimated| sailed(zoo, &estimated.model));
    Some(Stranger { ship: target.name().to_owned(), own, candidates, estimated })
}

fn best(stranger: &Stranger) -> Option<&Candidate> {
    stranger.candidates.iter().min_by(|a, b| a.error.total_cmp(&b.error))
}

fn chosen(stranger: &Stranger, measure: usize, in_group: bool) -> Option<&Candidate> {
    let candidates = stranger.candidates.iter().filter(|one| one.group || !in_group);
    let known = candidates.filter_map(|one| Some((one, one.likeness[measure]?)));
    known.max_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(one, _)| one)
}

fn print_stranger(stranger: &Stranger) {
    let name = |one: Option<&Candidate>| {
        one.map_or("- | -".into(), |one| format!("`{}` | {:.2}", one.ship, one.error))
    };
    let estimated = stranger.estimated.as_ref().map(|figures| error(figures, &stranger.own));
    println!(
        "| `{}` | {} | {} | {} | {} |",
        stranger.ship,
        stranger.candidates.len(),
        name(best(stranger)),
        name(chosen(stranger, 0, false)),
        estimated.map_or("-".into(), |error| format!("{error:.2}")),
    );
}

/// Does a measure choose well?
fn measures(strangers: &[Stranger]) {
    println!(
        "\n| measure | strangers | median error of the chosen | of its category | rank correlation \
         with the benefit | chosen within 10 % of the best |"
    );
    println!("| --- | --- | --- | --- | --- | --- |");
    for (k, name) in MEASURES.iter().enumerate() {
        let errors = |in_group| -> Vec<f64> {
            strangers.iter().filter_map(|one| Some(chosen(one, k, in_group)?.error)).collect()
        };
        let ranks: Vec<f64> = strangers.iter().filter_map(|one| rank(one, k)).collect();
        let near = |one: &Stranger| {
            Some(f64::from(chosen(one, k, false)?.error <= 1.1 * best(one)?.error))
        };
        let near: Vec<f64> = strangers.iter().filter_map(near).collect();
        let (low, high) = bootstrap(&ranks, 1);
        println!(
            "| {name} | {} | {:.2} | {:.2} | {:.2} ({low:.2} to {high:.2}) | {:.0} % |",
            ranks.len(),
            median(&errors(false)),
            median(&errors(true)),
            mean(&ranks),
            100.0 * mean(&near),
        );
    }
    let any: Vec<f64> = strangers
        .iter()
        .map(|one| median(&one.candidates.iter().map(|c| c.error).collect::<Vec<_>>()))
        .collect();
    let bests: Vec<f64> = strangers.iter().filter_map(|one| Some(best(one)?.error)).collect();
    println!("| any source | {} | {:.2} | | | |", any.len(), median(&any));
    println!(
        "| the best source, known only afterwards | {} | {:.2} | | | 100 % |",
        bests.len(),
        median(&bests)
    );
}

fn rank(stranger: &Stranger, measure: usize) -> Option<f64> {
    let pairs: Vec<(f64, f64)> = stranger
        .candidates
        .iter()
        .filter_map(|one| Some((one.likeness[measure]?, -one.error)))
        .collect();
    rank_correlation(&pairs)
}

/// Source alone, estimate alone, and both, each weighted by how well it did for the other ships.
fn priors(strangers: &[Stranger], measure: usize, in_category: bool) {
    let both = |one| {
        let source: &Candidate = chosen(one, measure, in_category)?;
        Some((one, &source.figures, one.estimated.as_ref()?))
    };
    let known: Vec<(&Stranger, &Figures, &Figures)> = strangers.iter().filter_map(both).collect();
    let squares = |without: &str, pick: &dyn Fn(&(&Stranger, &Figures, &Figures)) -> f64| {
        let others = known.iter().filter(|one| !kin(&one.0.ship, without));
        mean(&others.map(|one| pick(one).powi(2)).collect::<Vec<_>>())
    };
    let source = |one: &(&Stranger, &Figures, &Figures)| error(one.1, &one.0.own);
    let estimated = |one: &(&Stranger, &Figures, &Figures)| error(one.2, &one.0.own);
    let mixed: Vec<f64> = known
        .iter()
        .map(|one| {
            let of_source = 1.0 / squares(&one.0.ship, &source);
            let of_estimate = 1.0 / squares(&one.0.ship, &estimated);
            let share = of_source / (of_source + of_estimate);
            error(&one.1.between(one.2, share), &one.0.own)
        })
        .collect();
    let sources: Vec<f64> = known.iter().map(source).collect();
    let estimates: Vec<f64> = known.iter().map(estimated).collect();
    let within = if in_category { "of its category" } else { "of all" };
    println!("\nThe source is the most similar {within}, by {}.", MEASURES[measure]);
    println!("\n| prior | strangers | median error | mean error | better than the mixture |");
    println!("| --- | --- | --- | --- | --- |");
    for (name, errors) in
        [("most similar source", &sources), ("estimate", &estimates), ("mixture of both", &mixed)]
    {
        let worse = errors.iter().zip(&mixed).filter(|(one, mixed)| one < mixed).count();
        println!(
            "| {name} | {} | {:.2} | {:.2} | {worse} |",
            errors.len(),
            median(errors),
            mean(errors)
        );
    }
    for (name, errors) in [("source", &sources), ("estimate", &estimates)] {
        let gains: Vec<f64> = errors.iter().zip(&mixed).map(|(one, mixed)| one - mixed).collect();
        let (low, high) = bootstrap(&gains, 2);
        println!(
            "\nThe mixture's error is less than the {name}'s by {:.3} on average ({low:.3} to \
             {high:.3}); the ratio of their means is {:.2}.",
            mean(&gains),
            mean(errors) / mean(&mixed)
        );
    }
}
