//! Text output of `sistership import`: a summary, or every column on request.

use sistership_trials::{Exclusion, TrialCurrent};

use super::import_outcome::{GuessRow, ImportDocument, LawNeeds};
use crate::output::format_count;
use crate::table::TextTable;

/// Number of files that are named; the rest is counted.
const MAX_NAMED_FILES: usize = 3;

/// Formats the result as text.
pub(super) fn format_import(import: &ImportDocument) -> String {
    let columns = if import.explain {
        column_table(&import.guesses)
    } else {
        summarise_columns(&import.guesses)
    };
    let logs: String = import.logs.iter().map(ToString::to_string).collect();
    let lines = |word: &str, texts: &[String]| -> String {
        texts.iter().map(|text| format!("{word}: {text}\n")).collect()
    };
    format!(
        "{columns}{}{}{}\n{logs}{}{}\n{}: {} read\n",
        lines("note", &import.notes),
        format_exclusions(import),
        format_currents(import),
        lines("error", &import.errors),
        format_laws(&import.lacking),
        import.manifest.display(),
        format_count(import.trials.len(), "trial")
    )
}

fn column_table(guesses: &[GuessRow]) -> String {
    let mut table = TextTable::new(["file", "column", "read as", "unit", "", "why"]);
    for guess in guesses {
        let channel = guess.channel.clone().unwrap_or_else(|| "-".into());
        let look = if guess.certain { "" } else { "look" };
        let cells = [guess.file.clone(), guess.column.clone(), channel, unit_text(guess)];
        table.add_row(cells.into_iter().chain([look.to_owned(), guess.why.clone()]));
    }
    let questions: String = format_questions(guesses.iter());
    format!("{table}\n{questions}")
}

fn unit_text(guess: &GuessRow) -> String {
    let unit = guess.unit.clone().unwrap_or_default();
    if guess.reversed { format!("{unit}, reversed") } else { unit }
}

/// Formats one paragraph for each group of files with the same columns.
fn summarise_columns(guesses: &[GuessRow]) -> String {
    let mut groups: Vec<(Vec<&str>, Vec<&GuessRow>)> = Vec::new();
    for rows in guesses.chunk_by(|a, b| a.file == b.file) {
        let same = |group: &Vec<&GuessRow>| {
            group.len() == rows.len() && group.iter().zip(rows).all(|(a, b)| is_same_reading(a, b))
        };
        // Logs of one recorder have the same columns; one paragraph is enough for them.
        match groups.iter_mut().find(|(_, group)| same(group)) {
            Some((files, _)) => files.push(&rows[0].file),
            None => groups.push((vec![&rows[0].file], rows.iter().collect())),
        }
    }
    groups.iter().map(|(files, rows)| format_group(files, rows)).collect()
}

fn is_same_reading(a: &GuessRow, b: &GuessRow) -> bool {
    (&a.column, &a.channel, &a.unit, a.reversed) == (&b.column, &b.channel, &b.unit, b.reversed)
}

fn format_group(files: &[&str], rows: &[&GuessRow]) -> String {
    let named = files.iter().take(MAX_NAMED_FILES).copied().collect::<Vec<_>>().join(", ");
    let more = files.len().saturating_sub(MAX_NAMED_FILES);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let read = rows.iter().filter_map(|row| {
        let channel = row.channel.as_deref()?;
        let look = if row.certain { "" } else { " (look)" };
        Some(format!("{channel} = `{}` [{}]{look}", row.column, unit_text(row)))
    });
    let read: Vec<String> = read.collect();
    let left = rows.iter().filter(|row| row.channel.is_none() && !row.column.is_empty());
    let left: Vec<String> = left.map(|row| format!("`{}`", row.column)).collect();
    let left =
        if left.is_empty() { String::new() } else { format!("  ignored: {}\n", left.join(", ")) };
    let told: String = rows
        .iter()
        .filter(|row| row.channel.is_some() && (!row.certain || row.why.contains("reversed")))
        .map(|row| format!("  `{}`: {}\n", row.column, row.why))
        .collect();
    let questions = format_questions(rows.iter().copied());
    format!("{named}{more}\n  {}\n{left}{told}{questions}", read.join(", "))
}

fn format_questions<'a>(rows: impl Iterator<Item = &'a GuessRow>) -> String {
    let mut all: Vec<&str> = rows.filter_map(|row| row.question.as_deref()).collect();
    // Adjacent duplicates only: the same question about several columns of a file.
    all.dedup();
    all.into_iter().map(|question| format!("  {question}\n")).collect()
}

/// Formats one line for each file, reason and set of rows; channels that lack the same rows share it.
fn format_exclusions(import: &ImportDocument) -> String {
    let mut lines: Vec<(&Exclusion, Vec<&str>)> = Vec::new();
    for one in &import.excluded {
        let alike = |other: &Exclusion| {
            (&one.file, &one.rows, &one.why) == (&other.file, &other.rows, &other.why)
        };
        let channel = one.channel.as_deref();
        match lines.iter_mut().find(|(other, _)| alike(other)) {
            Some((_, channels)) => channels.extend(channel),
            None => lines.push((one, channel.into_iter().collect())),
        }
    }
    let line = |(one, channels): (&Exclusion, Vec<&str>)| {
        let channel = Some(channels.join(", ")).filter(|names| !names.is_empty());
        let all = Exclusion { channel, ..one.clone() };
        format!("excluded of {}: {}\n", one.file, all.summary_text())
    };
    lines.into_iter().map(line).collect()
}

fn format_currents(import: &ImportDocument) -> String {
    let line = |one: &TrialCurrent| {
        format!("current during {}: {}, subtracted; {}\n", one.trial, one.summary_text(), one.why)
    };
    import.currents.iter().map(line).collect()
}

/// Formats the laws that can be fitted, and what is missing for the others.
fn format_laws(needs: &[LawNeeds]) -> String {
    let (ready, lacking): (Vec<&LawNeeds>, Vec<&LawNeeds>) =
        needs.iter().partition(|need| need.lacks.is_empty());
    let names: Vec<&str> = ready.iter().map(|need| need.law.as_str()).collect();
    let can = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
    format!("Laws that can be fitted to these trials: {can}\n{}", format_missing(&lacking))
}

/// Formats each missing channel once, with the laws that need it.
fn format_missing(lacking: &[&LawNeeds]) -> String {
    let mut causes: Vec<(&str, Vec<&str>)> = Vec::new();
    for (need, cause) in lacking.iter().flat_map(|need| need.lacks.iter().map(move |c| (need, c))) {
        match causes.iter_mut().find(|(known, _)| known == cause) {
            Some((_, laws)) => laws.push(&need.law),
            None => causes.push((cause, vec![&need.law])),
        }
    }
    causes.sort_by_key(|(_, laws)| std::cmp::Reverse(laws.len()));
    let line = |(cause, laws): &(&str, Vec<&str>)| match laws.len() == lacking.len() {
        true => format!("  {cause} (all other laws)\n"),
        false => format!("  {cause} ({})\n", laws.join(", ")),
    };
    let lines: String = causes.iter().map(line).collect();
    if lines.is_empty() { lines } else { format!("Missing for other laws:\n{lines}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn needs(law: &str, lacks: &[&str]) -> LawNeeds {
        LawNeeds { law: law.into(), lacks: lacks.iter().map(ToString::to_string).collect() }
    }

    #[test]
    fn a_channel_that_several_laws_lack_is_named_once() {
        let all = [needs("a", &[]), needs("b", &["n", "phi"]), needs("c", &["n"])];
        let text = format_laws(&all);
        let lines: Vec<&str> = text.lines().skip(1).collect();
        assert_eq!(lines, ["Missing for other laws:", "  n (all other laws)", "  phi (b)"]);
        assert!(text.starts_with("Laws that can be fitted to these trials: a\n"), "{text}");
    }
}
