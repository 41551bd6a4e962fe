//! Text output of `sistership branch`.

use sistership_learned::{BranchChoice, CorrectionEvaluation};

use super::branch_document::BranchDocument;
use crate::table::{TextTable, format_number, format_optional};

/// Formats the result as text.
pub(super) fn format_branch(document: &BranchDocument<'_>) -> String {
    let tried = document.choice.map_or(String::new(), format_choice);
    let Some(branch) = &document.branch else {
        return format!("{tried}{}: no learned correction is used\n", document.model);
    };
    let judged = document.judgement.map_or_else(
        || "there is only one trial, so that cross-validation is not possible\n".to_owned(),
        |judgement| format_judgement(judgement, document.wins == Some(true)),
    );
    let written = match (document.files.out, document.weights) {
        (Some(out), Some(weights)) => {
            format!("model written to {}, weights to {}\n", out.display(), weights.display())
        }
        _ => String::new(),
    };
    format!("{tried}{}\n{}\n{judged}{written}", document.model, branch.to_line(None))
}

fn format_choice(choice: &BranchChoice) -> String {
    let mut table = TextTable::new(["kind", "foundation", "corrected", "std. error"]);
    for tried in &choice.tried {
        table.add_row([
            tried.kind.name().to_owned(),
            format_number(tried.foundation),
            format_number(tried.branch),
            format_optional(tried.standard_error),
        ]);
    }
    format!("standardised MSE on held-out trials\n\n{table}\n{}\n\n", choice.reason)
}

fn format_judgement(judgement: &CorrectionEvaluation, wins: bool) -> String {
    let mut table = TextTable::new(["held-out trial", "foundation", "corrected", "share %"]);
    for trial in &judgement.trials {
        let errors = [trial.foundation.standardised_mse, trial.branch.standardised_mse];
        let share = format_number(100.0 * trial.share);
        table.add_row(
            [trial.name.clone()].into_iter().chain(errors.map(format_number)).chain([share]),
        );
    }
    let CorrectionEvaluation { foundation, branch, standard_error, share, .. } = judgement;
    table.add_row([
        "mean".to_owned(),
        format_number(*foundation),
        format_number(*branch),
        format_number(100.0 * share),
    ]);
    let Some(standard_error) = standard_error else {
        return format!(
            "standardised MSE on held-out trials; share: mean share of the correction \
                        in the simulation\n\n{table}\n"
        );
    };
    let word = if wins { "better by more than" } else { "NOT better by more than" };
    format!(
        "standardised MSE on held-out trials; share: mean share of the correction in the \
         simulation\n\n{table}\nthe correction is {word} the standard error of the difference, \
         {}\n",
        format_number(*standard_error)
    )
}
