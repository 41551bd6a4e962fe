//! Text output of a refinement.

use std::path::Path;

use sistership_assessment::course::CourseFigure;
use sistership_assessment::uncertainty::UncertaintyBand;
use sistership_identification::refine::{
    CoefficientChange, HeldOut, Refinement, RefinementManoeuvres, StepOption,
};
use sistership_model::Model;
use sistership_model_selection::{SelectionReport, SelectionStage};
use sistership_priors::source::SimilarityRanking;
use sistership_simulation::manoeuvre::NamedFigure;

use super::channels::TABLE_CHANNELS;
use super::written_files::WrittenFiles;
use super::{describe_status, similar};
use crate::table::{TextTable, format_number, format_optional};

/// Number of ships of the ranking that are listed.
const LISTED_SHIPS: usize = 6;

/// Formats the most similar ships, and the number of the others.
fn format_ranking(similarity: &SimilarityRanking) -> String {
    let missing = similarity.missing_particulars();
    if !missing.is_empty() && similarity.ranking.iter().all(|ship| ship.correlation.is_none()) {
        return format!(
            "Similar ships: unknown, as the ship's file states too few particulars for a \
             correlation; add {}\n\n",
            missing.join(", ")
        );
    }
    let ranking = &similarity.ranking;
    let listed = &ranking[..ranking.len().min(LISTED_SHIPS)];
    let others = match ranking.len() - listed.len() {
        0 => String::new(),
        others => format!("  and {others} more: `sistership similar` lists all\n"),
    };
    format!("Similar ships\n{}{others}\n", similar::ranking_table(listed))
}

/// Formats a refinement as text.
pub fn format_refinement(
    refinement: &Refinement,
    source: &Model,
    similarity: Option<&SimilarityRanking>,
    files: &WrittenFiles<'_>,
) -> String {
    let ranked = similarity.map_or(String::new(), format_ranking);
    // Another name than the source's: there is no single status to show.
    let from = match refinement.source == source.name {
        true => format!("{} ({})", source.name, describe_status(source.status)),
        false => refinement.source.clone(),
    };
    let head = format!("{} refined from {from} by `{}`\n\n", refinement.ship, refinement.method);
    let restart = refinement
        .settings
        .restart_s
        .map_or(String::new(), |s| format!(";\nsimulations restart every {} s", format_number(s)));
    let smoothed = refinement.settings.compared_smoothing_s().map_or(String::new(), |s| {
        format!(";\nmeasured motions are smoothed over {} s", format_number(s))
    });
    let how = format!("Root mean square errors: {}{restart}{smoothed}", refinement.held_out.how);
    let errors =
        format!("{how}\n{}\n", format_errors(&refinement.held_out, has_roll(&refinement.model)));
    let options = format!(
        "Options, by increasing distance from the source\n{}\n",
        format_options(&refinement.options)
    );
    let coefficients = format!(
        "Coefficients (moved: in standard deviations of the prior)\n{}\n",
        format_coefficients(&refinement.coefficients, &refinement.source)
    );
    let manoeuvres =
        format!("Standard manoeuvres\n{}\n", format_manoeuvres(&refinement.manoeuvres));
    let course = format_course(&refinement.manoeuvres.course);
    format!(
        "{ranked}{head}{course}{errors}{options}{coefficients}{manoeuvres}{}",
        format_remarks(refinement, files)
    )
}

/// Returns a warning for the first line if the trials leave a wide band.
pub fn wide_band_warning(refinement: &Refinement) -> String {
    let wide = refinement.manoeuvres.wide_band();
    wide.map_or_else(String::new, |wide| format!("WARNING: {wide}\n\n"))
}

/// Names the file with the weights of the model's learned correction.
pub fn format_weights_file(file: &Path) -> String {
    format!("weights of the learned correction written to {}\n", file.display())
}

/// Formats the selection report.
pub fn format_selection_report(ladder: &SelectionReport) -> String {
    let mut table = TextTable::new([
        "source",
        "law",
        "stage",
        "fitted",
        "effective",
        "error",
        "std. error",
        "elsewhere",
        "s",
        "selected",
        "why",
    ]);
    for line in &ladder.lines {
        let source = line.source.clone().unwrap_or_else(|| "none".to_owned());
        let rung = match line.rung {
            SelectionStage::CarriedOver => "unchanged",
            SelectionStage::Weak => "weak",
            SelectionStage::Trajectory => "trajectory",
        };
        let effective =
            line.effective.map_or_else(|| "-".to_owned(), |count| format!("{count:.0}"));
        let figures = [line.error, line.standard_error, line.variance].map(format_optional);
        let taken = match (line.chosen, line.reference) {
            (true, _) => "yes",
            (false, true) => "reference",
            (false, false) => "",
        };
        let names = [source, line.law.clone(), rung.to_owned(), line.coefficients.to_string()];
        let end = [format!("{:.1}", line.cost_s), taken.to_owned(), line.reason.clone()];
        table.add_row(names.into_iter().chain([effective]).chain(figures).chain(end));
    }
    let what = "standardised squared error on held-out manoeuvres; elsewhere: variance outside \
                the trials";
    // Empty if no learned correction was considered.
    let branch = ladder.branch.as_ref().map_or("", |choice| &choice.reason);
    let reference = ladder.reference_summary();
    format!("Candidates: {what}\n{table}\n{reference}\n\nLearned correction: {branch}\n\n")
}

/// True if the model has roll; without it the errors of roll say nothing.
fn has_roll(model: &Model) -> bool {
    model.coefficients.keys().any(|name| name.starts_with("K_"))
}

/// Formats the errors on held-out manoeuvres, before and after.
pub fn format_errors(held_out: &HeldOut, has_roll: bool) -> TextTable {
    let mut table = TextTable::new(["channel", "unit", "source", "refined", "change"]);
    for (name, unit, factor) in
        TABLE_CHANNELS.into_iter().filter(|(name, ..)| has_roll || !matches!(*name, "phi" | "p"))
    {
        let of = |errors: &std::collections::BTreeMap<String, f64>| {
            // `f64::MAX` marks the error of a simulation that left the physical range.
            errors.get(name).filter(|rmse| **rmse != f64::MAX).map(|rmse| rmse * factor)
        };
        let (before, after) = (of(&held_out.source), of(&held_out.refined));
        if before.is_some() || after.is_some() {
            let change = before
                .zip(after)
                .map_or_else(|| "-".to_owned(), |(before, after)| format_change(before, after));
            table.add_row([
                name.to_owned(),
                unit.to_owned(),
                format_optional(before),
                format_optional(after),
                change,
            ]);
        }
    }
    table
}

fn format_change(before: f64, after: f64) -> String {
    if before > 0.0 { format!("{:+.0} %", 100.0 * (after / before - 1.0)) } else { "-".to_owned() }
}

fn format_options(options: &[StepOption]) -> TextTable {
    let mut table = TextTable::new(["step", "min. lambda", "error", "selected", "reason"]);
    for option in options {
        let least =
            option.lambda_min.map_or_else(|| "-".to_owned(), |lambda| format!("{lambda:.0e}"));
        let taken = if option.chosen { "yes" } else { "" };
        let reason = option.reason.clone().unwrap_or_default();
        table.add_row([
            option.step.clone(),
            least,
            format_optional(option.error),
            taken.to_owned(),
            reason,
        ]);
    }
    table
}

fn format_coefficients(coefficients: &[CoefficientChange], source: &str) -> TextTable {
    let head = ["name", "unit", "source", "refined", "std. error", "moved", "remark"];
    let mut table = TextTable::new(head);
    for change in coefficients {
        let figures = [change.source, change.refined, change.standard_error].map(format_number);
        let moved = format!("{:.2}", change.moved_sd);
        let remark = match change.is_determined() {
            true => String::new(),
            false => format!("not determined by these trials; kept from {source}"),
        };
        let names = [change.name.clone(), change.unit.clone()];
        table.add_row(names.into_iter().chain(figures).chain([moved, remark]));
    }
    table
}

/// Formats the response on a straight course; empty if it is not known.
fn format_course(figures: &[CourseFigure]) -> String {
    if figures.is_empty() {
        return String::new();
    }
    let mut table = TextTable::new(["straight course", "value", "95 %"]);
    for figure in figures {
        let width = figure.half_width.map(|half_width| format!("+- {}", format_number(half_width)));
        let width = width.unwrap_or_else(|| "-".to_owned());
        table.add_row([figure.name.clone(), format_number(figure.value), width]);
    }
    format!("{table}\n")
}

/// Figures of the standard manoeuvres in the table.
const TABLE_FIGURES: [&str; 3] = ["advance", "tactical diameter", "first overshoot"];

fn format_manoeuvres(manoeuvres: &RefinementManoeuvres) -> TextTable {
    let mut table = TextTable::new(["figure", "unit", "source", "refined", "from", "to (95 %)"]);
    let (source, refined) = (manoeuvres.source.list_figures(), manoeuvres.refined.list_figures());
    let shown = |name: &str| {
        !name.starts_with("IMO") && TABLE_FIGURES.iter().any(|what| name.ends_with(what))
    };
    // The longer list names every figure that one of the two models reaches.
    let all = if refined.len() < source.len() { &source } else { &refined };
    for NamedFigure { name, unit, .. } in all.iter().filter(|figure| shown(&figure.name)) {
        let of = |figures: &[NamedFigure]| {
            format_optional(
                figures.iter().find(|other| other.name == *name).and_then(|other| other.value),
            )
        };
        // Bands exist only with a posterior.
        let band = manoeuvres.bands.as_ref().and_then(|bands| bands.figure_band(name));
        let edge = |of: fn(&UncertaintyBand) -> f64| format_optional(band.map(of));
        table.add_row([
            name.clone(),
            unit.clone(),
            of(&source),
            of(&refined),
            edge(|band| band.low),
            edge(|band| band.high),
        ]);
    }
    table
}

fn format_remarks(refinement: &Refinement, files: &WrittenFiles<'_>) -> String {
    let mut lines = vec![format!(
        "condition number of the regression: {}",
        format_number(refinement.condition_number)
    )];
    lines.extend(format_collinear_groups(&refinement.collinear_groups));
    let failures = refinement.manoeuvres.refined.failures.iter();
    lines.extend(failures.map(|failure| {
        format!("remark: the refined model does not complete a standard manoeuvre: {failure}")
    }));
    let bands = refinement.manoeuvres.bands.as_ref();
    lines.extend(bands.and_then(|bands| Some(bands.next_trial.as_ref()?.as_sentence())));
    let outside = refinement.manoeuvres.refined.outside.iter();
    lines.extend(outside.map(|(name, how)| format!("OUTSIDE: {name}: {}", how.describe())));
    lines.extend(refinement.remarks.iter().map(|remark| format!("remark: {remark}")));
    lines.push(match files.out {
        Some(path) => format!("model written to {}", path.display()),
        None => "model not written: give --out MODEL.yaml to keep it".to_owned(),
    });
    lines.extend(files.report.map(|path| format!("report written to {}", path.display())));
    lines.join("\n")
}

/// Largest number of groups that are listed; more would hide the other remarks.
const MAX_GROUPS: usize = 5;

/// Formats the groups of coefficients that the trials cannot distinguish.
fn format_collinear_groups(groups: &[Vec<String>]) -> Vec<String> {
    let line = |group: &Vec<String>| {
        format!("cannot be distinguished by these trials: {}", group.join(", "))
    };
    let mut lines: Vec<String> = groups.iter().take(MAX_GROUPS).map(line).collect();
    let (all, more) = (groups.len(), groups.len().saturating_sub(MAX_GROUPS));
    let rest = || format!("and {more} more such groups, of {all}; --json and --report list all");
    lines.extend((more > 0).then(rest));
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_groups_are_counted() {
        let group = |k: usize| vec![format!("X_{k}"), format!("Y_{k}")];
        let lines =
            |count: usize| format_collinear_groups(&(0..count).map(group).collect::<Vec<_>>());
        assert_eq!(lines(0), Vec::<String>::new());
        assert_eq!(lines(MAX_GROUPS).len(), MAX_GROUPS);
        assert!(lines(30)[MAX_GROUPS].starts_with("and 25 more such groups, of 30"));
    }
}
