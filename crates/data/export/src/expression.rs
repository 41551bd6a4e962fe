//! Operations of the tape as expressions of a language.

use sistership_formula::{Comparison, Function};
use sistership_simulation::tape::{ResultSlot, TapeInstruction, TapeOp};

use crate::coefficients::ExportCoefficient;
use crate::export_plan::{ExportPlan, TapeOperand};
use crate::external_input::ExternalInput;

/// Syntax of a language for the operations of a tape. Operands are names or numbers, never sums.
pub trait TargetLanguage {
    /// Literal of a number, exact to the last bit.
    fn number_literal(&self, value: f64) -> String;

    /// Name of a state, by its index in the state vector.
    fn state_name(&self, place: usize) -> String;

    /// Name of an external input.
    fn input_name(&self, outside: &ExternalInput) -> String;

    /// Name of a coefficient.
    fn coefficient_name(&self, coefficient: &ExportCoefficient) -> String;

    /// Quotient `a / b`, which may be infinite or not a number.
    fn write_quotient(&self, a: &str, b: &str) -> String {
        format!("{a}/{b}")
    }

    /// Power `a^b`.
    fn write_power(&self, a: &str, b: &str) -> String;

    /// Call of a function of one or two arguments.
    fn write_call(&self, function: Function, arguments: &[&str]) -> String;

    /// Conditional expression of four operands: the third if the comparison of the first two holds,
    /// otherwise the fourth.
    fn write_conditional(&self, comparison: &str, operands: [&str; 4]) -> String;

    /// Statement that assigns a sum to a name.
    fn write_assignment(&self, name: &str, terms: &[String]) -> String;

    /// Statements that solve `M a = F` for `a_u, a_v, a_p, a_r`, for masses that change with the
    /// motion; `mass` holds the rows of `M`.
    fn write_solution(&self, mass: &[[String; 4]; 4], forces: &[String; 4]) -> Vec<String>;

    /// Target of an assignment to the rate of a state.
    fn rate_target(&self, place: usize) -> String;
}

/// Symbol of a comparison.
pub fn comparison_symbol(of: Comparison) -> &'static str {
    match of {
        Comparison::Less => "<",
        Comparison::LessOrEqual => "<=",
        Comparison::Greater => ">",
        Comparison::GreaterOrEqual => ">=",
    }
}

/// Name of a function in most languages.
pub fn function_name(of: Function) -> &'static str {
    match of {
        Function::Sin => "sin",
        Function::Cos => "cos",
        Function::Tan => "tan",
        Function::Atan => "atan",
        Function::Atan2 => "atan2",
        Function::Sqrt => "sqrt",
        Function::Abs => "abs",
        Function::Exp => "exp",
        Function::Log => "log",
        Function::Tanh => "tanh",
        Function::Min => "min",
        Function::Max => "max",
        Function::Sign => "sign",
    }
}

/// Result of an instruction as an operand: a name, or a number.
pub fn operand_text(plan: &ExportPlan, language: &dyn TargetLanguage, slot: ResultSlot) -> String {
    match plan.listed_operations().tape.instructions()[slot as usize] {
        TapeInstruction::Op(TapeOp::Constant(value)) => language.number_literal(value),
        TapeInstruction::Op(TapeOp::Input(input)) => match plan.operands[input as usize] {
            TapeOperand::State(place) => language.state_name(place),
            TapeOperand::Outside(place) => language.input_name(&plan.outside[place]),
            TapeOperand::Coefficient(place) => language.coefficient_name(&plan.coefficients[place]),
        },
        _ => format!("t{slot}"),
    }
}

/// Terms of the sum that an instruction calculates; `None` if its result is an operand by itself.
pub fn instruction_terms(
    plan: &ExportPlan,
    language: &dyn TargetLanguage,
    slot: ResultSlot,
) -> Option<Vec<String>> {
    let listed = plan.listed_operations();
    let at = |slot: ResultSlot| operand_text(plan, language, slot);
    match listed.tape.instructions()[slot as usize] {
        TapeInstruction::Op(TapeOp::Constant(_) | TapeOp::Input(_)) => None,
        TapeInstruction::Op(op) => Some(vec![operation_text(language, op, &at)]),
        // A fused sum of products: first + a1 b1 + a2 b2 + ...
        TapeInstruction::Products { first, from, to } => {
            let pairs = &listed.tape.product_terms()[from as usize..to as usize];
            let products = pairs.iter().map(|&[a, b]| format!("{}*{}", at(a), at(b)));
            Some(std::iter::once(at(first)).chain(products).collect())
        }
    }
}

fn operation_text(
    language: &dyn TargetLanguage,
    op: TapeOp,
    at: &dyn Fn(ResultSlot) -> String,
) -> String {
    match op {
        // Never reached from the list of terms: these results are operands.
        TapeOp::Constant(_) | TapeOp::Input(_) => String::new(),
        TapeOp::Negate(a) => format!("-{}", at(a)),
        TapeOp::Add(a, b) => format!("{} + {}", at(a), at(b)),
        TapeOp::Subtract(a, b) => format!("{} - {}", at(a), at(b)),
        TapeOp::Multiply(a, b) => format!("{}*{}", at(a), at(b)),
        TapeOp::Divide(a, b) => language.write_quotient(&at(a), &at(b)),
        TapeOp::Power(a, b) => language.write_power(&at(a), &at(b)),
        TapeOp::Call1(function, a) => language.write_call(function, &[&at(a)]),
        TapeOp::Call2(function, a, b) => language.write_call(function, &[&at(a), &at(b)]),
        TapeOp::Select(how, a, b, c, d) => {
            language.write_conditional(comparison_symbol(how), [&at(a), &at(b), &at(c), &at(d)])
        }
    }
}
