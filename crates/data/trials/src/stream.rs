//! Reading of all rows of a file into one table, and of a table as rows.

use crate::clock::Clock;
use crate::findings::Findings;
use crate::mapping::Mapping;
use crate::number::Fault;
use crate::rows::Builder;
use crate::table::{Column, Table};
use crate::taker::{RowsFile, Taker, time_at};

/// Reads all rows into one table.
pub(crate) fn whole(
    mut file: impl RowsFile,
    mapping: &Mapping,
    findings: &mut Findings,
) -> Option<Table> {
    let columns = file.columns().to_vec();
    let builder = Builder::new(columns, mapping.conventions.missing, findings);
    let mut builder = builder.with_room(file.room());
    file.each(&mut builder);
    let drops = builder.drops();
    let mut table = builder.finish();
    file.finish(drops, &mut table, findings);
    Some(table)
}

/// Rows of a table that is already in memory.
pub(crate) struct TableRows {
    table: Table,
    columns: Vec<Column>,
}

impl TableRows {
    pub(crate) fn new(table: Table) -> Self {
        // The numbers are in SI units already.
        let si = |column: &Column| Column { to_si: 1.0, ..column.clone() };
        Self { columns: table.columns.iter().map(si).collect(), table }
    }
}

impl RowsFile for TableRows {
    fn columns(&self) -> &[Column] {
        &self.columns
    }

    fn room(&self) -> usize {
        self.table.rows.len()
    }

    fn each(&mut self, taker: &mut impl Taker) {
        let Some(at) = time_at(&self.columns) else { return };
        let clock = Clock::counted(self.table.start.clone());
        for (k, &row) in self.table.rows.iter().enumerate() {
            let values = &self.table.values;
            if taker.wants(row as usize, Some(values[at][k]), &clock) {
                let finite = |value: f64| Some(value).filter(|value| value.is_finite());
                taker.row(row as usize, |position, _| {
                    finite(values[position][k]).ok_or(Fault::NotANumber)
                });
            }
        }
    }

    fn finish(&mut self, _: bool, table: &mut Table, _: &mut Findings) {
        table.start = self.table.start.clone();
        let resumed = self.table.resumed.iter();
        // Only the marks of rows that are in this table.
        let resumed = resumed.filter(|row| table.rows.binary_search(row).is_ok());
        table.resumed.extend(resumed);
        table.resumed.sort_unstable();
    }
}
