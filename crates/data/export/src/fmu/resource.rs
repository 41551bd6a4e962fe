//! Model as a resource for the library of an FMU; `runtime/model.c` reads it.

use std::fmt::Write;

use sistership_formula::{Comparison, Function};
use sistership_simulation::tape::{ResultSlot, TapeInstruction, TapeOp};

use super::variables::{
    self, FIRST_OUTSIDE, FIRST_STATE, distance_reference, first_parameter, gear_references,
};
use crate::export_plan::{ExportPlan, TapeOperand};

/// Content of the file: whole numbers, and the bits of doubles.
pub fn resource_text(plan: &ExportPlan) -> String {
    let listed = plan.listed_operations();
    let (tape, moving) = (listed.tape, plan.moving_states().collect::<Vec<_>>());
    let starts = variables::start_values(plan);
    // The sizes come first, so that the library can allocate its memory.
    let parameters = first_parameter(plan) as usize;
    let counts = [starts.len(), tape.len(), tape.product_terms().len(), moving.len(), parameters];
    let mut lines = vec![
        format!("sistership-fmu-3 {}", plan.sha256),
        join_integers(counts),
        join_integers(moving),
    ];
    lines.push(double_bits(&starts));
    lines.extend(tape.instructions().iter().map(|one| instruction_line(plan, one)));
    lines.push(join_integers(tape.product_terms().iter().flatten().copied()));
    lines.push(slot_numbers(&listed.forces));
    lines.push(slot_numbers(listed.mass.as_flattened()));
    lines.push(slot_numbers(&listed.accelerations));
    lines.push(slot_numbers(&listed.kinematics));
    lines.push(slot_numbers(&[listed.distance, distance_reference(plan)]));
    // Gear, roll and constant mass matrix.
    let flags = [plan.gear.is_some(), plan.has_roll, listed.mobility.is_some()];
    lines.push(join_integers(flags.map(usize::from)));
    lines.push(slot_numbers(&gear_references(plan)));
    lines.push(double_bits(listed.mobility.unwrap_or_default().as_flattened()));
    let most = &plan.envelope;
    lines.push(double_bits(&[most.speed_m_s(), most.yaw_rate_rad_s(), most.roll_rad()]));
    lines.join("\n") + "\n"
}

fn join_integers<T: ToString>(numbers: impl IntoIterator<Item = T>) -> String {
    numbers.into_iter().map(|number| number.to_string()).collect::<Vec<_>>().join(" ")
}

/// Bits of doubles in hexadecimal, so that none is rounded.
fn double_bits(numbers: &[f64]) -> String {
    numbers.iter().fold(String::new(), |mut text, number| {
        let _ = write!(text, "{:x} ", number.to_bits());
        text
    })
}

/// Slots as numbers, -1 for none.
fn slot_numbers(slots: &[Option<ResultSlot>]) -> String {
    join_integers(slots.iter().map(|slot| slot.map_or(-1, i64::from)))
}

/// Instruction as a code, four operands and a number.
fn instruction_line(plan: &ExportPlan, one: &TapeInstruction) -> String {
    let (code, operands, number) = match *one {
        // Codes and order of the operands are those of `runtime/model.c`.
        TapeInstruction::Products { first, from, to } => (25, [first, from, to, 0], 0.0),
        TapeInstruction::Op(TapeOp::Constant(number)) => (0, [0; 4], number),
        TapeInstruction::Op(TapeOp::Input(input)) => {
            (1, [value_reference(plan, input), 0, 0, 0], 0.0)
        }
        TapeInstruction::Op(op) => (operation_code(op), operand_slots(op), 0.0),
    };
    format!("{code} {} {:x}", join_integers(operands), f64::to_bits(number))
}

fn operand_slots(op: TapeOp) -> [ResultSlot; 4] {
    match op {
        TapeOp::Constant(_) | TapeOp::Input(_) => [0; 4],
        TapeOp::Negate(a) | TapeOp::Call1(_, a) => [a, 0, 0, 0],
        TapeOp::Add(a, b)
        | TapeOp::Subtract(a, b)
        | TapeOp::Multiply(a, b)
        | TapeOp::Divide(a, b) => [a, b, 0, 0],
        TapeOp::Power(a, b) | TapeOp::Call2(_, a, b) => [a, b, 0, 0],
        TapeOp::Select(_, a, b, c, d) => [a, b, c, d],
    }
}

/// Value reference of an input of the tape.
fn value_reference(plan: &ExportPlan, input: u32) -> u32 {
    match plan.operands[input as usize] {
        TapeOperand::State(place) => FIRST_STATE + place as u32,
        TapeOperand::Outside(place) => FIRST_OUTSIDE + place as u32,
        TapeOperand::Coefficient(place) => FIRST_OUTSIDE + (plan.outside.len() + place) as u32,
    }
}

/// Operation code, in the order of the enumeration of `runtime/model.c`.
fn operation_code(op: TapeOp) -> u32 {
    match op {
        TapeOp::Constant(_) => 0,
        TapeOp::Input(_) => 1,
        TapeOp::Negate(_) => 2,
        TapeOp::Add(..) => 3,
        TapeOp::Subtract(..) => 4,
        TapeOp::Multiply(..) => 5,
        TapeOp::Divide(..) => 6,
        TapeOp::Power(..) => 7,
        TapeOp::Call1(function, _) | TapeOp::Call2(function, ..) => function_code(function),
        TapeOp::Select(Comparison::Less, ..) => 21,
        TapeOp::Select(Comparison::LessOrEqual, ..) => 22,
        TapeOp::Select(Comparison::Greater, ..) => 23,
        TapeOp::Select(Comparison::GreaterOrEqual, ..) => 24,
    }
}

fn function_code(function: Function) -> u32 {
    match function {
        Function::Sin => 8,
        Function::Cos => 9,
        Function::Tan => 10,
        Function::Atan => 11,
        Function::Atan2 => 12,
        Function::Sqrt => 13,
        Function::Abs => 14,
        Function::Exp => 15,
        Function::Log => 16,
        Function::Tanh => 17,
        Function::Min => 18,
        Function::Max => 19,
        Function::Sign => 20,
    }
}
