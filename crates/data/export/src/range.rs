//! Distance of a motion outside the range covered by trials, as an output of every export.

use std::collections::BTreeSet;

use sistership_simulation::tape::{Instruction, Slot, Tape};

use crate::expression::{Language, operand, terms};
use crate::plan::Plan;

/// Name of the output.
pub const NAME: &str = "outside_range";
/// Description of the output in exported files.
pub const MEANING: &str = "how far speeds, yaw rate, rudder and revolutions are outside of what \
    the trials covered, by half their range; 0 inside";

/// Statements of the output, and its result.
pub struct Distance {
    /// Statements in the order of their dependence.
    pub statements: Vec<String>,
    /// Operand that holds the distance.
    pub result: String,
}

/// Distance with all statements that it needs; `None` if the range covered by trials is not known.
pub fn alone(plan: &Plan, language: &dyn Language) -> Option<Distance> {
    let listed = plan.listed();
    let slots = needed(listed.tape, [listed.distance?]);
    Some(stated(plan, language, slots))
}

/// Distance after the statements of the rates, which are not repeated.
pub fn beside(plan: &Plan, language: &dyn Language) -> Option<Distance> {
    let listed = plan.listed();
    let (own, others) = (needed(listed.tape, [listed.distance?]), others(plan));
    // What the rates have calculated already is not repeated.
    Some(stated(plan, language, own.difference(&others).copied().collect()))
}

fn stated(plan: &Plan, language: &dyn Language, slots: BTreeSet<Slot>) -> Distance {
    let statement =
        |slot: Slot| Some(language.assign(&format!("t{slot}"), &terms(plan, language, slot)?));
    let result = plan.listed().distance.map(|slot| operand(plan, language, slot));
    let statements = slots.into_iter().filter_map(statement).collect();
    Distance { statements, result: result.unwrap_or_default() }
}

/// Instructions that the rates of the states need.
pub fn others(plan: &Plan) -> BTreeSet<Slot> {
    let listed = plan.listed();
    let results = listed.forces.iter().chain(listed.mass.iter().flatten());
    let results = results.chain(&listed.accelerations).chain(&listed.kinematics);
    needed(listed.tape, results.copied().flatten())
}

/// Instructions that the given ones need, including themselves.
fn needed(tape: &Tape, some: impl IntoIterator<Item = Slot>) -> BTreeSet<Slot> {
    let (mut all, mut open) = (BTreeSet::new(), some.into_iter().collect::<Vec<_>>());
    // The set is in ascending order of slots, and every instruction reads earlier slots only.
    while let Some(slot) = open.pop() {
        if all.insert(slot) {
            open.extend(operands(tape, slot));
        }
    }
    all
}

fn operands(tape: &Tape, slot: Slot) -> Vec<Slot> {
    match tape.instructions()[slot as usize] {
        Instruction::Op(op) => op.operands().into_iter().flatten().collect(),
        Instruction::Products { first, from, to } => {
            let pairs = tape.terms()[from as usize..to as usize].iter().flatten().copied();
            std::iter::once(first).chain(pairs).collect()
        }
    }
}
