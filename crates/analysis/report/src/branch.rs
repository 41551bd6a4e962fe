//! Report of a learned correction: its recipe, and its errors on held-out trials.

use askama::Template;
use serde::Serialize;
use sistership_learned::CorrectionEvaluation;
use sistership_model::branch::CorrectionDocument;
use sistership_model::version::code_revision;

use crate::numbers::format_significant;
use crate::rendered::{RenderedReport, ReportError, VersionLabel};

/// Input of the report.
#[derive(Debug, Clone, Serialize)]
pub struct BranchInput<'a> {
    /// Learned correction.
    pub branch: &'a CorrectionDocument,
    /// Evaluation on held-out trials; `None` if there was only one trial.
    pub judgement: Option<&'a CorrectionEvaluation>,
    /// Version of the foundation.
    pub of: VersionLabel,
    /// Version with the correction.
    pub made: VersionLabel,
}

/// Page as the template takes it.
#[derive(Template)]
#[template(path = "report_branch.html")]
struct BranchPage<'a> {
    input: &'a BranchInput<'a>,
    rows: Vec<BranchRow>,
    mean: Option<BranchRow>,
    verdict: String,
    domain: Vec<(String, String)>,
}

/// Row of the table of trials.
struct BranchRow {
    name: String,
    foundation: String,
    branch: String,
    share: String,
}

/// Renders the report as a page and as JSON.
///
/// # Errors
/// Returns an error if it cannot be written.
pub fn render_branch(input: &BranchInput<'_>) -> Result<RenderedReport, ReportError> {
    let trials = input.judgement.iter().flat_map(|judgement| &judgement.trials);
    let row = |name: &str, foundation: f64, branch: f64, share: f64| BranchRow {
        name: name.to_owned(),
        foundation: format_significant(foundation, 3),
        branch: format_significant(branch, 3),
        share: format!("{:.0} %", 100.0 * share),
    };
    let page = BranchPage {
        input,
        rows: trials
            .map(|trial| {
                let errors = (trial.foundation.standardised_mse, trial.branch.standardised_mse);
                row(&trial.name, errors.0, errors.1, trial.share)
            })
            .collect(),
        // The last row of the table is the mean over the trials.
        mean: input.judgement.map(|all| row("mean", all.foundation, all.branch, all.share)),
        verdict: verdict_sentence(input.judgement),
        domain: domain_ranges(input.branch),
    };
    Ok(RenderedReport { json: serde_json::to_value(input)?, html: page.render()? })
}

/// Result on held-out trials, as a sentence.
fn verdict_sentence(judgement: Option<&CorrectionEvaluation>) -> String {
    let Some(judged) = judgement else {
        return "There was only one trial, so that the learned correction could not be \
                cross-validated."
            .to_owned();
    };
    let Some(standard_error) = judged.standard_error else {
        return format!(
            "On the only held-out trial, the error is {} with the learned correction and {} \
             without it; the uncertainty of the difference cannot be estimated from one trial.",
            format_significant(judged.branch, 3),
            format_significant(judged.foundation, 3),
        );
    };
    let word = if judged.is_better() { "better" } else { "not better" };
    format!(
        "On {} held-out trials, the learned correction is {word} by more than one standard error: \
         error {} with it, {} without, standard error of the difference {}. Its mean share in the \
         simulations is {:.0} %.",
        judged.trials.len(),
        format_significant(judged.branch, 3),
        format_significant(judged.foundation, 3),
        format_significant(standard_error, 2),
        100.0 * judged.share
    )
}

/// Ranges of the domain, SI units and radians.
fn domain_ranges(branch: &CorrectionDocument) -> Vec<(String, String)> {
    let range = |[low, high]: &[f64; 2]| {
        format!("{} to {}", format_significant(*low, 3), format_significant(*high, 3))
    };
    branch.domain.ranges.iter().map(|(name, bounds)| (name.clone(), range(bounds))).collect()
}

impl BranchPage<'_> {
    fn revision(&self) -> &'static str {
        code_revision()
    }

    fn number(&self, value: &f64) -> String {
        format_significant(*value, 3)
    }
}
