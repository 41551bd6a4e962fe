//! The table, and how long it took.

use std::collections::BTreeMap;

use sistership_diagnosis::Verdict;

use super::super::cases::Kind;
use super::outcome::Outcome;

/// Prints what is hidden, row by row, against what is named first.
pub fn print(outcomes: &[Outcome]) {
    let mut rows: BTreeMap<(u8, String), BTreeMap<String, usize>> = BTreeMap::new();
    for outcome in outcomes {
        *rows.entry(row(outcome)).or_default().entry(column(outcome)).or_default() += 1;
    }
    println!("\nhidden -> named first (a pair: everything that is named)");
    for ((_, row), columns) in &rows {
        let mut columns: Vec<(&String, &usize)> = columns.iter().collect();
        columns.sort_by_key(|(_, count)| std::cmp::Reverse(**count));
        let counts: Vec<String> =
            columns.iter().map(|(name, count)| format!("{name} {count}")).collect();
        println!("{row:<40} {}", counts.join(", "));
    }
    let mut seconds: Vec<f64> = outcomes.iter().map(|outcome| outcome.seconds).collect();
    seconds.sort_by(f64::total_cmp);
    if let (Some(most), Some(median)) = (seconds.last(), seconds.get(seconds.len() / 2)) {
        println!("\na diagnosis takes {median:.1} s (median), {most:.1} s (most)");
    }
}

fn row(outcome: &Outcome) -> (u8, String) {
    match outcome.kind {
        Kind::Single(share) => (0, format!("{} at {share:.1}", outcome.label)),
        Kind::Pair => (1, outcome.label.clone()),
        Kind::Unlisted(..) => (2, format!("{} (unlisted)", outcome.label)),
        Kind::Clean => (3, outcome.label.clone()),
    }
}

fn column(outcome: &Outcome) -> String {
    let nothing = match outcome.verdict {
        Verdict::Complete => "complete",
        Verdict::Effects => "effects without a name",
        Verdict::Unexplained => "unexplained",
    };
    match outcome.kind {
        Kind::Pair if !outcome.named.is_empty() => {
            let mut named = outcome.named.clone();
            named.sort();
            named.join("+")
        }
        Kind::Single(_) | Kind::Pair => {
            outcome.named.first().cloned().unwrap_or_else(|| nothing.into())
        }
        // Here it is the verdict that counts.
        Kind::Unlisted(..) | Kind::Clean => match outcome.named.first() {
            Some(name) => format!("{nothing} with {name}"),
            None => nothing.into(),
        },
    }
}
