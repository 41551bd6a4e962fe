//! Sums over readings of the products of strips of columns.

use nalgebra::DMatrix;
use sistership_simulation::simd::{SimdKernel, dispatch_fused, dispatch_simd};

use super::strip_filter::{STRIP, StripValues};

/// Number of readings in a block: two strips of it stay in the nearest cache. It is that of
/// `matrixmultiply`, whose sums [`super::symmetric_products`] repeats.
pub(super) const READINGS: usize = 256;

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

    fn reading_count(self) -> usize {
        self.readings.1 - self.readings.0
    }

    /// Values of a strip over some of the readings, which count from the first of the range.
    #[inline(always)]
    fn block(self, strip: usize, (from, to): (usize, usize)) -> &'a [StripValues] {
        &self.strips[strip * self.count + self.readings.0..][from..to]
    }
}

/// Products of the columns of two sets of strips. With `is_square` both are the same, and strips on
/// and below the diagonal alone are computed.
pub(super) fn strip_products(
    (left, right): (StripRange<'_>, StripRange<'_>),
    is_square: bool,
) -> DMatrix<f64> {
    let mut products = DMatrix::zeros(left.strip_count() * STRIP, right.strip_count() * STRIP);
    add_products((left, right), is_square, &mut products);
    if is_square {
        // Half of the tiles were computed.
        products.fill_upper_triangle_with_lower_triangle();
    }
    products
}

/// Products of the numbers of rows with strips of as many values: numbers by lanes.
pub(super) fn row_products(rows: &[f64], width: usize, strips: &[StripValues]) -> DMatrix<f64> {
    let count = rows.len().checked_div(width).unwrap_or(0);
    let lanes = strips.len().checked_div(count).unwrap_or(0) * STRIP;
    let mut products = DMatrix::zeros(width.next_multiple_of(STRIP), lanes);
    let mut packed = Vec::new();
    for (block, rows) in rows.chunks((READINGS * width).max(1)).enumerate() {
        pack_strips(rows, width, &mut packed);
        let (from, size) = (block * READINGS, rows.len() / width);
        let left = StripRange { strips: &packed, count: size, readings: (0, size) };
        let right = StripRange { strips, count, readings: (from, from + size) };
        add_products((left, right), false, &mut products);
    }
    products
}

/// Packs rows of numbers strip by strip; numbers beyond the last are zero.
pub(super) fn pack_strips(rows: &[f64], width: usize, strips: &mut Vec<StripValues>) {
    let count = rows.len() / width;
    strips.clear();
    strips.resize(count * width.div_ceil(STRIP), [0.0; STRIP]);
    for (place, row) in rows.chunks_exact(width).enumerate() {
        for (strip, numbers) in row.chunks(STRIP).enumerate() {
            strips[strip * count + place][..numbers.len()].copy_from_slice(numbers);
        }
    }
}

fn add_products(
    ranges: (StripRange<'_>, StripRange<'_>),
    is_square: bool,
    products: &mut DMatrix<f64>,
) {
    if !dispatch_fused(ProductKernel::<true>::new(ranges, is_square, products)) {
        dispatch_simd(ProductKernel::<false>::new(ranges, is_square, products));
    }
}

/// Arguments of the products, which are added to those of earlier readings.
pub(super) struct ProductKernel<'a, const FUSED: bool> {
    left: StripRange<'a>,
    right: StripRange<'a>,
    is_square: bool,
    products: &'a mut DMatrix<f64>,
}

impl<'a, const FUSED: bool> ProductKernel<'a, FUSED> {
    pub fn new(
        (left, right): (StripRange<'a>, StripRange<'a>),
        is_square: bool,
        products: &'a mut DMatrix<f64>,
    ) -> Self {
        Self { left, right, is_square, products }
    }
}

impl<const FUSED: bool> SimdKernel for ProductKernel<'_, FUSED> {
    #[inline(always)]
    fn run(self) {
        let Self { left, right, is_square, products } = self;
        let (mut from, end) = (0, left.reading_count());
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
