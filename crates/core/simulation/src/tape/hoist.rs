//! What depends on some inputs alone, taken out of a listing: a sine of a recorded rudder is the
//! same for every model.

use super::listing::Listing;
use super::{Op, Slot};

impl Listing {
    /// Splits off what calls functions or divides and depends on no input before `from`: the first
    /// calculates that from all inputs, and the second, whose outputs are those of this one, takes
    /// the results after its inputs.
    pub fn hoisted(mut self, from: usize) -> (Self, Self) {
        let ahead = self.ahead(from);
        let front = Self { outputs: ahead.clone(), ..self.clone() }.needed();
        let given = self.inputs.len();
        for (place, &slot) in ahead.iter().enumerate() {
            self.ops[slot as usize] = Op::Input((given + place) as u32);
            self.inputs.push(format!("hoisted {place}"));
        }
        (front, self.needed())
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
        let dear =
            |op: &Op| matches!(op, Op::Call1(..) | Op::Call2(..) | Op::Power(..) | Op::Divide(..));
        let kept = self.ops.iter().enumerate().filter(|(index, op)| !later[*index] && dear(op));
        kept.map(|(index, _)| index as Slot).collect()
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
            texts.iter().for_each(|text| assert!(builder.output(&parse(text).unwrap()).is_ok()));
            builder
        };
        let tape = builder().finish();
        let (front, back) = builder().finish_hoisted(1);
        let point = [0.7, -0.3, 1.9];
        let ahead = front.values(&point);
        assert_eq!(ahead.len(), 4, "sine, cosine of it, quotient and modulus");
        assert_eq!(back.values(&[&point[..], &ahead].concat()), tape.values(&point));
        assert!(back.len() < tape.len() + ahead.len());
    }
}
