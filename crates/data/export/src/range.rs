//! Distance of a motion outside the range covered by trials, as an output of every export.

use std::collections::BTreeSet;

use sistership_simulation::tape::{ResultSlot, Tape, TapeInstruction};

use crate::export_plan::ExportPlan;
use crate::expression::{TargetLanguage, instruction_terms, operand_text};

/// Name of the output.
pub const NAME: &str = "outside_range";
/// Description of the output in exported files.
pub const MEANING: &str = "distance of speeds, yaw rate, rudder and revolutions outside the range \
                           covered by the trials, divided by half that range; 0 inside";

/// Statements of the output, and its result.
pub struct RangeDistance {
    /// Statements in the order of their dependence.
    pub statements: Vec<String>,
    /// Operand that holds the distance.
    pub result: String,
}

/// Distance with all statements that it needs; `None` if the range covered by trials is not known.
pub fn standalone_distance(
    plan: &ExportPlan,
    language: &dyn TargetLanguage,
) -> Option<RangeDistance> {
    let listed = plan.listed_operations();
    let slots = required_slots(listed.tape, [listed.distance?]);
    Some(distance_statements(plan, language, slots))
}

/// Distance after the statements of the rates, which are not repeated.
pub fn distance_after_rates(
    plan: &ExportPlan,
    language: &dyn TargetLanguage,
) -> Option<RangeDistance> {
    let listed = plan.listed_operations();
    let (own, others) = (required_slots(listed.tape, [listed.distance?]), rate_slots(plan));
    // What the rates have calculated already is not repeated.
    Some(distance_statements(plan, language, own.difference(&others).copied().collect()))
}

fn distance_statements(
    plan: &ExportPlan,
    language: &dyn TargetLanguage,
    slots: BTreeSet<ResultSlot>,
) -> RangeDistance {
    let statement = |slot: ResultSlot| {
        Some(
            language
                .write_assignment(&format!("t{slot}"), &instruction_terms(plan, language, slot)?),
        )
    };
    let result = plan.listed_operations().distance.map(|slot| operand_text(plan, language, slot));
    let statements = slots.into_iter().filter_map(statement).collect();
    RangeDistance { statements, result: result.unwrap_or_default() }
}

/// Instructions that the rates of the states need.
pub fn rate_slots(plan: &ExportPlan) -> BTreeSet<ResultSlot> {
    let listed = plan.listed_operations();
    let results = listed.forces.iter().chain(listed.mass.iter().flatten());
    let results = results.chain(&listed.accelerations).chain(&listed.kinematics);
    required_slots(listed.tape, results.copied().flatten())
}

/// Instructions that the given ones need, including themselves.
fn required_slots(tape: &Tape, some: impl IntoIterator<Item = ResultSlot>) -> BTreeSet<ResultSlot> {
    let (mut all, mut open) = (BTreeSet::new(), some.into_iter().collect::<Vec<_>>());
    // The set is in ascending order of slots, and every instruction reads earlier slots only.
    while let Some(slot) = open.pop() {
        if all.insert(slot) {
            open.extend(operand_slots(tape, slot));
        }
    }
    all
}

fn operand_slots(tape: &Tape, slot: ResultSlot) -> Vec<ResultSlot> {
    match tape.instructions()[slot as usize] {
        TapeInstruction::Op(op) => op.operands().into_iter().flatten().collect(),
        TapeInstruction::Products { first, from, to } => {
            let pairs = tape.product_terms()[from as usize..to as usize].iter().flatten().copied();
            std::iter::once(first).chain(pairs).collect()
        }
    }
}
