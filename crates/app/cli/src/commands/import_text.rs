//! Text output of `sistership import`: a summary, or every column on request.

use super::import_outcome::{GuessRow, Import, LawNeeds};
use crate::output::count;
use crate::table::TextTable;

/// Number of files that are named; the rest is counted.
const NAMED: usize = 3;

/// Formats the result as text.
pub(super) fn text(import: &Import) -> String {
    let columns = if import.explain { table(&import.guesses) } else { summary(&import.guesses) };
    let logs: String = import.logs.iter().map(ToString::to_string).collect();
    let lines = |word: &str, texts: &[String]| -> String {
        texts.iter().map(|text| format!("{word}: {text}\n")).collect()
    };
    format!(
        "{columns}{}{}\n{logs}{}{}\n{}: {} read\n",
        lines("note", &import.notes),
        excluded(import),
        lines("error", &import.errors),
        laws(&import.lacking),
        import.manifest.display(),
        count(import.trials.len(), "trial")
    )
}

fn table(guesses: &[GuessRow]) -> String {
    let mut table = TextTable::new(["file", "column", "read as", "unit", "", "why"]);
    for guess in guesses {
        let channel = guess.channel.clone().unwrap_or_else(|| "-".into());
        let look = if guess.certain { "" } else { "look" };
        let cells = [guess.file.clone(), guess.column.clone(), channel, unit(guess)];
        table.row(cells.into_iter().chain([look.to_owned(), guess.why.clone()]));
    }
    let questions: String = questions(guesses.iter());
    format!("{table}\n{questions}")
}

fn unit(guess: &GuessRow) -> String {
    let unit = guess.unit.clone().unwrap_or_default();
    if guess.reversed { format!("{unit}, reversed") } else { unit }
}

/// Formats one paragraph for each group of files with the same columns.
fn summary(guesses: &[GuessRow]) -> String {
    let mut groups: Vec<(Vec<&str>, Vec<&GuessRow>)> = Vec::new();
    for rows in guesses.chunk_by(|a, b| a.file == b.file) {
        let same = |group: &Vec<&GuessRow>| {
            group.len() == rows.len() && group.iter().zip(rows).all(|(a, b)| alike(a, b))
        };
        // Logs of one recorder have the same columns; one paragraph is enough for them.
        match groups.iter_mut().find(|(_, group)| same(group)) {
            Some((files, _)) => files.push(&rows[0].file),
            None => groups.push((vec![&rows[0].file], rows.iter().collect())),
        }
    }
    groups.iter().map(|(files, rows)| paragraph(files, rows)).collect()
}

fn alike(a: &GuessRow, b: &GuessRow) -> bool {
    (&a.column, &a.channel, &a.unit, a.reversed) == (&b.column, &b.channel, &b.unit, b.reversed)
}

fn paragraph(files: &[&str], rows: &[&GuessRow]) -> String {
    let named = files.iter().take(NAMED).copied().collect::<Vec<_>>().join(", ");
    let more = files.len().saturating_sub(NAMED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let read = rows.iter().filter_map(|row| {
        let channel = row.channel.as_deref()?;
        let look = if row.certain { "" } else { " (look)" };
        Some(format!("{channel} = `{}` [{}]{look}", row.column, unit(row)))
    });
    let read: Vec<String> = read.collect();
    let left = rows.iter().filter(|row| row.channel.is_none() && !row.column.is_empty());
    let left: Vec<String> = left.map(|row| format!("`{}`", row.column)).collect();
    let left =
        if left.is_empty() { String::new() } else { format!("  left out: {}\n", left.join(", ")) };
    let told: String = rows
        .iter()
        .filter(|row| row.channel.is_some() && (!row.certain || row.why.contains("other way")))
        .map(|row| format!("  `{}`: {}\n", row.column, row.why))
        .collect();
    let questions = questions(rows.iter().copied());
    format!("{named}{more}\n  {}\n{left}{told}{questions}", read.join(", "))
}

fn questions<'a>(rows: impl Iterator<Item = &'a GuessRow>) -> String {
    let mut all: Vec<&str> = rows.filter_map(|row| row.question.as_deref()).collect();
    // Adjacent duplicates only: the same question about several columns of a file.
    all.dedup();
    all.into_iter().map(|question| format!("  {question}\n")).collect()
}

fn excluded(import: &Import) -> String {
    import
        .excluded
        .iter()
        .map(|one| format!("excluded of {}: {}\n", one.file, one.summary()))
        .collect()
}

/// Formats the laws that can be fitted, and what is missing for the others.
fn laws(needs: &[LawNeeds]) -> String {
    let (ready, lacking): (Vec<&LawNeeds>, Vec<&LawNeeds>) =
        needs.iter().partition(|need| need.lacks.is_empty());
    let names: Vec<&str> = ready.iter().map(|need| need.law.as_str()).collect();
    let can = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
    let lines: String =
        lacking.iter().map(|need| format!("  {}: {}\n", need.law, need.lacks.join("; "))).collect();
    let others = if lines.is_empty() { String::new() } else { format!("Others:\n{lines}") };
    format!("Laws that these trials can be fitted with: {can}\n{others}")
}
