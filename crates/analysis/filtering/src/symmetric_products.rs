//! Sums over readings of the products of all columns: one triangle of a symmetric matrix.
//!
//! A general matrix product needs three packings and both triangles; this one needs one packing and
//! one triangle. Each sum is made as `matrixmultiply` makes it, product by product with fused
//! multiplication and in blocks of as many readings: the results, and so the models made by it, are
//! the same to the last bit.

use nalgebra::DMatrix;
use sistership_simulation::simd::{SimdKernel, dispatch_fused};

/// Number of readings in a block: that of `matrixmultiply`, whose sums these are.
const READINGS: usize = 256;
/// Number of columns in a strip: the lanes of the widest instructions.
const STRIP: usize = 8;

/// A strip of columns at one reading.
type StripValues = [f64; STRIP];

/// Products of readings, `width` numbers each; none where the processor has no fused
/// multiplication.
pub(super) fn symmetric_products(readings: &[f64], width: usize) -> Option<DMatrix<f64>> {
    let mut products = DMatrix::zeros(width, width);
    dispatch_fused(SymmetricProducts { readings, width, products: &mut products }).then(|| {
        products.fill_upper_triangle_with_lower_triangle();
        products
    })
}

struct SymmetricProducts<'a> {
    readings: &'a [f64],
    width: usize,
    /// Matrix whose lower triangle is filled.
    products: &'a mut DMatrix<f64>,
}

impl SimdKernel for SymmetricProducts<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { readings, width, products } = self;
        let mut strips = Vec::new();
        for block in readings.chunks(READINGS * width) {
            let count = block.len() / width;
            pack_strips(block, width, &mut strips);
            // Strips on and below the diagonal alone: the upper triangle is a copy.
            for (row, left) in strips.chunks_exact(count).enumerate() {
                for (column, right) in strips.chunks_exact(count).take(row + 1).enumerate() {
                    let tile = strip_products(left, right);
                    add_tile(&tile, (row * STRIP, column * STRIP), products);
                }
            }
        }
    }
}

/// Packs a block of readings strip by strip; columns beyond the last are zero.
#[inline(always)]
fn pack_strips(block: &[f64], width: usize, strips: &mut Vec<StripValues>) {
    let count = block.len() / width;
    strips.clear();
    strips.resize(count * width.div_ceil(STRIP), [0.0; STRIP]);
    for (place, reading) in block.chunks_exact(width).enumerate() {
        for (strip, columns) in reading.chunks(STRIP).enumerate() {
            strips[strip * count + place][..columns.len()].copy_from_slice(columns);
        }
    }
}

/// Products of the columns of two strips, with a row for each column of the left one.
#[inline(always)]
fn strip_products(left: &[StripValues], right: &[StripValues]) -> [StripValues; STRIP] {
    let mut sums = [[0.0; STRIP]; STRIP];
    for (left, right) in left.iter().zip(right) {
        for (sums, factor) in sums.iter_mut().zip(left) {
            for (sum, value) in sums.iter_mut().zip(right) {
                *sum = factor.mul_add(*value, *sum);
            }
        }
    }
    sums
}

#[inline(always)]
fn add_tile(
    tile: &[StripValues; STRIP],
    (row, column): (usize, usize),
    products: &mut DMatrix<f64>,
) {
    let width = products.nrows();
    for j in column..width.min(column + STRIP) {
        for i in j.max(row)..width.min(row + STRIP) {
            products[(i, j)] += tile[i - row][j - column];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_reading_has_no_product() {
        let none = symmetric_products(&[], 12);
        assert!(none.is_none_or(|products| products == DMatrix::zeros(12, 12)));
    }
}
