//! The tables.

use crate::figures::{Bands, error, holds, width};
use crate::ship::Outcome;

/// Kinds of figures by the end of their names.
const KINDS: [&str; 4] = ["tactical diameter", "advance", "first overshoot", "second overshoot"];

/// Prints everything.
pub fn print(outcomes: &[Outcome]) {
    println!("| ship | planned | tactical diameter | first overshoot |\n| --- | --- | --: | --: |");
    outcomes.iter().for_each(row);
    println!(
        "\nWidths of bands: planned by IMO's, by those on the first trials, and as expected.\n"
    );
    println!(
        "| figure | planned / IMO's | ships narrower | planned / first | expected | IMO's / first \
         | expected |"
    );
    println!("| --- | --: | --: | --: | --: | --: | --: |");
    KINDS.iter().for_each(|kind| of_kind(outcomes, kind));
    println!("\nErrors: the middle of the band from the truth, and true figures inside.\n");
    println!("| figure | planned / IMO's | inside first | planned | IMO's |");
    println!("| --- | --: | --: | --: | --: |");
    KINDS.iter().for_each(|kind| of_truth(outcomes, kind));
}

/// Names of the figures of a kind.
fn named<'a>(outcome: &'a Outcome, kind: &'a str) -> impl Iterator<Item = &'a String> {
    outcome.truth.keys().filter(move |name| name.ends_with(kind))
}

fn mean(logarithms: &[f64]) -> f64 {
    (logarithms.iter().sum::<f64>() / logarithms.len() as f64).exp()
}

/// The geometric mean over the figures of a kind of the ratio of two widths.
fn ratio(outcome: &Outcome, kind: &str, above: &Bands, below: &Bands) -> f64 {
    let one = |name: &String| Some((width(above, name)? / width(below, name)?).ln());
    mean(&named(outcome, kind).filter_map(one).collect::<Vec<_>>())
}

fn row(outcome: &Outcome) {
    let trials = outcome.plan["trials"].as_array().cloned().unwrap_or_default();
    let names: Vec<String> = trials
        .iter()
        .map(|trial| {
            let (name, speed) = (&trial["manoeuvre"], &trial["speed_m_s"]);
            let speed = speed.as_f64().unwrap_or_default();
            format!("{} at {speed:.1}", name.as_str().unwrap_or_default())
        })
        .collect();
    let of = |kind: &str| ratio(outcome, kind, &outcome.planned, &outcome.standard);
    println!(
        "| {} | {} | {:.2} | {:.2} |",
        outcome.name,
        names.join(", "),
        of(KINDS[0]),
        of(KINDS[2])
    );
}

fn of_kind(outcomes: &[Outcome], kind: &str) {
    let by = |of: &dyn Fn(&Outcome) -> f64| {
        let all: Vec<f64> = outcomes.iter().map(of).filter(|ratio| ratio.is_finite()).collect();
        let narrower = all.iter().filter(|ratio| **ratio < 1.0).count();
        (mean(&all.iter().map(|ratio| ratio.ln()).collect::<Vec<_>>()), narrower, all.len())
    };
    let (against, narrower, count) = by(&|o| ratio(o, kind, &o.planned, &o.standard));
    let (planned, ..) = by(&|o| ratio(o, kind, &o.planned, &o.first));
    let (standard, ..) = by(&|o| ratio(o, kind, &o.standard, &o.first));
    let (of_plan, ..) = by(&|o| expected(o, kind, "after"));
    let (of_standard, ..) = by(&|o| expected(o, kind, "after_standard"));
    println!(
        "| {kind} | {against:.3} | {narrower} of {count} | {planned:.2} | {of_plan:.2} | \
         {standard:.2} | {of_standard:.2} |"
    );
}

/// What the plan expects of the figures of a kind.
fn expected(outcome: &Outcome, kind: &str, after: &str) -> f64 {
    let bands = outcome.plan["bands"].as_array().cloned().unwrap_or_default();
    let of_kind = bands
        .iter()
        .filter(|band| band["figure"].as_str().is_some_and(|name| name.ends_with(kind)));
    let one = |band: &serde_json::Value| Some((band[after].as_f64()? / band["now"].as_f64()?).ln());
    mean(&of_kind.filter_map(one).collect::<Vec<_>>())
}

fn of_truth(outcomes: &[Outcome], kind: &str) {
    let figures = || outcomes.iter().flat_map(|o| named(o, kind).map(move |name| (o, name)));
    let ratios: Vec<f64> = figures()
        .filter_map(|(o, name)| {
            let of = |bands: &Bands| error(bands, name, o.truth[name]);
            Some((of(&o.planned)? / of(&o.standard)?).ln())
        })
        .filter(|ratio| ratio.is_finite())
        .collect();
    let inside = |of: &dyn Fn(&Outcome) -> &Bands| {
        let all: Vec<bool> =
            figures().filter_map(|(o, name)| holds(of(o), name, o.truth[name])).collect();
        format!("{} of {}", all.iter().filter(|inside| **inside).count(), all.len())
    };
    println!(
        "| {kind} | {:.2} | {} | {} | {} |",
        mean(&ratios),
        inside(&|o| &o.first),
        inside(&|o| &o.planned),
        inside(&|o| &o.standard)
    );
}
