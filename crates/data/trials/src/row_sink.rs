//! Traits of files that supply rows, and of sinks that take them.

use crate::clock::ColumnClock;
use crate::findings::Findings;
use crate::number::CellFault;
use crate::table::{ColumnTarget, Table, TableColumn};

/// File whose header has been read, as a source of rows.
pub(crate) trait RowSource {
    /// Returns the columns that are read.
    fn columns(&self) -> &[TableColumn];

    /// Returns the expected number of rows, where that is known.
    fn expected_rows(&self) -> usize;

    /// Passes every row to a sink.
    fn feed_rows(&mut self, taker: &mut impl RowSink);

    /// Completes one table made of the rows with what is known once all rows are read, and reports
    /// its findings.
    fn complete_table(&mut self, drops: bool, table: &mut Table, findings: &mut Findings);
}

/// Sink of rows.
pub(crate) trait RowSink {
    /// True if the sink needs the time of each row before the row.
    const TIMED: bool = false;

    /// Returns true if a row is accepted; `t_s` is `None` if its time is not known.
    fn accepts_row(&mut self, _row: usize, _t_s: Option<f64>, _clock: &ColumnClock) -> bool {
        true
    }

    /// Takes a row; `cell` returns the number of the n-th column.
    fn take_row(
        &mut self,
        row: usize,
        cell: impl FnMut(usize, &TableColumn) -> Result<f64, CellFault>,
    );

    /// Takes a row with fewer cells than the header.
    fn take_short_row(&mut self, row: usize);

    /// Returns the number of rows in the sink.
    fn stored_rows(&self) -> usize;
}

/// Returns the index of the time column.
pub(crate) fn time_column(columns: &[TableColumn]) -> Option<usize> {
    columns.iter().position(|column| column.target == ColumnTarget::Time)
}
