//! Replacement of rows by linear combinations of rows, a block of columns at a time.

use std::ops::Range;

/// Number of columns in a block; the arrays that are replaced and added must have as many elements
/// of padding.
pub(super) const COLUMN_BLOCK: usize = 16;
/// Largest number of rows that are replaced: eight states move.
const MAX_ROWS: usize = 8;
/// Largest number of terms of a row: those rows, and one of each stage of a step.
const MAX_TERMS: usize = MAX_ROWS + 4;

/// Linear combination for each row: factors and source rows, the replaced rows first.
pub(super) struct RowSums {
    rows: usize,
    terms: [[(f64, u8); MAX_TERMS]; MAX_ROWS],
    counts: [u8; MAX_ROWS],
}

impl RowSums {
    #[inline(always)]
    pub fn new(rows: usize) -> Self {
        Self { rows, terms: [[(0.0, 0); MAX_TERMS]; MAX_ROWS], counts: [0; MAX_ROWS] }
    }

    /// Adds a multiple of a source row to the combination of a row; a factor of zero adds nothing.
    #[inline(always)]
    pub fn add_term(&mut self, row: usize, of: usize, factor: f64) {
        if factor != 0.0 {
            self.terms[row][usize::from(self.counts[row])] = (factor, of as u8);
            self.counts[row] += 1;
        }
    }

    /// Replaces columns of the rows, which are `stride` apart in `own`, by their combinations of
    /// the old rows and of `others`.
    #[inline(always)]
    pub fn replace_rows(
        &self,
        own: &mut [f64],
        stride: usize,
        others: &[&[f64]],
        columns: Range<usize>,
    ) {
        let mut block = [[0.0; COLUMN_BLOCK]; MAX_TERMS];
        let mut from = columns.start;
        while from < columns.end {
            // All rows of the block are copied first, because every combination reads the old
            // values.
            for row in 0..self.rows {
                block[row].copy_from_slice(&own[row * stride + from..][..COLUMN_BLOCK]);
            }
            for (row, other) in others.iter().enumerate() {
                block[self.rows + row].copy_from_slice(&other[from..][..COLUMN_BLOCK]);
            }
            let width = columns.end - from;
            for row in 0..self.rows {
                let mut sum = self.combine_row(row, &block);
                for k in 0..COLUMN_BLOCK {
                    // Columns beyond the range are written back unchanged: faster than a shorter
                    // write.
                    sum[k] = if k < width { sum[k] } else { block[row][k] };
                }
                own[row * stride + from..][..COLUMN_BLOCK].copy_from_slice(&sum);
            }
            from += COLUMN_BLOCK;
        }
    }

    #[inline(always)]
    fn combine_row(
        &self,
        row: usize,
        block: &[[f64; COLUMN_BLOCK]; MAX_TERMS],
    ) -> [f64; COLUMN_BLOCK] {
        let mut sum = [0.0; COLUMN_BLOCK];
        for &(factor, of) in &self.terms[row][..usize::from(self.counts[row])] {
            let term = &block[usize::from(of)];
            for k in 0..COLUMN_BLOCK {
                sum[k] += factor * term[k];
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_replaced_in_some_columns_and_kept_in_others() {
        const STRIDE: usize = 41;
        let row = |of: f64, length: usize| {
            (0..length).map(|k| (of * k as f64).sin()).collect::<Vec<f64>>()
        };
        let (own, other) = (row(0.3, 2 * STRIDE + COLUMN_BLOCK), row(1.1, STRIDE + COLUMN_BLOCK));
        let mut sums = RowSums::new(2);
        [(0, 1, 0.5), (0, 0, 0.0), (0, 2, -2.0), (1, 1, 1.0), (1, 0, 3.0)]
            .into_iter()
            .for_each(|(row, of, f)| sums.add_term(row, of, f));
        for columns in [0..0, 0..STRIDE, 3..10, 7..23, 5..40] {
            let mut out = own.clone();
            sums.replace_rows(&mut out, STRIDE, &[&other], columns.clone());
            for k in 0..STRIDE {
                let (a, b, inside) = (own[k], own[STRIDE + k], columns.contains(&k));
                let expected =
                    if inside { [0.5 * b - 2.0 * other[k], b + 3.0 * a] } else { [a, b] };
                assert_eq!([out[k], out[STRIDE + k]], expected, "column {k} of {columns:?}");
            }
            assert_eq!(out[2 * STRIDE..], own[2 * STRIDE..]);
        }
    }
}
