//! Fusion of sums of products into single instructions: these are most of what a law calculates,
//! and as separate operations each would wait for the result of the one before.

use super::instruction::{Tape, TapeInstruction};
use super::listing::OperationList;
use super::{ResultSlot, TapeOp};

/// Sum of products that is being built.
struct ProductSum {
    first: ResultSlot,
    terms: Vec<[ResultSlot; 2]>,
}

/// State of the fusion of operations.
struct ProductFusion<'a> {
    ops: &'a [TapeOp],
    uses: Vec<u32>,
    sums: Vec<Option<ProductSum>>,
    /// True for operations that are part of another instruction.
    absorbed: Vec<bool>,
}

impl OperationList {
    /// Returns the tape of the listing with fused products; its rounding is the same.
    pub fn into_tape(self) -> Tape {
        let mut fusing = ProductFusion::new(&self);
        (0..self.ops.len()).for_each(|index| fusing.fuse_addition(index));
        let ProductFusion { sums, absorbed, .. } = fusing;
        // Place of each operation's instruction.
        let mut place = vec![0; self.ops.len()];
        let (mut instructions, mut terms) = (Vec::new(), Vec::new());
        // Operands precede their operation, so that their new places are known.
        for (index, sum) in sums.iter().enumerate().filter(|(index, _)| !absorbed[*index]) {
            place[index] = instructions.len() as ResultSlot;
            let to = |slot: ResultSlot| place[slot as usize];
            instructions.push(match sum {
                None => TapeInstruction::Op(self.ops[index].remap_operands(&to)),
                Some(sum) => {
                    let from = terms.len() as u32;
                    terms.extend(sum.terms.iter().map(|&[a, b]| [to(a), to(b)]));
                    TapeInstruction::Products { first: to(sum.first), from, to: terms.len() as u32 }
                }
            });
        }
        let outputs = self.outputs.iter().map(|&slot| place[slot as usize]).collect();
        Tape { inputs: self.inputs, instructions, terms, outputs }
    }
}

impl<'a> ProductFusion<'a> {
    fn new(listing: &'a OperationList) -> Self {
        let ops = &listing.ops;
        let mut uses = vec![0; ops.len()];
        let read = ops.iter().flat_map(|op| op.operands().into_iter().flatten());
        read.chain(listing.outputs.iter().copied()).for_each(|slot| uses[slot as usize] += 1);
        Self {
            ops,
            uses,
            sums: ops.iter().map(|_| None).collect(),
            absorbed: vec![false; ops.len()],
        }
    }

    /// Fuses an addition with a product that only this addition reads, and with the sum before it
    /// if only this addition reads that.
    fn fuse_addition(&mut self, index: usize) {
        let TapeOp::Add(a, b) = self.ops[index] else { return };
        // Either operand of the addition may be the product.
        let Some((before, product, factors)) =
            self.single_use_product(a, b).or_else(|| self.single_use_product(b, a))
        else {
            return;
        };
        let kept =
            if self.is_single_use(before) { self.sums[before as usize].take() } else { None };
        self.absorbed[before as usize] |= kept.is_some();
        self.absorbed[product as usize] = true;
        let mut sum = kept.unwrap_or(ProductSum { first: before, terms: Vec::new() });
        sum.terms.push(factors);
        self.sums[index] = Some(sum);
    }

    fn single_use_product(
        &self,
        before: ResultSlot,
        product: ResultSlot,
    ) -> Option<(ResultSlot, ResultSlot, [ResultSlot; 2])> {
        let TapeOp::Multiply(a, b) = self.ops[product as usize] else { return None };
        self.is_single_use(product).then_some((before, product, [a, b]))
    }

    fn is_single_use(&self, slot: ResultSlot) -> bool {
        self.uses[slot as usize] == 1
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::TapeBuilder;
    use super::*;
    use sistership_formula::parse;

    /// As a tape, and with every operation by itself.
    fn both(texts: &[&str]) -> [Tape; 2] {
        let mut builder = TapeBuilder::new(&["u", "v", "r"], |_| None);
        texts.iter().for_each(|text| assert!(builder.add_output(&parse(text).unwrap()).is_ok()));
        let (inputs, ops, outputs) =
            (builder.inputs.clone(), builder.ops.clone(), builder.outputs.clone());
        let listing = OperationList { inputs, ops, outputs }.without_unused();
        let plain = Tape {
            inputs: listing.inputs.clone(),
            instructions: listing.ops.iter().map(|op| TapeInstruction::Op(*op)).collect(),
            terms: Vec::new(),
            outputs: listing.outputs.clone(),
        };
        [listing.into_tape(), plain]
    }

    #[test]
    fn sums_of_products_round_as_one_by_one() {
        let texts =
            ["0.3*u + 1.7*v*v - r + u*v*r + 0.1*(u*v + r*r) + v*r", "u*v + (u*v + v*r)", "u + v"];
        let [fused, plain] = both(&texts);
        assert!(fused.len() < plain.len());
        for k in 0..50 {
            let x = 0.37 * f64::from(k);
            let point = [x.sin(), (2.0 * x).cos(), x.exp().sin()];
            assert_eq!(fused.evaluate_point(&point), plain.evaluate_point(&point));
            assert_eq!(fused.jacobian(&point), plain.jacobian(&point));
        }
    }

    #[test]
    fn products_that_are_read_elsewhere_too_stay_by_themselves() {
        let [fused, plain] = both(&["u*v + v*r", "v*r"]);
        assert_eq!((fused.len(), plain.len()), (5, 6));
        let [fused, plain] = both(&["u*v + (v*r + 2)", "v*r + 2", "u*v"]);
        assert_eq!(fused.evaluate_point(&[2.0, 3.0, 5.0]), [23.0, 17.0, 6.0]);
        assert_eq!(plain.evaluate_point(&[2.0, 3.0, 5.0]), [23.0, 17.0, 6.0]);
    }

    #[test]
    fn a_sum_depends_on_what_its_terms_do() {
        let [fused, plain] = both(&["u*u + v*r"]);
        for tape in [fused, plain] {
            assert_eq!(tape.jacobian(&[2.0, 3.0, 5.0]), [[4.0, 5.0, 3.0]]);
        }
    }
}
