//! Syntax tree of a formula.

use std::collections::BTreeSet;

use crate::units::Dimension;

/// Expression.
#[derive(Debug, Clone, PartialEq)]
pub enum Expr {
    /// A number.
    Number(f64),
    /// A state, input, particular, parameter, coefficient or intermediate value.
    Name(String),
    /// `-a`
    Negate(Box<Expr>),
    /// `a + b`
    Add(Box<Expr>, Box<Expr>),
    /// `a - b`
    Subtract(Box<Expr>, Box<Expr>),
    /// `a * b`
    Multiply(Box<Expr>, Box<Expr>),
    /// `a / b`
    Divide(Box<Expr>, Box<Expr>),
    /// `a ^ b`
    Power(Box<Expr>, Box<Expr>),
    /// `f(a, ...)`
    Call(Function, Vec<Expr>),
    /// `if(a < b, c, d)`
    If(Comparison, Box<[Expr; 4]>),
}

/// Functions that a formula may call.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Function {
    /// Sine of an angle in radians.
    Sin,
    /// Cosine of an angle in radians.
    Cos,
    /// Tangent of an angle in radians.
    Tan,
    /// Arc tangent.
    Atan,
    /// Arc tangent of `y / x` in the right quadrant.
    Atan2,
    /// Square root.
    Sqrt,
    /// Absolute value.
    Abs,
    /// Exponential.
    Exp,
    /// Natural logarithm.
    Log,
    /// Hyperbolic tangent.
    Tanh,
    /// The smaller of two.
    Min,
    /// The larger of two.
    Max,
    /// -1, 0 or 1.
    Sign,
}

impl Function {
    /// Returns the function with a name, and its number of arguments.
    pub fn by_name(name: &str) -> Option<(Self, usize)> {
        Some(match name {
            "sin" => (Self::Sin, 1),
            "cos" => (Self::Cos, 1),
            "tan" => (Self::Tan, 1),
            "atan" => (Self::Atan, 1),
            "atan2" => (Self::Atan2, 2),
            "sqrt" => (Self::Sqrt, 1),
            "abs" => (Self::Abs, 1),
            "exp" => (Self::Exp, 1),
            "log" => (Self::Log, 1),
            "tanh" => (Self::Tanh, 1),
            "min" => (Self::Min, 2),
            "max" => (Self::Max, 2),
            "sign" => (Self::Sign, 1),
            _ => return None,
        })
    }

    /// Value of the function; functions of one argument ignore the second.
    pub fn apply(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Sin => a.sin(),
            Self::Cos => a.cos(),
            Self::Tan => a.tan(),
            Self::Atan => a.atan(),
            Self::Atan2 => a.atan2(b),
            Self::Sqrt => a.sqrt(),
            Self::Abs => a.abs(),
            Self::Exp => a.exp(),
            Self::Log => a.ln(),
            Self::Tanh => a.tanh(),
            Self::Min => a.min(b),
            Self::Max => a.max(b),
            Self::Sign if a == 0.0 => 0.0,
            Self::Sign => a.signum(),
        }
    }
}

/// Comparison operator of `if`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Comparison {
    /// `<`
    Less,
    /// `<=`
    LessOrEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterOrEqual,
}

impl Comparison {
    /// Returns true if the comparison holds.
    pub fn holds(self, a: f64, b: f64) -> bool {
        match self {
            Self::Less => a < b,
            Self::LessOrEqual => a <= b,
            Self::Greater => a > b,
            Self::GreaterOrEqual => a >= b,
        }
    }
}

impl Expr {
    /// Operands of the expression.
    pub fn children(&self) -> Vec<&Expr> {
        match self {
            Self::Number(_) | Self::Name(_) => Vec::new(),
            Self::Negate(a) => vec![a],
            Self::Add(a, b)
            | Self::Subtract(a, b)
            | Self::Multiply(a, b)
            | Self::Divide(a, b)
            | Self::Power(a, b) => {
                vec![a, b]
            }
            Self::Call(_, arguments) => arguments.iter().collect(),
            Self::If(_, parts) => parts.iter().collect(),
        }
    }

    /// Returns every name in the expression.
    pub fn mentioned_names(&self) -> BTreeSet<&str> {
        match self {
            Self::Name(name) => BTreeSet::from([name.as_str()]),
            other => other.children().into_iter().flat_map(Expr::mentioned_names).collect(),
        }
    }

    /// Returns the expression with some names replaced by expressions.
    pub fn replace_names(&self, by: &dyn Fn(&str) -> Option<Expr>) -> Expr {
        let of = |e: &Expr| Box::new(e.replace_names(by));
        match self {
            Self::Number(number) => Self::Number(*number),
            Self::Name(name) => by(name).unwrap_or_else(|| self.clone()),
            Self::Negate(a) => Self::Negate(of(a)),
            Self::Add(a, b) => Self::Add(of(a), of(b)),
            Self::Subtract(a, b) => Self::Subtract(of(a), of(b)),
            Self::Multiply(a, b) => Self::Multiply(of(a), of(b)),
            Self::Divide(a, b) => Self::Divide(of(a), of(b)),
            Self::Power(a, b) => Self::Power(of(a), of(b)),
            Self::Call(function, arguments) => {
                Self::Call(*function, arguments.iter().map(|e| e.replace_names(by)).collect())
            }
            Self::If(comparison, parts) => {
                Self::If(*comparison, Box::new(parts.each_ref().map(|e| e.replace_names(by))))
            }
        }
    }

    /// Takes the left operand and leaves a number in its place; `None` if that operand has no
    /// operands itself.
    fn take_left(&mut self) -> Option<Expr> {
        let left = match self {
            Self::Number(_) | Self::Name(_) | Self::Call(..) | Self::If(..) => return None,
            Self::Negate(a) => a,
            Self::Add(a, _)
            | Self::Subtract(a, _)
            | Self::Multiply(a, _)
            | Self::Divide(a, _)
            | Self::Power(a, _) => a,
        };
        match **left {
            Self::Number(_) | Self::Name(_) => None,
            // Names and numbers have no operands, so that their drop does not recurse.
            _ => Some(std::mem::replace(&mut **left, Self::Number(0.0))),
        }
    }

    /// Number of numbers, names and operators.
    pub fn node_count(&self) -> usize {
        1 + self.children().into_iter().map(Expr::node_count).sum::<usize>()
    }

    /// Returns the depth of operators, where `of_name` returns that of a name; `None` if it exceeds
    /// `most`, in which case the search stops at that depth.
    pub fn depth_within(
        &self,
        most: usize,
        of_name: &dyn Fn(&str, usize) -> Option<usize>,
    ) -> Option<usize> {
        match self {
            Self::Number(_) => Some(0),
            Self::Name(name) => of_name(name, most).filter(|depth| *depth <= most),
            other => {
                let below = most.checked_sub(1)?;
                let depths =
                    other.children().into_iter().map(|child| child.depth_within(below, of_name));
                depths
                    .collect::<Option<Vec<usize>>>()
                    .map(|depths| 1 + depths.into_iter().max().unwrap_or(0))
            }
        }
    }

    /// Product of two expressions.
    pub fn times(self, other: Expr) -> Expr {
        Self::Multiply(Box::new(self), Box::new(other))
    }

    /// Value for given names; `None` if a name is unknown.
    pub fn value(&self, lookup: &dyn Fn(&str) -> Option<f64>) -> Option<f64> {
        let of = |e: &Expr| e.value(lookup);
        Some(match self {
            Self::Number(number) => *number,
            // A lookup has precedence over the built-in constants.
            Self::Name(name) => lookup(name).or_else(|| Some(builtin_constant(name)?.0))?,
            Self::Negate(a) => -of(a)?,
            Self::Add(a, b) => of(a)? + of(b)?,
            Self::Subtract(a, b) => of(a)? - of(b)?,
            Self::Multiply(a, b) => of(a)? * of(b)?,
            Self::Divide(a, b) => of(a)? / of(b)?,
            Self::Power(a, b) => evaluate_power(of(a)?, of(b)?),
            Self::Call(function, arguments) => {
                let second = arguments.get(1).map_or(Some(0.0), of)?;
                function.apply(of(&arguments[0])?, second)
            }
            Self::If(comparison, parts) => {
                if comparison.holds(of(&parts[0])?, of(&parts[1])?) {
                    of(&parts[2])?
                } else {
                    of(&parts[3])?
                }
            }
        })
    }
}

/// The sum of the thousands of terms of an axis is nested to the left: it is dropped in a loop,
/// since recursion could exhaust the stack.
impl Drop for Expr {
    fn drop(&mut self) {
        let mut left = self.take_left();
        while let Some(mut expr) = left {
            left = expr.take_left();
        }
    }
}

/// Returns a built-in constant with its dimension: `pi`, and `g`, the standard acceleration of
/// gravity in m/s2.
pub fn builtin_constant(name: &str) -> Option<(f64, Dimension)> {
    match name {
        "pi" => Some((std::f64::consts::PI, Dimension::NONE)),
        "g" => Some((9.806_65, Dimension::new(0.0, 1.0, -2.0))),
        _ => None,
    }
}

/// Evaluates `a ^ b`, by repeated multiplication for a whole exponent, as every other evaluator of
/// formulas does.
fn evaluate_power(a: f64, b: f64) -> f64 {
    if b.fract() == 0.0 && b.abs() <= 16.0 { a.powi(b as i32) } else { a.powf(b) }
}
