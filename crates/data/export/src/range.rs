//! How far a motion is outside of what a model's trials covered, as an output of every export.

use std::collections::BTreeSet;

use sistership_simulation::tape::{Instruction, Slot, Tape};

use crate::expression::{Language, operand, terms};
use crate::plan::Plan;

/// The output's name.
pub const NAME: &str = "outside_range";
/// What it is.
pub const MEANING: &str = "how far speeds, yaw rate, rudder and revolutions are outside of what \
    the trials covered, by half their range; 0 inside";

/// The output: statements, and what it is by them.
pub struct Distance {
    /// In the order in which each needs only earlier ones.
    pub statements: Vec<String>,
    /// The operand that it is.
    pub result: String,
}

/// The distance without anything else of the model; none where nobody knows what trials covered.
pub fn alone(plan: &Plan, language: &dyn Language) -> Option<Distance> {
    let listed = plan.listed();
    let slots = needed(listed.tape, [listed.distance?]);
    Some(stated(plan, language, slots))
}

/// The distance after the statements of the rates.
pub fn beside(plan: &Plan, language: &dyn Language) -> Option<Distance> {
    let listed = plan.listed();
    let (own, others) = (needed(listed.tape, [listed.distance?]), others(plan));
    Some(stated(plan, language, own.difference(&others).copied().collect()))
}

fn stated(plan: &Plan, language: &dyn Language, slots: BTreeSet<Slot>) -> Distance {
    let statement =
        |slot: Slot| Some(language.assign(&format!("t{slot}"), &terms(plan, language, slot)?));
    let result = plan.listed().distance.map(|slot| operand(plan, language, slot));
    let statements = slots.into_iter().filter_map(statement).collect();
    Distance { statements, result: result.unwrap_or_default() }
}

/// The instructions that the rates of the states need.
pub fn others(plan: &Plan) -> BTreeSet<Slot> {
    let listed = plan.listed();
    let results = listed.forces.iter().chain(listed.mass.iter().flatten());
    let results = results.chain(&listed.accelerations).chain(&listed.kinematics);
    needed(listed.tape, results.copied().flatten())
}

/// The instructions that some need, themselves among them.
fn needed(tape: &Tape, some: impl IntoIterator<Item = Slot>) -> BTreeSet<Slot> {
    let (mut all, mut open) = (BTreeSet::new(), some.into_iter().collect::<Vec<_>>());
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
