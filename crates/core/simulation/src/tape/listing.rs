//! List of operations before it is made a tape.

use super::{ResultSlot, TapeOp};

/// Operations with named inputs and numbered outputs; each reads results of earlier ones.
#[derive(Debug, Clone)]
pub(super) struct OperationList {
    pub inputs: Vec<String>,
    pub ops: Vec<TapeOp>,
    pub outputs: Vec<ResultSlot>,
}

impl OperationList {
    /// Returns the listing without operations that no output needs.
    pub fn without_unused(&self) -> Self {
        let Self { inputs, ops, outputs } = self;
        let mut wanted = vec![false; ops.len()];
        outputs.iter().for_each(|&slot| wanted[slot as usize] = true);
        // Backwards, because an operation is needed if a later one that is needed reads it.
        for (index, op) in ops.iter().enumerate().rev() {
            if wanted[index] {
                op.operands().into_iter().flatten().for_each(|slot| wanted[slot as usize] = true);
            }
        }
        // New index of each operation that is kept.
        let mut place = vec![0; ops.len()];
        let mut kept = Vec::new();
        for (index, op) in ops.iter().enumerate().filter(|(index, _)| wanted[*index]) {
            place[index] = kept.len() as ResultSlot;
            kept.push(op.remap_operands(&|slot| place[slot as usize]));
        }
        let outputs = outputs.iter().map(|&slot| place[slot as usize]).collect();
        Self { inputs: inputs.clone(), ops: kept, outputs }
    }
}
