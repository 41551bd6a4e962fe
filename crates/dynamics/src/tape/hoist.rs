//! What depends on some inputs alone, taken out of a tape: a sine of a recorded rudder is the same for every model.

use super::{Op, Slot, Tape};

impl Tape {
    /// Splits off what calls functions or divides and depends on no input before `from`: the first tape calculates that from
    /// all inputs, and the second, whose outputs are those of this one, takes the results after its inputs.
    pub fn hoisted(&self, from: usize) -> (Self, Self) {
        let ahead = self.ahead(from);
        let mut ops: Vec<Op> = self.ops.clone();
        let mut inputs = self.inputs.clone();
        for (place, &slot) in ahead.iter().enumerate() {
            ops[slot as usize] = Op::Input((self.inputs.len() + place) as u32);
            inputs.push(format!("hoisted {place}"));
        }
        let front = needed(self.inputs.clone(), &self.ops, &ahead);
        (front, needed(inputs, &ops, &self.outputs))
    }

    /// The operations that are worth doing ahead.
    fn ahead(&self, from: usize) -> Vec<Slot> {
        let mut later = vec![false; self.ops.len()];
        for (index, op) in self.ops.iter().enumerate() {
            later[index] = match *op {
                Op::Input(input) => (input as usize) < from,
                _ => op.operands().into_iter().flatten().any(|slot| later[slot as usize]),
            };
        }
        let dear = |op: &Op| matches!(op, Op::Call1(..) | Op::Call2(..) | Op::Power(..) | Op::Divide(..));
        let kept = self.ops.iter().enumerate().filter(|(index, op)| !later[*index] && dear(op));
        kept.map(|(index, _)| index as Slot).collect()
    }
}

/// The tape of some outputs, without operations that none of them needs.
pub(super) fn needed(inputs: Vec<String>, ops: &[Op], outputs: &[Slot]) -> Tape {
    let mut wanted = vec![false; ops.len()];
    outputs.iter().for_each(|&slot| wanted[slot as usize] = true);
    for (index, op) in ops.iter().enumerate().rev() {
        if wanted[index] {
            op.operands().into_iter().flatten().for_each(|slot| wanted[slot as usize] = true);
        }
    }
    let mut place = vec![0; ops.len()];
    let mut kept = Vec::new();
    for (index, op) in ops.iter().enumerate().filter(|(index, _)| wanted[*index]) {
        place[index] = kept.len() as Slot;
        kept.push(op.moved(&|slot| place[slot as usize]));
    }
    Tape { inputs, ops: kept, outputs: outputs.iter().map(|&slot| place[slot as usize]).collect() }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::TapeBuilder;
    use sistership_model::formula::parse;

    #[test]
    fn what_is_done_ahead_changes_nothing() {
        let mut builder = TapeBuilder::new(&["u", "delta", "n"], &|_| None);
        let texts = ["u*sin(delta)/(2 + cos(u)) + n/delta", "sin(delta)*n", "u*cos(sin(delta)) + abs(n)"];
        texts.iter().for_each(|text| assert!(builder.output(&parse(text).unwrap()).is_ok()));
        let tape = builder.finish();
        let (front, back) = tape.hoisted(1);
        let point = [0.7, -0.3, 1.9];
        let ahead = front.values(&point);
        assert_eq!(ahead.len(), 4, "sine, cosine of it, quotient and modulus");
        assert_eq!(back.values(&[&point[..], &ahead].concat()), tape.values(&point));
        assert!(back.len() < tape.len() + ahead.len());
    }
}
