//! Exclusion of values of a channel, or of whole rows, by a manifest, with the reason.

use std::fmt;
use std::ops::RangeInclusive;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sistership_model::manifest::FileTime;
use sistership_model::trial::Finding;

use crate::file_segments::FileSegment;
use crate::findings::Findings;
use crate::table::{ColumnTarget, Table};

/// Values that are excluded as faulty.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Exclusion {
    /// File, as named by its trial.
    pub file: String,
    /// Channel (`psi`, `latitude`, ...); by default whole rows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub channel: Option<String>,
    /// Rows of the file, such as `17, 204-209`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<String>")]
    pub rows: Option<RowRanges>,
    /// Start of the time of the file that is excluded, if no rows are named.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<FileTime>,
    /// End of the time of the file that is excluded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<FileTime>,
    /// Reason of the exclusion.
    pub why: String,
}

impl Exclusion {
    /// Returns true if another exclusion names the same channel of the same file for the same
    /// reason.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        let same =
            (&self.file, &self.channel, &self.why) == (&other.file, &other.channel, &other.why);
        same && self.rows.is_some() && other.rows.is_some()
    }

    /// Adds the rows of another exclusion.
    pub(crate) fn add_rows(&mut self, other: &Self) {
        let ranges = [&self.rows, &other.rows].into_iter().flatten();
        self.rows = Some(RowRanges::merge(ranges.flat_map(|rows| rows.0.iter().cloned())));
    }

    /// Restores a range of rows; an exclusion by times stays as it is. Returns true if something is
    /// still excluded.
    pub fn restore_rows(&mut self, range: &RangeInclusive<u32>) -> bool {
        let Some(rows) = &mut self.rows else { return true };
        *rows = rows.without_range(range);
        !rows.0.is_empty()
    }

    /// Returns the number of excluded values in words: `43 values of psi: spikes`.
    pub fn summary_text(&self) -> String {
        let count = self.rows.as_ref().map_or(0, RowRanges::count);
        let what = match &self.channel {
            Some(channel) => format!("values of {channel}"),
            None => "rows".to_owned(),
        };
        format!("{count} {what}: {}", self.why)
    }

    /// Returns the finding that a check reports for these faults.
    pub(crate) fn to_finding(&self) -> Finding {
        let rows = self.rows.as_ref().map_or(String::new(), |rows| format!(" (rows {rows})"));
        let summary = self.summary_text();
        let message = format!("{summary}{rows}; `sistership import` excludes them");
        Finding { row: None, column: self.channel.clone(), message }
    }
}

/// Ranges of rows, in order, as `17, 204-209`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct RowRanges(pub Vec<RangeInclusive<u32>>);

impl TryFrom<String> for RowRanges {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let number = |part: &str| part.trim().parse::<u32>().ok();
        let range = |part: &str| match part.split_once('-') {
            Some((first, last)) => Some(number(first)?..=number(last)?),
            None => number(part).map(|row| row..=row),
        };
        let ranges = text.split(',').map(|part| {
            let found = range(part).filter(|range| !range.is_empty());
            found.ok_or_else(|| format!("`{part}` is not a row; write rows as `17, 204-209`"))
        });
        ranges.collect::<Result<Vec<_>, _>>().map(Self)
    }
}

impl From<RowRanges> for String {
    fn from(ranges: RowRanges) -> Self {
        ranges.to_string()
    }
}

impl fmt::Display for RowRanges {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (at, range) in self.0.iter().enumerate() {
            let comma = if at > 0 { ", " } else { "" };
            match range.start() == range.end() {
                true => write!(out, "{comma}{}", range.start())?,
                false => write!(out, "{comma}{}-{}", range.start(), range.end())?,
            }
        }
        Ok(())
    }
}

impl RowRanges {
    /// Returns the ranges of rows in ascending order.
    pub fn from_rows(rows: impl IntoIterator<Item = u32>) -> Self {
        Self::merge(rows.into_iter().map(|row| row..=row))
    }

    /// Merges ranges that overlap or follow each other. Rows are not counted one by one: a manifest
    /// may name four billion.
    fn merge(ranges: impl IntoIterator<Item = RangeInclusive<u32>>) -> Self {
        let mut sorted: Vec<RangeInclusive<u32>> = ranges.into_iter().collect();
        sorted.sort_unstable_by_key(|range| *range.start());
        let mut merged: Vec<RangeInclusive<u32>> = Vec::new();
        for range in sorted {
            // The last row that can be written has none after it.
            let continues = |last: &RangeInclusive<u32>| {
                last.end().checked_add(1).is_none_or(|next| *range.start() <= next)
            };
            match merged.last_mut().filter(|last| continues(last)) {
                Some(last) => *last = *last.start()..=*last.end().max(range.end()),
                None => merged.push(range),
            }
        }
        Self(merged)
    }

    /// Returns these rows without those of a range.
    fn without_range(&self, range: &RangeInclusive<u32>) -> Self {
        let parts = |own: &RangeInclusive<u32>| {
            let before = *own.start()..=(*own.end()).min(range.start().saturating_sub(1));
            let after = (*own.start()).max(range.end().saturating_add(1))..=*own.end();
            // At the ends of the numbers nothing lies before or after the range.
            let before = Some(before).filter(|_| *range.start() > 0);
            let after = Some(after).filter(|_| *range.end() < u32::MAX);
            [before, after].into_iter().flatten().filter(|part| !part.is_empty())
        };
        Self::merge(self.0.iter().flat_map(parts))
    }

    /// Returns the number of rows.
    pub fn count(&self) -> usize {
        self.0.iter().map(|range| (range.end() - range.start()) as usize + 1).sum()
    }
}

/// Applies exclusions to a table: excluded values become gaps, excluded rows are removed.
pub(crate) fn apply_exclusions(
    table: &mut Table,
    exclusions: &[Exclusion],
    findings: &mut Findings,
) {
    let mut removed = vec![false; table.rows.len()];
    for exclusion in exclusions {
        let places = match excluded_samples(table, exclusion) {
            Ok(places) => places,
            Err(message) => {
                findings.error(None, exclusion.channel.as_deref(), message);
                continue;
            }
        };
        let count: usize = places.iter().map(ExactSizeIterator::len).sum();
        if count == 0 {
            continue;
        }
        match &exclusion.channel {
            None => places.into_iter().flatten().for_each(|k| removed[k] = true),
            Some(channel) => {
                let Some(at) = column_position(table, channel) else { continue };
                let values = &mut table.values[at];
                places.into_iter().flatten().for_each(|k| values[k] = f64::NAN);
            }
        }
        let what =
            exclusion.channel.as_deref().map_or("rows".into(), |one| format!("values of {one}"));
        findings.warning(None, None, format!("{count} {what} excluded: {}", exclusion.why));
    }
    // Rows are removed last, so that the indices of all exclusions refer to the same table.
    remove_rows(table, &removed);
}

fn column_position(table: &Table, channel: &str) -> Option<usize> {
    let target = ColumnTarget::from_name(channel)?;
    table.columns.iter().position(|column| column.target == target)
}

/// Returns the ranges of samples that an exclusion refers to.
fn excluded_samples(
    table: &Table,
    exclusion: &Exclusion,
) -> Result<Vec<std::ops::Range<usize>>, String> {
    if let Some(rows) = &exclusion.rows {
        // Row numbers of the file ascend, but rows may be missing: search instead of indexing.
        let samples = |range: &RangeInclusive<u32>| {
            let first = table.rows.partition_point(|known| known < range.start());
            first..table.rows.partition_point(|known| known <= range.end())
        };
        return Ok(rows.0.iter().map(samples).collect());
    }
    let stretch = FileSegment { from: exclusion.from.clone(), to: exclusion.to.clone() };
    let window = stretch.time_window(table.start.as_ref()).map_err(|fault| fault.to_string())?;
    let time = table.columns.iter().position(|column| column.target == ColumnTarget::Time);
    let Some(t) = time.map(|at| &table.values[at]) else { return Ok(Vec::new()) };
    // Single samples, since times need not be in order yet.
    let inside = (0..t.len()).filter(|&k| window.from_s <= t[k] && t[k] <= window.to_s);
    Ok(inside.map(|k| k..k + 1).collect())
}

fn remove_rows(table: &mut Table, removed: &[bool]) {
    if !removed.contains(&true) {
        return;
    }
    let kept = |k: usize| !removed.get(k).copied().unwrap_or(false);
    let mut k = 0;
    // `retain` visits elements in order: a counter gives the index.
    let mut next = || {
        k += 1;
        kept(k - 1)
    };
    table.rows.retain(|_| next());
    for values in &mut table.values {
        let mut k = 0;
        values.retain(|_| {
            k += 1;
            kept(k - 1)
        });
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::testing::{finding_messages, test_table};
    use sistership_model::trial::Channel;

    #[test]
    fn rows_are_written_as_they_are_read() {
        let ranges = RowRanges::from_rows([3, 4, 5, 9]);
        assert_eq!((ranges.to_string().as_str(), ranges.count()), ("3-5, 9", 4));
        assert_eq!(RowRanges::try_from("3-5,9".to_owned()), Ok(ranges));
        assert!(RowRanges::try_from("5-3".to_owned()).unwrap_err().contains("204-209"));
    }

    fn exclusion(channel: Option<&str>, rows: &RowRanges) -> Exclusion {
        Exclusion {
            file: "a".into(),
            channel: channel.map(str::to_owned),
            rows: Some(rows.clone()),
            from: None,
            to: None,
            why: "spikes".into(),
        }
    }

    #[test]
    fn the_last_row_that_can_be_written_excludes_all_after_the_first() {
        let mut one = test_table(&[(Channel::U, vec![1.0; 6])]);
        let rows = RowRanges(vec![one.rows[1]..=u32::MAX]);
        apply_exclusions(&mut one, &[exclusion(None, &rows)], &mut Findings::default());
        assert_eq!(one.rows.len(), 1);
    }

    #[test]
    fn added_rows_are_merged_by_ranges() {
        let mut all = exclusion(None, &RowRanges(vec![5..=u32::MAX, 1..=2]));
        all.add_rows(&exclusion(None, &RowRanges(vec![3..=3, 9..=12, u32::MAX..=u32::MAX])));
        assert_eq!(all.rows, Some(RowRanges(vec![1..=3, 5..=u32::MAX])));
        assert_eq!(RowRanges::from_rows([7, 3, 4, 4]).to_string(), "3-4, 7");
    }

    #[test]
    fn a_restored_range_splits_the_rows() {
        let mut one = exclusion(None, &RowRanges(vec![3..=9, 12..=12]));
        assert!(one.restore_rows(&(5..=6)));
        assert_eq!(one.rows, Some(RowRanges(vec![3..=4, 7..=9, 12..=12])));
        assert!(one.restore_rows(&(0..=8)));
        assert_eq!(one.rows, Some(RowRanges(vec![9..=9, 12..=12])));
        assert!(!one.restore_rows(&(9..=u32::MAX)));
    }

    #[test]
    fn values_become_gaps_and_rows_go() {
        let mut one = test_table(&[(Channel::U, vec![1.0; 6]), (Channel::Psi, vec![0.0; 6])]);
        let row = |k: usize| one.rows[k];
        let rows = [RowRanges::from_rows([row(1)]), RowRanges::from_rows([row(4), row(5)])];
        let all = [exclusion(Some("psi"), &rows[0]), exclusion(None, &rows[1])];
        let mut findings = Findings::default();
        apply_exclusions(&mut one, &all, &mut findings);
        assert_eq!((one.rows.len(), one.values[0].len()), (4, 4));
        let gaps = one.values.iter().flatten().filter(|value| value.is_nan()).count();
        assert_eq!(gaps, 1);
        assert!(finding_messages(findings).contains("1 values of psi excluded: spikes"));
    }
}
