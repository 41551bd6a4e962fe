//! Traits of files that supply rows, and of sinks that take them.

use crate::clock::Clock;
use crate::findings::Findings;
use crate::number::Fault;
use crate::table::{Column, Table, Target};

/// File whose header has been read, as a source of rows.
pub(crate) trait RowsFile {
    /// Returns the columns that are read.
    fn columns(&self) -> &[Column];

    /// Returns the expected number of rows, where that is known.
    fn room(&self) -> usize;

    /// Passes every row to a sink.
    fn each(&mut self, taker: &mut impl Taker);

    /// Completes one table made of the rows with what is known once all rows are read, and reports
    /// its findings.
    fn finish(&mut self, drops: bool, table: &mut Table, findings: &mut Findings);
}

/// Sink of rows.
pub(crate) trait Taker {
    /// True if the sink needs the time of each row before the row.
    const TIMED: bool = false;

    /// Returns true if a row is accepted; `t_s` is `None` if its time is not known.
    fn wants(&mut self, _row: usize, _t_s: Option<f64>, _clock: &Clock) -> bool {
        true
    }

    /// Takes a row; `cell` returns the number of the n-th column.
    fn row(&mut self, row: usize, cell: impl FnMut(usize, &Column) -> Result<f64, Fault>);

    /// Takes a row with fewer cells than the header.
    fn short(&mut self, row: usize);

    /// Returns the number of rows in the sink.
    fn held(&self) -> usize;
}

/// Returns the index of the time column.
pub(crate) fn time_at(columns: &[Column]) -> Option<usize> {
    columns.iter().position(|column| column.target == Target::Time)
}
