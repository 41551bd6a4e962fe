//! The syntax tree of a formula.

use std::collections::BTreeSet;

use crate::units::Dimension;

/// One expression.
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

/// The functions that a formula may call.
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
    /// The function of that name, with the number of its arguments.
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

    /// Its value; functions of one argument ignore the second.
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

/// How `if` compares.
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
    /// Whether it holds.
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
    /// The expressions directly inside this one.
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

    /// Every name the expression mentions.
    pub fn names(&self) -> BTreeSet<&str> {
        match self {
            Self::Name(name) => BTreeSet::from([name.as_str()]),
            other => other.children().into_iter().flat_map(Expr::names).collect(),
        }
    }

    /// The same expression with some names replaced.
    pub fn renamed(&self, by: &dyn Fn(&str) -> Option<Expr>) -> Expr {
        let of = |e: &Expr| Box::new(e.renamed(by));
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
                Self::Call(*function, arguments.iter().map(|e| e.renamed(by)).collect())
            }
            Self::If(comparison, parts) => {
                Self::If(*comparison, Box::new(parts.each_ref().map(|e| e.renamed(by))))
            }
        }
    }

    /// The operand on the left, leaving a number in its place; none where there are no operands
    /// further down.
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
            _ => Some(std::mem::replace(&mut **left, Self::Number(0.0))),
        }
    }

    /// How many numbers, names and operators it has.
    pub fn size(&self) -> usize {
        1 + self.children().into_iter().map(Expr::size).sum::<usize>()
    }

    /// How many operators are within each other, where `of_name` says how many a name stands for;
    /// none where there are more than `most`, which is told without going further down.
    pub fn depth(
        &self,
        most: usize,
        of_name: &dyn Fn(&str, usize) -> Option<usize>,
    ) -> Option<usize> {
        match self {
            Self::Number(_) => Some(0),
            Self::Name(name) => of_name(name, most).filter(|depth| *depth <= most),
            other => {
                let below = most.checked_sub(1)?;
                let depths = other.children().into_iter().map(|child| child.depth(below, of_name));
                depths
                    .collect::<Option<Vec<usize>>>()
                    .map(|depths| 1 + depths.into_iter().max().unwrap_or(0))
            }
        }
    }

    /// The product of two expressions.
    pub fn times(self, other: Expr) -> Expr {
        Self::Multiply(Box::new(self), Box::new(other))
    }

    /// The value for given names; `None` where a name is unknown.
    pub fn value(&self, lookup: &dyn Fn(&str) -> Option<f64>) -> Option<f64> {
        let of = |e: &Expr| e.value(lookup);
        Some(match self {
            Self::Number(number) => *number,
            Self::Name(name) => lookup(name).or_else(|| Some(builtin(name)?.0))?,
            Self::Negate(a) => -of(a)?,
            Self::Add(a, b) => of(a)? + of(b)?,
            Self::Subtract(a, b) => of(a)? - of(b)?,
            Self::Multiply(a, b) => of(a)? * of(b)?,
            Self::Divide(a, b) => of(a)? / of(b)?,
            Self::Power(a, b) => power(of(a)?, of(b)?),
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

/// A sum of thousands of terms, as the force of an axis, leans to the left: it is taken apart in a
/// loop, not by recursion.
impl Drop for Expr {
    fn drop(&mut self) {
        let mut left = self.take_left();
        while let Some(mut expr) = left {
            left = expr.take_left();
        }
    }
}

/// The names that every formula knows: `pi`, and `g`, the standard acceleration of gravity in m/s2.
pub fn builtin(name: &str) -> Option<(f64, Dimension)> {
    match name {
        "pi" => Some((std::f64::consts::PI, Dimension::NONE)),
        "g" => Some((9.806_65, Dimension::new(0.0, 1.0, -2.0))),
        _ => None,
    }
}

/// `a ^ b`, by repeated multiplication where the exponent is whole, as every other evaluator here
/// does.
fn power(a: f64, b: f64) -> f64 {
    if b.fract() == 0.0 && b.abs() <= 16.0 { a.powi(b as i32) } else { a.powf(b) }
}
