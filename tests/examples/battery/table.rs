//! The table.

use std::time::Duration;

use crate::tally::{Counts, Tally};

/// One attack on one database.
pub struct Row {
    /// The kind of database.
    pub database: &'static str,
    /// The attack.
    pub attack: &'static str,
    /// What it counted.
    pub counts: Counts,
    /// The memory that it may take, MB.
    pub allowed_mb: u64,
    /// How long it took.
    pub took: Duration,
    /// More to say.
    pub remarks: String,
}

impl Row {
    /// Of an attack that has ended.
    pub fn new(
        database: &'static str,
        attack: &'static str,
        tally: &Tally,
        allowed_mb: u64,
        took: Duration,
    ) -> Self {
        Self {
            database,
            attack,
            counts: tally.counts(),
            allowed_mb,
            took,
            remarks: tally.remarks(),
        }
    }

    /// Whether nothing is to be mended.
    pub fn good(&self) -> bool {
        let Counts { lost, wrong, server_errors, aborted, peak_mb, .. } = self.counts;
        lost + wrong + server_errors + aborted == 0 && peak_mb <= self.allowed_mb
    }

    fn print(&self) {
        let Counts { tried, lost, wrong, server_errors, aborted, peak_mb } = self.counts;
        let over = if peak_mb > self.allowed_mb { " (over)" } else { "" };
        let (database, attack, seconds) = (self.database, self.attack, self.took.as_secs());
        println!(
            "| {database} | {attack} | {tried} | {lost} | {wrong} | {server_errors} | {aborted} | \
             {peak_mb}{over} | {seconds} | {} |",
            self.remarks
        );
    }
}

/// Prints all rows with their totals. Whether all is good.
pub fn print(rows: &[Row]) -> bool {
    println!("| database | attack | tried | lost | wrong | 5xx | aborted | MB | s | remarks |");
    println!("| --- | --- | --: | --: | --: | --: | --: | --: | --: | --- |");
    rows.iter().for_each(Row::print);
    let sum = |of: fn(&Counts) -> u64| rows.iter().map(|row| of(&row.counts)).sum::<u64>();
    let counts = Counts {
        tried: sum(|counts| counts.tried),
        lost: sum(|counts| counts.lost),
        wrong: sum(|counts| counts.wrong),
        server_errors: sum(|counts| counts.server_errors),
        aborted: sum(|counts| counts.aborted),
        peak_mb: rows.iter().map(|row| row.counts.peak_mb).max().unwrap_or(0),
    };
    let allowed_mb = rows.iter().map(|row| row.allowed_mb).max().unwrap_or(0);
    let (took, remarks) = (rows.iter().map(|row| row.took).sum(), String::new());
    Row { database: "all", attack: "total", counts, allowed_mb, took, remarks }.print();
    !rows.is_empty() && rows.iter().all(Row::good)
}
