//! Sums over readings of the products of strips of columns.

use nalgebra::DMatrix;
use sistership_simulation::simd::{SimdKernel, dispatch_fused, dispatch_simd};

use super::strip_filter::{STRIP, StripValues};

/// Number of readings in a block: two strips of it stay in the nearest cache.
const READINGS: usize = 256;

/// Strips over some readings.
#[derive(Clone, Copy)]
pub(super) struct StripRange<'a> {
    /// Strip after strip, by readings.
    pub strips: &'a [StripValues],
    /// Number of readings of each strip.
    pub count: usize,
    /// First and last reading, exclusive.
    pub readings: (usize, usize),
}

impl<'a> StripRange<'a> {
    fn strip_count(self) -> usize {
        self.strips.len().checked_div(self.count).unwrap_or(0)
    }

    #[inline(always)]
    fn block(self, strip: usize, (from, to): (usize, usize)) -> &'a [StripValues] {
        &self.strips[strip * self.count..][from..to]
    }
}

/// Products of the columns of two sets of strips. With `is_square` both are the same, and strips on
/// and below the diagonal alone are computed.
pub(super) fn strip_products(
    (left, right): (StripRange<'_>, StripRange<'_>),
    is_square: bool,
) -> DMatrix<f64> {
    let mut products = DMatrix::zeros(left.strip_count() * STRIP, right.strip_count() * STRIP);
    let fused = ProductKernel::<true> { left, right, is_square, products: &mut products };
    if !dispatch_fused(fused) {
        dispatch_simd(ProductKernel::<false> { left, right, is_square, products: &mut products });
    }
    if is_square {
        // Half of the tiles were computed.
        products.fill_upper_triangle_with_lower_triangle();
    }
    products
}

struct ProductKernel<'a, const FUSED: bool> {
    left: StripRange<'a>,
    right: StripRange<'a>,
    is_square: bool,
    products: &'a mut DMatrix<f64>,
}

impl<const FUSED: bool> SimdKernel for ProductKernel<'_, FUSED> {
    #[inline(always)]
    fn run(self) {
        let Self { left, right, is_square, products } = self;
        let (mut from, end) = left.readings;
        while from < end {
            let block = (from, end.min(from + READINGS));
            for row in 0..left.strip_count() {
                let columns = if is_square { row + 1 } else { right.strip_count() };
                for column in 0..columns {
                    let tile =
                        tile_products::<FUSED>(left.block(row, block), right.block(column, block));
                    add_tile(&tile, (row * STRIP, column * STRIP), products);
                }
            }
            from = block.1;
        }
    }
}

/// Products of the columns of two strips, with a row for each column of the left one.
#[inline(always)]
fn tile_products<const FUSED: bool>(
    left: &[StripValues],
    right: &[StripValues],
) -> [StripValues; STRIP] {
    let mut sums = [[0.0; STRIP]; STRIP];
    for (left, right) in left.iter().zip(right) {
        for (sums, factor) in sums.iter_mut().zip(left) {
            for (sum, value) in sums.iter_mut().zip(right) {
                *sum = if FUSED { factor.mul_add(*value, *sum) } else { factor * value + *sum };
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
    for j in 0..STRIP {
        for i in 0..STRIP {
            products[(row + i, column + j)] += tile[i][j];
        }
    }
}
