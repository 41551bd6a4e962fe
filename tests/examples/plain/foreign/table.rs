//! Rows and summary of the judgement.

use sistership_tests::truth::foreign::Kind;

use super::Row;
use super::verdict::{Judged, Verdict};
use crate::statistics::{counted, geometric_mean};

/// Largest number of characters of a reason.
const REASON: usize = 90;
/// Speed by that of the approach up to which a model counts as slowed down where the craft has a
/// tenth left: as far above as twice what the craft has.
const SLOWED: f64 = 0.2;

/// Head of the table of cases.
pub const HEAD: &str = "| craft | trials | error | whole | heading deg | source | law | learned | \
    coefficients | diameter by true, stb / port | u/U stopped (0.10) | u/U reversed, at rest (0) | \
    u/U astern (true) | diagnosis | s |\n\
    | --- | --: | --: | --: | --: | --- | --- | --- | --: | --- | --: | --: | --- | --- | --: |";

/// Row of a case.
pub fn row(row: &Row) -> String {
    let Row { kind, seed, count, verdict } = row;
    let head = format!("| {} {seed} | {count} |", kind.name());
    let wall = format!("{:.1} |", verdict.wall_s);
    match (&verdict.chosen, &verdict.judged) {
        (Err(reason), _) => format!("{head} cannot be fitted: {} | {wall}", cut(reason)),
        (Ok(chosen), judged) => {
            let learned = if chosen.learned { "yes" } else { "" };
            let [error, middle] = judged.as_ref().map(cells).unwrap_or_default();
            format!(
                "{head} {error} | {} | {} | {learned} | {} | {middle} | {wall}",
                chosen.source, chosen.law, chosen.coefficients
            )
        }
    }
}

/// Errors, and what comes after the choice.
fn cells(judged: &Judged) -> [String; 2] {
    let figure = |value: Option<f64>, digits: usize| {
        value.map_or("left".to_owned(), |value| format!("{value:.digits$}"))
    };
    let [whole, heading] = [0, 1].map(|index| judged.whole.map(|both| both[index]));
    let propulsion = &judged.propulsion;
    let diagnosis = match &judged.diagnosis {
        Ok(()) => "ok".to_owned(),
        Err(reason) => format!("refused: {}", cut(reason)),
    };
    [
        format!("{} | {} | {}", figure(judged.error, 5), figure(whole, 4), figure(heading, 1)),
        format!(
            "{} / {} | {} | {} | {} ({:.2}) | {diagnosis}",
            figure(judged.diameters[0], 3),
            figure(judged.diameters[1], 3),
            figure(propulsion.stopped, 2),
            figure(propulsion.at_rest, 2),
            figure(propulsion.astern, 2),
            propulsion.true_astern,
        ),
    ]
}

fn cut(reason: &str) -> String {
    let reason = reason.trim_start_matches("error: ");
    reason.replace('|', "/").chars().take(REASON).collect()
}

/// Geometric means of the errors by kind and number of trials, and how many models keep the physics
/// of propulsion and can be diagnosed.
pub fn summary(rows: &[Row], counts: &[usize]) -> String {
    let mut text = "Geometric mean of the error on unseen manoeuvres (in brackets of the heading \
                    error of whole runs, deg); no model that stays in the physical range counts \
                    as 10 (and 180 deg).\n\n| kind |"
        .to_owned();
    text.extend(counts.iter().map(|count| format!(" {count} |")));
    text += " slow down | go astern | diagnosed | learned | models of |\n| --- |";
    text += &" --: |".repeat(counts.len() + 5);
    for kind in Kind::ALL {
        let of_kind: Vec<&Row> = rows.iter().filter(|row| row.kind == kind).collect();
        if !of_kind.is_empty() {
            text += &summary_row(kind.name(), &of_kind, counts);
        }
    }
    text + &summary_row("all", &rows.iter().collect::<Vec<_>>(), counts)
}

fn summary_row(name: &str, rows: &[&Row], counts: &[usize]) -> String {
    let cells: Vec<String> = counts.iter().map(|count| mean_cell(rows, *count)).collect();
    let number = |of: &dyn Fn(&Verdict) -> bool| rows.iter().filter(|row| of(&row.verdict)).count();
    let judged = |of: fn(&Judged) -> bool| number(&|v: &Verdict| v.judged.as_ref().is_some_and(of));
    format!(
        "\n| {name} | {} | {} | {} | {} | {} | {} of {} |",
        cells.join(" | "),
        judged(slows_down),
        judged(|judged| judged.propulsion.astern.is_some_and(|speed| speed < 0.0)),
        judged(|judged| judged.diagnosis.is_ok()),
        number(&|verdict| verdict.chosen.as_ref().is_ok_and(|chosen| chosen.learned)),
        number(&|verdict| verdict.chosen.is_ok()),
        rows.len(),
    )
}

fn slows_down(judged: &Judged) -> bool {
    judged.propulsion.stopped.is_some_and(|speed| (-SLOWED..SLOWED).contains(&speed))
}

fn mean_cell(rows: &[&Row], count: usize) -> String {
    let of_count = || rows.iter().filter(|row| row.count == count);
    let judged = || of_count().map(|row| row.verdict.judged.as_ref());
    let errors: Vec<f64> = judged().map(|judged| counted(judged.and_then(|j| j.error))).collect();
    let heading = |judged: Option<&Judged>| {
        judged.and_then(|judged| judged.whole).map_or(180.0, |[_, heading]| heading.min(180.0))
    };
    let headings: Vec<f64> = judged().map(heading).collect();
    format!("{:.4} ({:.1})", geometric_mean(&errors), geometric_mean(&headings))
}
