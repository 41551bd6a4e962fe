//! Text output of `sistership branch`.

use sistership_learned::{BranchChoice, Judgement};

use super::branch_document::BranchDocument;
use crate::table::{TextTable, number};

/// Formats the result as text.
pub(super) fn text(document: &BranchDocument<'_>) -> String {
    let tried = document.choice.map_or(String::new(), choice);
    let Some(branch) = &document.branch else {
        return format!("{tried}{}: no branch is taken\n", document.model);
    };
    let judged = document.judgement.map_or_else(
        || "one trial only: none is left to judge it on\n".to_owned(),
        |judgement| judged(judgement, document.wins == Some(true)),
    );
    let written = match (document.files.out, document.weights) {
        (Some(out), Some(weights)) => {
            format!("model written to {}, weights to {}\n", out.display(), weights.display())
        }
        _ => String::new(),
    };
    format!("{tried}{}\n{}\n{judged}{written}", document.model, branch.line(None))
}

fn choice(choice: &BranchChoice) -> String {
    let mut table = TextTable::new(["kind", "foundation", "with branch", "std. error"]);
    for tried in &choice.tried {
        let errors = [tried.foundation, tried.branch, tried.standard_error].map(number);
        table.row([tried.kind.name().to_owned()].into_iter().chain(errors));
    }
    format!("standardised MSE on trials left out of the training\n\n{table}\n{}\n\n", choice.reason)
}

fn judged(judgement: &Judgement, wins: bool) -> String {
    let mut table = TextTable::new(["trial left out", "foundation", "with branch", "share %"]);
    for trial in &judgement.trials {
        let errors = [trial.foundation.standardised_mse, trial.branch.standardised_mse];
        let share = number(100.0 * trial.share);
        table.row([trial.name.clone()].into_iter().chain(errors.map(number)).chain([share]));
    }
    let Judgement { foundation, branch, standard_error, share, .. } = judgement;
    table.row(["mean".to_owned(), number(*foundation), number(*branch), number(100.0 * share)]);
    let word = if wins { "wins by more than" } else { "does NOT win by more than" };
    format!(
        "standardised MSE; share: what the branch counted for\n\n{table}\nthe branch {word} the \
         standard error of the difference, {}\n",
        number(*standard_error)
    )
}
