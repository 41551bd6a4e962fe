//! Operations one by one, before they are made a tape.

use super::{Op, Slot};

/// Operations with named inputs and numbered outputs; each reads what earlier ones gave.
#[derive(Debug, Clone)]
pub(super) struct Listing {
    pub inputs: Vec<String>,
    pub ops: Vec<Op>,
    pub outputs: Vec<Slot>,
}

impl Listing {
    /// Without operations that no output needs.
    pub fn needed(&self) -> Self {
        let Self { inputs, ops, outputs } = self;
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
        let outputs = outputs.iter().map(|&slot| place[slot as usize]).collect();
        Self { inputs: inputs.clone(), ops: kept, outputs }
    }
}
