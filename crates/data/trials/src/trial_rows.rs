//! Trials with the rows of their samples in the file: times of excluded rows, and rows of a time.

use std::ops::RangeInclusive;

use sistership_model::trial::Trial;

/// Trial with the row of each sample in its file.
#[derive(Debug, Clone)]
pub struct TrialWithRows {
    /// The trial.
    pub trial: Trial,
    /// Row of each sample, in ascending order.
    pub rows: Vec<u32>,
}

impl TrialWithRows {
    /// Returns the times of the samples at, or next to, the ends of a range of rows, s; `None`
    /// without samples.
    pub fn times_of_rows(&self, range: &RangeInclusive<u32>) -> Option<(f64, f64)> {
        let last = self.rows.len().checked_sub(1)?;
        // Rows that were removed have no time: those of their neighbours stand for it.
        let from = self.rows.partition_point(|row| row <= range.start()).saturating_sub(1);
        let to = self.rows.partition_point(|row| row < range.end()).min(last);
        Some((*self.trial.t_s.get(from)?, *self.trial.t_s.get(to)?))
    }

    /// Returns the rows of an interval of time, s, with those around it that were removed; `None`
    /// without a row.
    pub fn rows_between(&self, from_s: f64, to_s: f64) -> Option<RangeInclusive<u32>> {
        let t_s = &self.trial.t_s;
        let first = t_s.partition_point(|t| *t < from_s);
        let end = t_s.partition_point(|t| *t <= to_s);
        let before = first.checked_sub(1).map_or(0, |k| self.rows[k] + 1);
        let after = self.rows.get(end).map_or(u32::MAX, |row| row - 1);
        let range = before..=after;
        (from_s <= to_s && !range.is_empty() && !t_s.is_empty()).then_some(range)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial() -> TrialWithRows {
        let t_s = vec![0.0, 1.0, 2.0, 5.0, 6.0];
        TrialWithRows { trial: Trial { t_s, ..Trial::default() }, rows: vec![2, 3, 4, 7, 8] }
    }

    #[test]
    fn removed_rows_have_the_times_of_their_neighbours() {
        assert_eq!(trial().times_of_rows(&(3..=4)), Some((1.0, 2.0)));
        assert_eq!(trial().times_of_rows(&(5..=6)), Some((2.0, 5.0)));
        assert_eq!(trial().times_of_rows(&(7..=u32::MAX)), Some((5.0, 6.0)));
    }

    #[test]
    fn an_interval_names_its_rows_and_those_that_were_removed_in_it() {
        assert_eq!(trial().rows_between(0.5, 2.0), Some(3..=6));
        assert_eq!(trial().rows_between(2.5, 4.0), Some(5..=6));
        assert_eq!(trial().rows_between(5.5, 99.0), Some(8..=u32::MAX));
        assert_eq!(trial().rows_between(1.2, 1.4), None);
        assert_eq!(trial().rows_between(3.0, 1.0), None);
    }
}
