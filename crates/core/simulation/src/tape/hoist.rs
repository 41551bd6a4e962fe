//! Separation of the operations of a listing that depend on some inputs alone: the sine of a
//! recorded rudder is the same for every model.

use super::listing::OperationList;
use super::{ResultSlot, TapeOp};

impl OperationList {
    /// Splits off the operations that call functions or divide and that depend on no input before
    /// `from`: the first listing calculates them from all inputs; the second has the outputs of
    /// this listing and takes the results of the first after its inputs.
    pub fn split_hoisted(mut self, from: usize) -> (Self, Self) {
        let ahead = self.hoisted_slots(from);
        let front = Self { outputs: ahead.clone(), ..self.clone() }.without_unused();
        let given = self.inputs.len();
        // A hoisted operation becomes an input that takes the value calculated in advance.
        for (place, &slot) in ahead.iter().enumerate() {
            self.ops[slot as usize] = TapeOp::Input((given + place) as u32);
            self.inputs.push(format!("hoisted {place}"));
        }
        (front, self.without_unused())
    }

    /// Operations that are worth calculating in advance.
    fn hoisted_slots(&self, from: usize) -> Vec<ResultSlot> {
        // True for operations that depend on an input before `from`, directly or through an
        // operand.
        let mut later = vec![false; self.ops.len()];
        for (index, op) in self.ops.iter().enumerate() {
            later[index] = match *op {
                TapeOp::Input(input) => (input as usize) < from,
                _ => op.operands().into_iter().flatten().any(|slot| later[slot as usize]),
            };
        }
        // Cheap operations are not worth an additional input.
        let dear = |op: &TapeOp| {
            matches!(
                op,
                TapeOp::Call1(..) | TapeOp::Call2(..) | TapeOp::Power(..) | TapeOp::Divide(..)
            )
        };
        let kept = self.ops.iter().enumerate().filter(|(index, op)| !later[*index] && dear(op));
        kept.map(|(index, _)| index as ResultSlot).collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::TapeBuilder;
    use sistership_formula::parse;

    #[test]
    fn what_is_done_ahead_changes_nothing() {
        let texts =
            ["u*sin(delta)/(2 + cos(u)) + n/delta", "sin(delta)*n", "u*cos(sin(delta)) + abs(n)"];
        let builder = || {
            let mut builder = TapeBuilder::new(&["u", "delta", "n"], |_| None);
            texts
                .iter()
                .for_each(|text| assert!(builder.add_output(&parse(text).unwrap()).is_ok()));
            builder
        };
        let tape = builder().finish();
        let (front, back) = builder().finish_hoisted(1);
        let point = [0.7, -0.3, 1.9];
        let ahead = front.evaluate_point(&point);
        assert_eq!(ahead.len(), 4, "sine, cosine of it, quotient and modulus");
        assert_eq!(
            back.evaluate_point(&[&point[..], &ahead].concat()),
            tape.evaluate_point(&point)
        );
        assert!(back.len() < tape.len() + ahead.len());
    }
}
