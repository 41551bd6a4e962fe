//! Whether the bands of a refined model hold the truth.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;
use sistership_tests::truth::manoeuvre::every_figure;

use crate::arguments::Arguments;
use crate::call::{Call, MODEL};
use crate::data::synthetic::synthetic;
use crate::program::Program;
use crate::statistics::median;
use crate::yard;

/// Trials that a call gets.
const TRIALS: usize = 6;
/// Models drawn for the bands.
const DRAWS: usize = 200;
/// What 95 % bands should hold.
const AIM: std::ops::RangeInclusive<f64> = 0.90..=0.98;

/// The figures that are judged together; others are shown apart.
const JUDGED: [&str; 4] = ["tactical diameter", "advance", "first overshoot", "second overshoot"];

/// A true figure and its band.
#[derive(Debug, Clone)]
pub struct Held {
    /// The figure, as reports name it.
    name: String,
    /// What it is a figure of, as in [`JUDGED`].
    kind: String,
    truth: f64,
    /// Absent where the model gives none.
    band: Option<[f64; 2]>,
}

impl Held {
    /// A figure of its own kind with half the width of its band.
    pub fn new(name: &str, truth: f64, middle: f64, half_width: Option<f64>) -> Self {
        let band = half_width.map(|half| [middle - half, middle + half]);
        Self { name: name.to_owned(), kind: name.to_owned(), truth, band }
    }

    fn outside(&self) -> String {
        let place = self.band.map_or(f64::NAN, |[low, high]| {
            (self.truth - 0.5 * (low + high)) / (0.5 * (high - low))
        });
        format!("{}: {:.2}, {place:+.1}", self.name, self.truth)
    }

    /// Whether the truth is in the band, were it so many times as wide about its middle.
    fn inside(&self, times: f64) -> bool {
        self.band.is_some_and(|[low, high]| {
            (self.truth - 0.5 * (low + high)).abs() <= 0.5 * times * (high - low)
        })
    }
}

/// Figures of a ship with their bands, or why there are none.
pub type Covered = Result<Vec<Held>, String>;

/// Prints the share of true figures inside their bands.
pub fn run(program: &Program, arguments: &Arguments) {
    let ships = yard::each(arguments, |seed, ship| {
        let data = synthetic(ship, TRIALS, seed);
        let (made, folder) = Call::default().refine(program, &data);
        let answer = made.judged.and_then(|_| bands(program, folder.path()));
        answer.map(|bands| held(&every_figure(ship), &bands))
    });
    print(&format!("{} ships, {TRIALS} trials each", ships.len()), &ships);
}

/// Prints the tables of ships under a heading.
pub fn print(heading: &str, ships: &[Covered]) {
    let without = ships.iter().filter(|ship| ship.is_err()).count();
    let all: Vec<&Held> = ships.iter().flatten().flatten().collect();
    let (all, beside): (Vec<&Held>, Vec<&Held>) =
        all.into_iter().partition(|held| JUDGED.contains(&held.kind.as_str()));
    println!("## Coverage: 95 % bands of {heading}\n");
    println!("{without} ships have no model or no bands and are left out.\n");
    if let Some(reason) = ships.iter().find_map(|ship| ship.as_ref().err()) {
        println!("The first of them: {reason}\n");
    }
    println!(
        "| figure | number | inside | without a band | median width by truth | 90 to 98 % |\n| --- \
         | --: | --: | --: | --: | --- |"
    );
    let of = |kind: &str, all: &[&Held]| {
        row(kind, &all.iter().copied().filter(|held| held.kind == kind).collect::<Vec<_>>());
    };
    JUDGED.iter().for_each(|kind| of(kind, &all));
    row("all of these", &all);
    let kinds: BTreeSet<&str> = beside.iter().map(|held| held.kind.as_str()).collect();
    kinds.into_iter().for_each(|kind| of(kind, &beside));
    println!("\nInside, were the bands wider or narrower:\n\n| times | inside |\n| --: | --: |");
    for times in [0.25, 0.5, 0.76, 1.0, 1.5, 2.0] {
        println!("| {times} | {:.1} % |", 100.0 * share_inside(&all, times));
    }
    println!("\nOutside, in half widths of the band from its middle:\n");
    for (place, ship) in ships.iter().enumerate() {
        for held in ship.iter().flatten().filter(|held| !held.inside(1.0)) {
            println!("- ship {}, {}", place + 1, held.outside());
        }
    }
    println!();
}

fn share_inside(all: &[&Held], times: f64) -> f64 {
    all.iter().filter(|held| held.inside(times)).count() as f64 / all.len() as f64
}

fn row(name: &str, all: &[&Held]) {
    let share = share_inside(all, 1.0);
    let none = all.iter().filter(|held| held.band.is_none()).count();
    let width = |held: &&&Held| held.band.map(|[low, high]| (high - low) / held.truth.abs());
    let widths: Vec<f64> = all.iter().filter_map(|held| width(&held)).collect();
    let good = if AIM.contains(&share) { "yes" } else { "no" };
    let middle = median(&widths);
    println!("| {name} | {} | {:.1} % | {none} | {middle:.2} | {good} |", all.len(), 100.0 * share);
}

/// The bands of the model in a folder.
///
/// # Errors
/// The program gives none; says why.
pub fn bands(program: &Program, folder: &std::path::Path) -> Result<Value, String> {
    let model = folder.join(MODEL).display().to_string();
    let draws = DRAWS.to_string();
    let words = ["manoeuvre", "--model", &model, "--all", "--bands", &draws, "--json"];
    let answer = program.run(&words.map(str::to_owned), folder).answer?;
    Ok(answer["bands"]["figures"].clone())
}

/// True figures with their bands among those of a document.
pub fn held(truth: &BTreeMap<String, f64>, bands: &Value) -> Vec<Held> {
    let one = |(name, truth): (&String, &f64)| {
        let named = |band: &&Value| band["figure"] == name.as_str();
        let band = bands.as_array().and_then(|all| all.iter().find(named));
        let limits = band.and_then(|band| Some([band["low"].as_f64()?, band["high"].as_f64()?]));
        let kind = name.split(": ").last().unwrap_or_default().to_owned();
        Held { name: name.clone(), kind, truth: *truth, band: limits }
    };
    truth.iter().map(one).collect()
}
