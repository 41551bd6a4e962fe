//! Sums over samples of the products of whitened columns, which suffice for fitting and comparing
//! hypotheses.

use nalgebra::{Cholesky, DMatrix, DMatrixView};

use super::symmetric_products::symmetric_products;

/// Products of whitened residual (index 0) and columns (from 1), with the further terms of the
/// likelihood.
#[derive(Debug, Clone)]
pub struct GramMatrix {
    /// Symmetric; index 0 is the residual.
    pub products: DMatrix<f64>,
    /// Sum of the logarithms of the predicted variances.
    pub log_variance: f64,
    /// Number of readings.
    pub count: usize,
}

/// Number of columns that a general product multiplies at a time.
const BLOCK: usize = 48;
/// Number of rows or columns up to which it does not fuse (nalgebra's `gemm`, 5).
const UNFUSED: usize = 5;

impl GramMatrix {
    /// Sums the products of whitened rows, each of `width` numbers, the residual first.
    pub fn from_rows(rows: &[f64], width: usize, log_variance: f64) -> Self {
        let count = rows.len() / width;
        Self { products: column_products(rows, (width, count)), log_variance, count }
    }

    /// Creates the sums of no sample.
    pub fn zeros(width: usize) -> Self {
        Self { products: DMatrix::zeros(width, width), log_variance: 0.0, count: 0 }
    }

    /// Selects some of the columns (the residual first, then these indices of columns); an index
    /// may occur more than once.
    pub fn select_columns(&self, columns: &[usize]) -> Self {
        let place = |i: usize| if i == 0 { 0 } else { 1 + columns[i - 1] };
        let size = 1 + columns.len();
        let products = DMatrix::from_fn(size, size, |i, j| self.products[(place(i), place(j))]);
        Self { products, log_variance: self.log_variance, count: self.count }
    }

    /// Integrates out the last columns under standard normal priors; none where the products are
    /// not positive.
    pub fn integrate_last(self, count: usize) -> Option<Self> {
        if count == 0 {
            return Some(self);
        }
        let kept = self.products.nrows() - count;
        let own = self.products.view((kept, kept), (count, count));
        let factor = Cholesky::new(own + DMatrix::<f64>::identity(count, count))?;
        let cross = self.products.view((kept, 0), (count, kept)).into_owned();
        let products =
            self.products.view((0, 0), (kept, kept)) - cross.tr_mul(&factor.solve(&cross));
        let log_determinant: f64 =
            2.0 * factor.l_dirty().diagonal().iter().map(|x| x.ln()).sum::<f64>();
        Some(Self { products, log_variance: self.log_variance + log_determinant, ..self })
    }

    /// Adds the sums of other samples.
    pub fn add(&mut self, other: &Self) {
        self.products += &other.products;
        self.log_variance += other.log_variance;
        self.count += other.count;
    }

    /// Adds the sums of all parts.
    pub fn sum_parts<'a>(parts: impl IntoIterator<Item = &'a Self>, width: usize) -> Self {
        parts.into_iter().fold(Self::zeros(width), |mut sum, part| {
            sum.add(part);
            sum
        })
    }
}

/// Products of all columns over readings. Small products, which a general product does not fuse,
/// are computed by that one: models that were made by it are still verified bit by bit.
fn column_products(rows: &[f64], (width, count): (usize, usize)) -> DMatrix<f64> {
    let readings = DMatrixView::from_slice(rows, width, count);
    let is_fused = width > UNFUSED && count > UNFUSED;
    let fused = is_fused.then(|| symmetric_products(rows, width)).flatten();
    let Some(mut products) = fused else { return blocked_products(readings) };
    // The last block of columns may be too small to be fused: it is computed again by the general
    // product.
    let last = width % BLOCK;
    if last <= UNFUSED {
        let own = readings.rows(width - last, last);
        products
            .view_mut((width - last, width - last), (last, last))
            .copy_from(&blocked_products(own));
    }
    products
}

/// Products by a general product, of which one triangle is computed.
fn blocked_products(readings: DMatrixView<'_, f64>) -> DMatrix<f64> {
    let width = readings.nrows();
    let mut products = DMatrix::zeros(width, width);
    for start in (0..width).step_by(BLOCK) {
        let size = BLOCK.min(width - start);
        let below = readings.rows(start, width - start) * readings.rows(start, size).transpose();
        products.view_mut((start, start), (width - start, size)).copy_from(&below);
    }
    products.fill_upper_triangle_with_lower_triangle();
    products
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A column that is integrated out widens the covariance of the readings by its square.
    #[test]
    fn an_integrated_column_is_part_of_the_covariance() {
        let gram = GramMatrix {
            products: DMatrix::from_row_slice(2, 2, &[9.0, 6.0, 6.0, 4.0]),
            log_variance: 1.0,
            count: 1,
        };
        // One reading of 3 with variance 1 + 2^2.
        let without = gram.integrate_last(1).map(|gram| (gram.products[(0, 0)], gram.log_variance));
        let (square, log_variance) = without.unwrap_or_default();
        assert!(
            (square - 9.0 / 5.0).abs() < 1e-12 && (log_variance - 1.0 - 5.0_f64.ln()).abs() < 1e-12
        );
    }

    /// Columns are counted from 0 beside the residual, and one may be selected twice.
    #[test]
    fn selected_columns_have_the_products_of_their_rows() {
        let rows = [1.0, 2.0, 3.0, 5.0, -1.0, 4.0, 0.5, 7.0];
        let selected = [1.0, 5.0, 5.0, 2.0, -1.0, 7.0, 7.0, 4.0];
        let gram = GramMatrix::from_rows(&rows, 4, 0.5).select_columns(&[2, 2, 0]);
        assert_eq!(gram.products, GramMatrix::from_rows(&selected, 4, 0.5).products);
        assert_eq!((gram.log_variance, gram.count), (0.5, 2));
    }

    #[test]
    fn products_are_those_of_blocks_to_the_last_bit() {
        let reading = |k: usize| (k as f64 * 0.7).sin() * 10_f64.powi(k as i32 % 5);
        let cases = [(9, 0), (0, 9), (4, 30), (6, 3), (300, 50), (700, 96), (256, 101), (90, 151)];
        for (count, width) in cases {
            let rows: Vec<f64> = (0..count * width).map(reading).collect();
            let blocks = blocked_products(DMatrixView::from_slice(&rows, width, count));
            let own = column_products(&rows, (width, count));
            assert_eq!(own.shape(), (width, width));
            let differ = own.iter().zip(&blocks).filter(|(a, b)| a.to_bits() != b.to_bits());
            assert_eq!(differ.count(), 0, "{count} readings of {width} columns");
        }
    }
}
