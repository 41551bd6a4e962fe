//! Model as a resource for the library of an FMU; `runtime/model.c` reads it.

use std::fmt::Write;

use sistership_formula::{Comparison, Function};
use sistership_simulation::tape::{Instruction, Op, Slot};

use super::variables::{self, FIRST_OUTSIDE, FIRST_STATE, distance_reference};
use crate::plan::{Operand, Plan};

/// Content of the file: whole numbers, and the bits of doubles.
pub fn text(plan: &Plan) -> String {
    let listed = plan.listed();
    let (tape, moving) = (listed.tape, plan.states().collect::<Vec<_>>());
    let starts = variables::starts(plan);
    // The sizes come first, so that the library can allocate its memory.
    let counts = [starts.len(), tape.len(), tape.terms().len(), moving.len()];
    let mut lines = vec![format!("sistership-fmu-2 {}", plan.sha256), whole(counts), whole(moving)];
    lines.push(bits(&starts));
    lines.extend(tape.instructions().iter().map(|one| instruction(plan, one)));
    lines.push(whole(tape.terms().iter().flatten().copied()));
    lines.push(places(&listed.forces));
    lines.push(places(listed.mass.as_flattened()));
    lines.push(places(&listed.accelerations));
    lines.push(places(&listed.kinematics));
    lines.push(places(&[listed.distance, distance_reference(plan)]));
    // Gear, roll and constant mass matrix.
    let flags = [plan.gear.is_some(), plan.has_roll, listed.mobility.is_some()];
    lines.push(whole(flags.map(usize::from)));
    lines.push(bits(listed.mobility.unwrap_or_default().as_flattened()));
    lines.push(bits(&figures(plan)));
    lines.join("\n") + "\n"
}

/// Figures of the steering gear and of the physical range, in the order of `runtime/model.c`.
fn figures(plan: &Plan) -> [f64; 7] {
    let gear = plan
        .gear
        .map_or([0.0; 3], |gear| [gear.limit_rad(), gear.rate_rad_s(), gear.time_constant_s()]);
    let most = &plan.envelope;
    let most = [most.speed_m_s(), most.yaw_rate_rad_s(), most.roll_rad()];
    [gear[0], gear[1], gear[2], most[0], most[1], most[2], plan.band_rad]
}

fn whole<T: ToString>(numbers: impl IntoIterator<Item = T>) -> String {
    numbers.into_iter().map(|number| number.to_string()).collect::<Vec<_>>().join(" ")
}

/// Bits of doubles in hexadecimal, so that none is rounded.
fn bits(numbers: &[f64]) -> String {
    numbers.iter().fold(String::new(), |mut text, number| {
        let _ = write!(text, "{:x} ", number.to_bits());
        text
    })
}

/// Slots as numbers, -1 for none.
fn places(slots: &[Option<Slot>]) -> String {
    whole(slots.iter().map(|slot| slot.map_or(-1, i64::from)))
}

/// Instruction as a code, four operands and a number.
fn instruction(plan: &Plan, one: &Instruction) -> String {
    let (code, operands, number) = match *one {
        // Codes and order of the operands are those of `runtime/model.c`.
        Instruction::Products { first, from, to } => (25, [first, from, to, 0], 0.0),
        Instruction::Op(Op::Constant(number)) => (0, [0; 4], number),
        Instruction::Op(Op::Input(input)) => (1, [variable(plan, input), 0, 0, 0], 0.0),
        Instruction::Op(op) => (code(op), operands(op), 0.0),
    };
    format!("{code} {} {:x}", whole(operands), f64::to_bits(number))
}

fn operands(op: Op) -> [Slot; 4] {
    match op {
        Op::Constant(_) | Op::Input(_) => [0; 4],
        Op::Negate(a) | Op::Call1(_, a) => [a, 0, 0, 0],
        Op::Add(a, b) | Op::Subtract(a, b) | Op::Multiply(a, b) | Op::Divide(a, b) => [a, b, 0, 0],
        Op::Power(a, b) | Op::Call2(_, a, b) => [a, b, 0, 0],
        Op::Select(_, a, b, c, d) => [a, b, c, d],
    }
}

/// Value reference of an input of the tape.
fn variable(plan: &Plan, input: u32) -> u32 {
    match plan.operands[input as usize] {
        Operand::State(place) => FIRST_STATE + place as u32,
        Operand::Outside(place) => FIRST_OUTSIDE + place as u32,
        Operand::Coefficient(place) => FIRST_OUTSIDE + (plan.outside.len() + place) as u32,
    }
}

/// Operation code, in the order of the enumeration of `runtime/model.c`.
fn code(op: Op) -> u32 {
    match op {
        Op::Constant(_) => 0,
        Op::Input(_) => 1,
        Op::Negate(_) => 2,
        Op::Add(..) => 3,
        Op::Subtract(..) => 4,
        Op::Multiply(..) => 5,
        Op::Divide(..) => 6,
        Op::Power(..) => 7,
        Op::Call1(function, _) | Op::Call2(function, ..) => function_code(function),
        Op::Select(Comparison::Less, ..) => 21,
        Op::Select(Comparison::LessOrEqual, ..) => 22,
        Op::Select(Comparison::Greater, ..) => 23,
        Op::Select(Comparison::GreaterOrEqual, ..) => 24,
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
