//! Reading of all rows of a file into one table, and of a table as rows.

use crate::clock::ColumnClock;
use crate::findings::Findings;
use crate::mapping::Mapping;
use crate::number::CellFault;
use crate::row_sink::{RowSink, RowSource, time_column};
use crate::rows::TableBuilder;
use crate::table::{Table, TableColumn};

/// Reads all rows into one table.
pub(crate) fn read_whole(
    mut file: impl RowSource,
    mapping: &Mapping,
    findings: &mut Findings,
) -> Option<Table> {
    let columns = file.columns().to_vec();
    let builder = TableBuilder::new(columns, mapping.conventions.missing, findings);
    let mut builder = builder.with_room(file.expected_rows());
    file.feed_rows(&mut builder);
    let drops = builder.drops_rows();
    let mut table = builder.finish_table();
    file.complete_table(drops, &mut table, findings);
    Some(table)
}

/// Rows of a table that is already in memory.
pub(crate) struct TableRows {
    table: Table,
    columns: Vec<TableColumn>,
}

impl TableRows {
    pub(crate) fn new(table: Table) -> Self {
        // The numbers are in SI units already.
        let si = |column: &TableColumn| TableColumn { to_si: 1.0, at_rest: 0.0, ..column.clone() };
        Self { columns: table.columns.iter().map(si).collect(), table }
    }
}

impl RowSource for TableRows {
    fn columns(&self) -> &[TableColumn] {
        &self.columns
    }

    fn expected_rows(&self) -> usize {
        self.table.rows.len()
    }

    fn feed_rows(&mut self, taker: &mut impl RowSink) {
        // Columns that are to be identified have no time yet; their rows are read all the same.
        let at = time_column(&self.columns);
        let clock = ColumnClock::with_start(self.table.start.clone());
        for (k, &row) in self.table.rows.iter().enumerate() {
            let values = &self.table.values;
            if taker.accepts_row(row as usize, at.map(|at| values[at][k]), &clock) {
                let finite = |value: f64| Some(value).filter(|value| value.is_finite());
                taker.take_row(row as usize, |position, _| {
                    finite(values[position][k]).ok_or(CellFault::NotANumber)
                });
            }
        }
    }

    fn complete_table(&mut self, _: bool, table: &mut Table, _: &mut Findings) {
        table.start = self.table.start.clone();
        let resumed = self.table.resumed.iter();
        // Only the marks of rows that are in this table.
        let resumed = resumed.filter(|row| table.rows.binary_search(row).is_ok());
        table.resumed.extend(resumed);
        table.resumed.sort_unstable();
    }
}
