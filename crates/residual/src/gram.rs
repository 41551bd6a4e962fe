//! Sums over samples of the products of whitened columns: all that fitting and comparing hypotheses
//! need.

use nalgebra::DMatrix;

/// Products of whitened residual (place 0) and columns (from 1), with what the likelihood needs
/// besides.
#[derive(Debug, Clone)]
pub struct Gram {
    /// Symmetric; place 0 is the residual.
    pub products: DMatrix<f64>,
    /// Sum of the logarithms of the predicted variances.
    pub log_variance: f64,
    /// Number of readings.
    pub count: usize,
}

/// Columns that are multiplied at a time.
const BLOCK: usize = 48;

impl Gram {
    /// Of whitened rows, each of `width` numbers, the residual first.
    pub fn of_rows(rows: Vec<f64>, width: usize, log_variance: f64) -> Self {
        let count = rows.len() / width;
        // Rows of samples are columns of this matrix, so that the product is nalgebra's fast one.
        Self::of_columns(&DMatrix::from_vec(width, count, rows), log_variance)
    }

    /// Of whitened readings as columns, the residual first in each. Only one triangle is computed,
    /// in blocks.
    pub fn of_columns(readings: &DMatrix<f64>, log_variance: f64) -> Self {
        let (width, count) = readings.shape();
        let mut products = DMatrix::zeros(width, width);
        for start in (0..width).step_by(BLOCK) {
            let size = BLOCK.min(width - start);
            let below =
                readings.rows(start, width - start) * readings.rows(start, size).transpose();
            products.view_mut((start, start), (width - start, size)).copy_from(&below);
        }
        products.fill_upper_triangle_with_lower_triangle();
        Self { products, log_variance, count }
    }

    /// Of no sample.
    pub fn empty(width: usize) -> Self {
        Self { products: DMatrix::zeros(width, width), log_variance: 0.0, count: 0 }
    }

    /// Some of the columns (the residual first, then these places of columns), perhaps one more
    /// than once.
    pub fn select(&self, columns: &[usize]) -> Self {
        let place = |i: usize| if i == 0 { 0 } else { 1 + columns[i - 1] };
        let size = 1 + columns.len();
        let products = DMatrix::from_fn(size, size, |i, j| self.products[(place(i), place(j))]);
        Self { products, log_variance: self.log_variance, count: self.count }
    }

    /// Adds other samples.
    pub fn add(&mut self, other: &Self) {
        self.products += &other.products;
        self.log_variance += other.log_variance;
        self.count += other.count;
    }

    /// All of these together.
    pub fn sum<'a>(parts: impl IntoIterator<Item = &'a Self>, width: usize) -> Self {
        parts.into_iter().fold(Self::empty(width), |mut sum, part| {
            sum.add(part);
            sum
        })
    }
}
