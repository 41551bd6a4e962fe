//! Operations of the tape as expressions of a language.

use sistership_formula::{Comparison, Function};
use sistership_simulation::tape::{Instruction, Op, Slot};

use crate::outside::Outside;
use crate::plan::{Coefficient, Operand, Plan};

/// Syntax of a language for the operations of a tape. Operands are names or numbers, never sums.
pub trait Language {
    /// Literal of a number, exact to the last bit.
    fn number(&self, value: f64) -> String;

    /// Name of a state, by its index in the state vector.
    fn state(&self, place: usize) -> String;

    /// Name of an external input.
    fn outside(&self, outside: &Outside) -> String;

    /// Name of a coefficient.
    fn coefficient(&self, coefficient: &Coefficient) -> String;

    /// Quotient `a / b`, which may be infinite or not a number.
    fn quotient(&self, a: &str, b: &str) -> String {
        format!("{a}/{b}")
    }

    /// Power `a^b`.
    fn power(&self, a: &str, b: &str) -> String;

    /// Call of a function of one or two arguments.
    fn call(&self, function: Function, arguments: &[&str]) -> String;

    /// Conditional expression of four operands: the third if the comparison of the first two holds,
    /// otherwise the fourth.
    fn choice(&self, comparison: &str, operands: [&str; 4]) -> String;

    /// Statement that assigns a sum to a name.
    fn assign(&self, name: &str, terms: &[String]) -> String;

    /// Statements that solve `M a = F` for `a_u, a_v, a_p, a_r`, for masses that change with the
    /// motion; `mass` holds the rows of `M`.
    fn solve(&self, mass: &[[String; 4]; 4], forces: &[String; 4]) -> Vec<String>;

    /// Target of an assignment to the rate of a state.
    fn rate(&self, place: usize) -> String;
}

/// Symbol of a comparison.
pub fn comparison(of: Comparison) -> &'static str {
    match of {
        Comparison::Less => "<",
        Comparison::LessOrEqual => "<=",
        Comparison::Greater => ">",
        Comparison::GreaterOrEqual => ">=",
    }
}

/// Name of a function in most languages.
pub fn function(of: Function) -> &'static str {
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
pub fn operand(plan: &Plan, language: &dyn Language, slot: Slot) -> String {
    match plan.listed().tape.instructions()[slot as usize] {
        Instruction::Op(Op::Constant(value)) => language.number(value),
        Instruction::Op(Op::Input(input)) => match plan.operands[input as usize] {
            Operand::State(place) => language.state(place),
            Operand::Outside(place) => language.outside(&plan.outside[place]),
            Operand::Coefficient(place) => language.coefficient(&plan.coefficients[place]),
        },
        _ => format!("t{slot}"),
    }
}

/// Terms of the sum that an instruction calculates; `None` if its result is an operand by itself.
pub fn terms(plan: &Plan, language: &dyn Language, slot: Slot) -> Option<Vec<String>> {
    let listed = plan.listed();
    let at = |slot: Slot| operand(plan, language, slot);
    match listed.tape.instructions()[slot as usize] {
        Instruction::Op(Op::Constant(_) | Op::Input(_)) => None,
        Instruction::Op(op) => Some(vec![expression(language, op, &at)]),
        // A fused sum of products: first + a1 b1 + a2 b2 + ...
        Instruction::Products { first, from, to } => {
            let pairs = &listed.tape.terms()[from as usize..to as usize];
            let products = pairs.iter().map(|&[a, b]| format!("{}*{}", at(a), at(b)));
            Some(std::iter::once(at(first)).chain(products).collect())
        }
    }
}

fn expression(language: &dyn Language, op: Op, at: &dyn Fn(Slot) -> String) -> String {
    match op {
        // Never reached from the list of terms: these results are operands.
        Op::Constant(_) | Op::Input(_) => String::new(),
        Op::Negate(a) => format!("-{}", at(a)),
        Op::Add(a, b) => format!("{} + {}", at(a), at(b)),
        Op::Subtract(a, b) => format!("{} - {}", at(a), at(b)),
        Op::Multiply(a, b) => format!("{}*{}", at(a), at(b)),
        Op::Divide(a, b) => language.quotient(&at(a), &at(b)),
        Op::Power(a, b) => language.power(&at(a), &at(b)),
        Op::Call1(function, a) => language.call(function, &[&at(a)]),
        Op::Call2(function, a, b) => language.call(function, &[&at(a), &at(b)]),
        Op::Select(how, a, b, c, d) => {
            language.choice(comparison(how), [&at(a), &at(b), &at(c), &at(d)])
        }
    }
}
