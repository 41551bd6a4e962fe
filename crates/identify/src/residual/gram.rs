//! Sums over samples of the products of whitened columns: all that fitting and comparing hypotheses need.

use nalgebra::DMatrix;

/// Products of whitened residual (place 0) and columns (from 1), with what the likelihood needs besides.
#[derive(Debug, Clone)]
pub struct Gram {
    /// Symmetric; place 0 is the residual.
    pub products: DMatrix<f64>,
    /// Sum of the logarithms of the predicted variances.
    pub log_variance: f64,
    /// Number of readings.
    pub count: usize,
}

impl Gram {
    /// Of whitened rows, each of `width` numbers, the residual first.
    pub fn of_rows(rows: Vec<f64>, width: usize, log_variance: f64) -> Self {
        let count = rows.len() / width;
        // Rows of samples are columns of this matrix, so that the product is nalgebra's fast one.
        let matrix = DMatrix::from_vec(width, count, rows);
        let products = &matrix * matrix.transpose();
        Self { products, log_variance, count }
    }

    /// Of no sample.
    pub fn empty(width: usize) -> Self {
        Self { products: DMatrix::zeros(width, width), log_variance: 0.0, count: 0 }
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
