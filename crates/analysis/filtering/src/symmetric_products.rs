//! Sums over readings of the products of all columns: one triangle of a symmetric matrix.
//!
//! A general matrix product needs three packings and both triangles; this one needs one packing and
//! one triangle. Each sum is made as `matrixmultiply` makes it, product by product with fused
//! multiplication and in blocks of as many readings: the results, and so the models made by it, are
//! the same to the last bit.

use nalgebra::DMatrix;
use sistership_simulation::simd::dispatch_fused;

use super::strip_filter::STRIP;
use super::strip_products::{ProductKernel, READINGS, StripRange, pack_strips};

/// Products of readings, `width` numbers each; none where the processor has no fused
/// multiplication.
pub(super) fn symmetric_products(readings: &[f64], width: usize) -> Option<DMatrix<f64>> {
    let size = width.next_multiple_of(STRIP);
    let (mut products, mut strips) = (DMatrix::zeros(size, size), Vec::new());
    for block in readings.chunks(READINGS * width) {
        pack_strips(block, width, &mut strips);
        let count = block.len() / width;
        let all = StripRange { strips: &strips, count, readings: (0, count) };
        if !dispatch_fused(ProductKernel::<true>::new((all, all), true, &mut products)) {
            return None;
        }
    }
    products.fill_upper_triangle_with_lower_triangle();
    Some(products.resize(width, width, 0.0))
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
