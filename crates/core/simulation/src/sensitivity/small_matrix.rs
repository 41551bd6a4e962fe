//! Small square matrices whose entries are lanes.

use crate::tape::LaneValues;

/// Square matrix, stored by rows.
#[derive(Debug, Clone)]
pub(super) struct SmallMatrix<const L: usize> {
    pub order: usize,
    pub entries: Vec<LaneValues<L>>,
}

impl<const L: usize> SmallMatrix<L> {
    pub fn zeros(order: usize) -> Self {
        Self { order, entries: vec![[0.0; L]; order * order] }
    }

    #[inline(always)]
    pub fn entry(&self, row: usize, column: usize) -> &LaneValues<L> {
        &self.entries[row * self.order + column]
    }

    #[inline(always)]
    pub fn entry_mut(&mut self, row: usize, column: usize) -> &mut LaneValues<L> {
        &mut self.entries[row * self.order + column]
    }

    /// Sets the matrix to `diagonal * I + factor * other`.
    #[inline(always)]
    pub fn set_scaled(&mut self, diagonal: f64, factor: f64, other: &Self) {
        for (entry, other) in self.entries.iter_mut().zip(&other.entries) {
            for lane in 0..L {
                entry[lane] = factor * other[lane];
            }
        }
        for i in 0..self.order {
            self.entry_mut(i, i).iter_mut().for_each(|value| *value += diagonal);
        }
    }

    /// Sets the matrix to the product `a b`.
    #[inline(always)]
    pub fn set_product(&mut self, a: &Self, b: &Self) {
        let order = self.order;
        for (row, out) in self.entries.chunks_exact_mut(order).enumerate() {
            out.fill([0.0; L]);
            for k in 0..order {
                let factor = *a.entry(row, k);
                for (entry, b) in out.iter_mut().zip(&b.entries[k * order..(k + 1) * order]) {
                    for lane in 0..L {
                        entry[lane] += factor[lane] * b[lane];
                    }
                }
            }
        }
    }

    #[inline(always)]
    pub fn add(&mut self, other: &Self) {
        for (entry, other) in self.entries.iter_mut().zip(&other.entries) {
            for lane in 0..L {
                entry[lane] += other[lane];
            }
        }
    }
}
