//! Every ship of the zoo estimated from its particulars, beside its own model:
//! `cargo run --release -p sistership-priors --example estimates`.

#![allow(clippy::unwrap_used)]

use std::time::Instant;

use sistership_assessment::validation::compare_published;
use sistership_model::law::Law;
use sistership_model::{Vessel, Zoo};
use sistership_priors::estimates::{
    EstimateBands, LAW, RegressionLibrary, estimate_bands, estimate_ship,
};
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{
    ManoeuvreSettings, StandardManoeuvres, simulate_standard_manoeuvres,
};

/// The figures that are compared.
const FIGURES: [&str; 3] = [
    "turn 35 deg: tactical diameter",
    "zigzag 10/10: first overshoot",
    "zigzag 20/20: first overshoot",
];

struct Row {
    own: [Option<f64>; 3],
    estimated: [Option<f64>; 3],
    bands: [Option<(f64, f64)>; 3],
}

fn main() {
    let (zoo, library) =
        (Zoo::load_embedded().unwrap(), RegressionLibrary::parse_embedded().unwrap());
    let law = zoo.law(LAW).unwrap();
    let mut rows = Vec::new();
    let mut times_ms = Vec::new();
    println!(
        "| ship | tactical, L: own | estimate | band | 10/10: own | estimate | band | 20/20: own | \
         estimate | band |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
    );
    for vessel in zoo.vessels().filter(|vessel| !vessel.file.models.is_empty()) {
        let model = zoo.published_model(vessel, None).unwrap();
        let ship = Ship::new(&model, zoo.law(&model.law).unwrap()).unwrap();
        let started = Instant::now();
        let estimated = match estimate_ship(&library, vessel, law, ship.approach_speed_m_s()) {
            Ok(estimated) => estimated,
            Err(refused) => {
                println!("| `{}` | {refused} | | | | | | | | |", vessel.name());
                continue;
            }
        };
        let bands = estimate_bands(&estimated, law, 1).unwrap();
        times_ms.push(1e3 * started.elapsed().as_secs_f64());
        let own = simulate_standard_manoeuvres(&ship, &ManoeuvreSettings::default());
        let row = row(&own, &bands, ship.lpp_m());
        print_row(vessel.name(), &row);
        rows.push(row);
    }
    summary(&rows);
    against_trials(&zoo, &library, law);
    times_ms.sort_by(f64::total_cmp);
    println!(
        "\nTime of an estimate with bands: median {:.0} ms, longest {:.0} ms.",
        times_ms[times_ms.len() / 2],
        times_ms[times_ms.len() - 1]
    );
}

/// Estimates of ships whose own free-running trials are published.
fn against_trials(zoo: &Zoo, library: &RegressionLibrary, law: &Law) {
    println!(
        "\n| ship | trial | published | estimate | error | band |\n| --- | --- | --- | --- | --- | \
         --- |"
    );
    for vessel in zoo.vessels().filter(|vessel| !vessel.file.free_running.is_empty()) {
        one_against_trials(vessel, library, law);
    }
}

fn one_against_trials(vessel: &Vessel, library: &RegressionLibrary, law: &Law) {
    for trials in &vessel.file.free_running {
        let speed = trials.speed_m_s.or_else(|| vessel.particular("service_speed_m_s"));
        let speed = speed.or_else(|| vessel.file.models.first()?.speed_m_s).unwrap();
        let estimated = estimate_ship(library, vessel, law, speed).unwrap();
        let bands = estimate_bands(&estimated, law, 1).unwrap();
        let ship = Ship::new(&estimated.model, law).unwrap();
        for one in compare_published(&ship, std::slice::from_ref(trials)) {
            let scale = if one.unit == "L" { 1.0 / ship.lpp_m() } else { 1.0 };
            // An estimate is the same on both sides.
            let figure = one.figure.replace("turn -", "turn ").replace("zigzag -", "zigzag ");
            let band = bands.figures.iter().find(|band| band.figure == figure);
            let band = band.map_or("-".into(), |band| {
                format!("{:.2}-{:.2}", band.low * scale, band.high * scale)
            });
            let number =
                |value: Option<f64>| value.map_or("-".into(), |value| format!("{value:.2}"));
            println!(
                "| `{}` | {} | {:.2} ± {:.2} {} | {} | {} | {band} |",
                vessel.name(),
                one.figure,
                one.published,
                one.uncertainty,
                one.unit,
                number(one.sailed),
                number(one.error()),
            );
        }
    }
}

fn value(of: &StandardManoeuvres, name: &str) -> Option<f64> {
    of.list_figures().into_iter().find(|figure| figure.name == name).and_then(|figure| figure.value)
}

fn row(own: &StandardManoeuvres, bands: &EstimateBands, lpp_m: f64) -> Row {
    let scale = [1.0 / lpp_m, 1.0, 1.0];
    let band = |k: usize| {
        let found = bands.figures.iter().find(|band| band.figure == FIGURES[k])?;
        Some((found.low * scale[k], found.high * scale[k]))
    };
    Row {
        own: std::array::from_fn(|k| value(own, FIGURES[k]).map(|v| v * scale[k])),
        estimated: std::array::from_fn(|k| {
            value(&bands.manoeuvres, FIGURES[k]).map(|v| v * scale[k])
        }),
        bands: std::array::from_fn(band),
    }
}

fn print_row(name: &str, row: &Row) {
    let number = |value: Option<f64>| value.map_or("-".into(), |value| format!("{value:.2}"));
    let cells: Vec<String> = (0..3)
        .map(|k| {
            let band = row.bands[k].map_or("-".into(), |(low, high)| format!("{low:.2}-{high:.2}"));
            format!("{} | {} | {band}", number(row.own[k]), number(row.estimated[k]))
        })
        .collect();
    println!("| `{name}` | {} |", cells.join(" | "));
}

fn summary(rows: &[Row]) {
    println!(
        "\n| figure | ships | median error | within the 95 % band |\n| --- | --- | --- | --- |"
    );
    let (mut inside_all, mut all) = (0, 0);
    for (k, name) in FIGURES.iter().enumerate() {
        let pairs: Vec<(f64, f64, (f64, f64))> = rows
            .iter()
            .filter_map(|row| Some((row.own[k]?, row.estimated[k]?, row.bands[k]?)))
            .collect();
        let mut errors: Vec<f64> = pairs
            .iter()
            .map(|(own, estimated, _)| {
                let apart = (estimated - own).abs();
                if k == 0 { 100.0 * apart / own } else { apart }
            })
            .collect();
        errors.sort_by(f64::total_cmp);
        let inside =
            pairs.iter().filter(|(own, _, (low, high))| (low..=high).contains(&own)).count();
        let unit = if k == 0 { "%" } else { "deg" };
        println!(
            "| {name} | {} | {:.1} {unit} | {inside} |",
            pairs.len(),
            errors[errors.len() / 2]
        );
        inside_all += inside;
        all += pairs.len();
    }
    println!(
        "\nCoverage of the 95 % bands: {inside_all} of {all}, {:.0} %.",
        100.0 * inside_all as f64 / all as f64
    );
}
