//! Who gives rows of a file, and who takes them.

use crate::clock::Clock;
use crate::findings::Findings;
use crate::number::Fault;
use crate::table::{Column, Table, Target};

/// A file whose header has been read.
pub(crate) trait RowsFile {
    /// The columns that are read.
    fn columns(&self) -> &[Column];

    /// Rows that there will be, where that is known.
    fn room(&self) -> usize;

    /// Gives every row to one who takes them.
    fn each(&mut self, taker: &mut impl Taker);

    /// What was learned of all rows, for one table that was made of them.
    fn finish(&mut self, drops: bool, table: &mut Table, findings: &mut Findings);
}

/// Who takes rows.
pub(crate) trait Taker {
    /// Whether it is told the time of each row first.
    const TIMED: bool = false;

    /// Whether a row is to be given; `t_s` is nothing where its time cannot be told.
    fn wants(&mut self, _row: usize, _t_s: Option<f64>, _clock: &Clock) -> bool {
        true
    }

    /// Takes a row; `cell` gives the number in the n-th column.
    fn row(&mut self, row: usize, cell: impl FnMut(usize, &Column) -> Result<f64, Fault>);

    /// Passes over a row that ends before the header does.
    fn short(&mut self, row: usize);

    /// Rows that it holds.
    fn held(&self) -> usize;
}

/// The place of time among columns.
pub(crate) fn time_at(columns: &[Column]) -> Option<usize> {
    columns.iter().position(|column| column.target == Target::Time)
}
