//! The rows behind a variant's statistics, in sequences without a gap.

use nalgebra::{DMatrix, DVector};

use super::super::blocks::RegressionBlocks;
use super::super::rows::RegressionTable;

/// Consecutive rows of one regression.
pub(in super::super) struct RowSequence {
    /// Regressors by column.
    pub regressors: DMatrix<f64>,
    targets: DMatrix<f64>,
}

impl RowSequence {
    /// Returns a target over the rows.
    pub fn target(&self, target: usize) -> DVector<f64> {
        self.targets.column(target).into_owned()
    }
}

/// Rows by regression and sequence.
pub(in super::super) struct SequencedRows {
    pub blocks: Vec<Vec<RowSequence>>,
}

/// Rows of a part of a trial without a gap.
pub(in super::super) struct SequenceTables {
    /// One table for each regression.
    pub tables: Vec<RegressionTable>,
    /// Number of consecutive rows that share most of their information.
    pub dependent: usize,
}

/// Creates sequences from the rows of parts. Dependent rows are replaced by their mean; `centred`
/// subtracts the mean of all rows from each column.
pub(in super::super) fn sequence_rows(
    blocks: &RegressionBlocks,
    parts: &[SequenceTables],
    centred: bool,
) -> SequencedRows {
    let of_block = |b: usize| {
        let p = blocks.blocks[b].regressor_count();
        let offsets = if centred {
            column_means(parts, b)
        } else {
            vec![0.0; parts.first().map_or(0, |part| part.tables[b].len())]
        };
        let sequence = |part: &SequenceTables| {
            row_sequence(&part.tables[b], p, part.dependent.max(1), &offsets)
        };
        parts.iter().map(sequence).collect()
    };
    SequencedRows { blocks: (0..blocks.blocks.len()).map(of_block).collect() }
}

/// Means of a regression's columns over all sequences.
fn column_means(parts: &[SequenceTables], block: usize) -> Vec<f64> {
    let columns = parts.first().map_or(0, |part| part.tables[block].len());
    let mean = |column: usize| {
        let all = || parts.iter().flat_map(|part| part.tables[block][column].iter());
        all().sum::<f64>() / (all().count() as f64).max(1.0)
    };
    (0..columns).map(mean).collect()
}

/// The rows of one table; a rest of fewer than `merged` rows is dropped.
fn row_sequence(
    table: &RegressionTable,
    regressors: usize,
    merged: usize,
    offsets: &[f64],
) -> RowSequence {
    let count = table.first().map_or(0, |column| column.len() / merged);
    let entry = |row: usize, column: usize| {
        let values = &table[column][row * merged..(row + 1) * merged];
        values.iter().sum::<f64>() / merged as f64 - offsets[column]
    };
    RowSequence {
        regressors: DMatrix::from_fn(count, regressors, entry),
        targets: DMatrix::from_fn(count, table.len() - regressors, |row, target| {
            entry(row, regressors + target)
        }),
    }
}

impl SequencedRows {
    /// Returns the number of rows.
    pub fn count(&self) -> f64 {
        self.blocks
            .first()
            .map_or(0.0, |sequences| sequences.iter().map(|s| s.regressors.nrows() as f64).sum())
    }

    /// Returns `sum_kl F_k G_l' kernel(|k - l|) / n^2` of the regressors of two regressions over
    /// rows of the same sequence.
    pub fn weighted_products(&self, one: usize, other: usize, kernel: &[f64]) -> DMatrix<f64> {
        let (first, second) = (&self.blocks[one], &self.blocks[other]);
        let columns =
            |sequences: &[RowSequence]| sequences.first().map_or(0, |s| s.regressors.ncols());
        let mut sum = DMatrix::zeros(columns(first), columns(second));
        for (left, right) in first.iter().zip(second) {
            sum.gemm_tr(1.0, &left.regressors, &apply_kernel(&right.regressors, kernel), 1.0);
        }
        sum / self.count().max(1.0).powi(2)
    }
}

/// Columns convolved with a symmetric kernel, truncated at the ends.
fn apply_kernel(columns: &DMatrix<f64>, kernel: &[f64]) -> DMatrix<f64> {
    let count = columns.nrows();
    let mut result = columns * kernel.first().copied().unwrap_or(0.0);
    for (column, mut sums) in columns.column_iter().zip(result.column_iter_mut()) {
        let (column, sums) = (column.as_slice(), sums.as_mut_slice());
        for (lag, weight) in kernel.iter().enumerate().take(count).skip(1) {
            sums[lag..].iter_mut().zip(column).for_each(|(sum, x)| *sum += weight * x);
            sums.iter_mut().zip(&column[lag..]).for_each(|(sum, x)| *sum += weight * x);
        }
    }
    result
}
