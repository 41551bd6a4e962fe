//! Text output of a trial design.

use sistership_trial_design::{ExpectedBand, PlannedTrial, TrialPlan};

use crate::table::{TextTable, format_number};

/// Formats the trial design as text.
pub fn format_plan(plan: &TrialPlan) -> String {
    let mut parts = vec![format!("{}\n{}\n", plan.model, format_summary(plan))];
    parts.push(format!("Most informative first\n{}", trial_table(&plan.trials)));
    parts.push(format!("Half widths of the 95 % bands\n{}", band_table(&plan.bands)));
    parts.extend(plan.remarks.iter().map(|remark| format!("remark: {remark}")));
    parts.join("\n")
}

/// Summary for the decision, compared with the standard manoeuvres of IMO.
fn format_summary(plan: &TrialPlan) -> String {
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    let standard: Vec<&str> =
        plan.standard.trials.iter().map(|trial| trial.manoeuvre.as_str()).collect();
    format!(
        "{} trials in {:.0} of {:.0} min. The bands of the IMO criteria are expected to become {} \
         narrower on average;\nwith {} of IMO's manoeuvres in the same time ({}), {} narrower.",
        plan.trials.len(),
        plan.takes_min,
        plan.budget_min,
        percent(plan.narrower),
        standard.len(),
        standard.join(", "),
        percent(plan.standard.narrower),
    )
}

fn trial_table(trials: &[PlannedTrial]) -> TextTable {
    let mut table = TextTable::new([
        "trial",
        "speed m/s",
        "heading deg",
        "manoeuvre min",
        "total min",
        "cumulative gain",
    ]);
    for trial in trials {
        // Without a heading, any one serves.
        let heading = trial.heading_deg.map_or("any".to_owned(), format_number);
        let times = [trial.manoeuvre_min, trial.takes_min].map(|min| format!("{min:.1}"));
        let narrower = format!("{:.0} %", 100.0 * trial.narrower);
        let first = [trial.manoeuvre.clone(), format_number(trial.speed_m_s), heading];
        table.add_row(first.into_iter().chain(times).chain([narrower]));
    }
    table
}

fn band_table(bands: &[ExpectedBand]) -> TextTable {
    let mut table = TextTable::new(["figure", "unit", "value", "now", "after", "with IMO trials"]);
    for band in bands {
        let widths = [band.value, band.now, band.after, band.after_standard].map(format_number);
        table.add_row([band.figure.clone(), band.unit.clone()].into_iter().chain(widths));
    }
    table
}
