//! Dimension of a formula.

use crate::error::FormulaError;
use crate::syntax::{Expr, Function};
use crate::units::Dimension;

/// Returns the dimension of `expr`, where `lookup` returns that of every name.
///
/// # Errors
/// Returns an error that names an unknown name, or the two sides that do not agree.
pub fn dimension_of(
    expr: &Expr,
    lookup: &dyn Fn(&str) -> Option<Dimension>,
) -> Result<Dimension, FormulaError> {
    let of = |e: &Expr| dimension_of(e, lookup);
    match expr {
        Expr::Number(_) => Ok(Dimension::NONE),
        Expr::Name(name) => lookup(name).ok_or_else(|| FormulaError::Name(name.clone())),
        Expr::Negate(a) => of(a),
        Expr::Add(a, b) | Expr::Subtract(a, b) => common_dimension(a, of(a)?, b, of(b)?),
        Expr::Multiply(a, b) => Ok(of(a)? + of(b)?),
        Expr::Divide(a, b) => Ok(of(a)? - of(b)?),
        Expr::Power(a, b) => power_dimension(of(a)?, b, of(b)?),
        Expr::Call(function, arguments) => call_dimension(*function, arguments, lookup),
        Expr::If(_, parts) => {
            // The compared sides must agree, and so must the alternatives.
            common_dimension(&parts[0], of(&parts[0])?, &parts[1], of(&parts[1])?)?;
            common_dimension(&parts[2], of(&parts[2])?, &parts[3], of(&parts[3])?)
        }
    }
}

fn power_dimension(
    base: Dimension,
    exponent: &Expr,
    of_exponent: Dimension,
) -> Result<Dimension, FormulaError> {
    if of_exponent != Dimension::NONE {
        return Err(FormulaError::Exponent(of_exponent));
    }
    // Only a constant exponent gives a base with a dimension a known power.
    match exponent.value(&|_| None) {
        Some(number) => Ok(base.pow(number)),
        None if base == Dimension::NONE => Ok(base),
        None => Err(FormulaError::Power(base)),
    }
}

fn call_dimension(
    function: Function,
    arguments: &[Expr],
    lookup: &dyn Fn(&str) -> Option<Dimension>,
) -> Result<Dimension, FormulaError> {
    let first = dimension_of(&arguments[0], lookup)?;
    match function {
        Function::Abs => Ok(first),
        Function::Sqrt => Ok(first.pow(0.5)),
        Function::Sign => Ok(Dimension::NONE),
        Function::Min | Function::Max | Function::Atan2 => {
            let common = common_dimension(
                &arguments[0],
                first,
                &arguments[1],
                dimension_of(&arguments[1], lookup)?,
            )?;
            Ok(if function == Function::Atan2 { Dimension::NONE } else { common })
        }
        _ if first == Dimension::NONE => Ok(first),
        _ => Err(FormulaError::Argument { function, found: first }),
    }
}

/// Returns the dimension of two sides of a sum or comparison, which must agree; a literal zero
/// agrees with any.
fn common_dimension(
    a: &Expr,
    of_a: Dimension,
    b: &Expr,
    of_b: Dimension,
) -> Result<Dimension, FormulaError> {
    let zero = |e: &Expr| matches!(e, Expr::Number(number) if *number == 0.0);
    if of_a == of_b || zero(b) {
        Ok(of_a)
    } else if zero(a) {
        Ok(of_b)
    } else {
        Err(FormulaError::Sides(of_a, of_b))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::parse;

    fn check(text: &str) -> Result<Dimension, FormulaError> {
        let lookup = |name: &str| match name {
            "u" => Some(Dimension::SPEED),
            "r" => Some(Dimension::RATE),
            "L" => Some(Dimension::LENGTH),
            _ => None,
        };
        dimension_of(&parse(text).expect("readable"), &lookup)
    }

    #[test]
    fn the_prime_system_is_dimensionless() {
        assert_eq!(check("r*L/sqrt(u^2 + (r*L)^2)"), Ok(Dimension::NONE));
        assert_eq!(check("if(u > 0, u, 0)"), Ok(Dimension::SPEED));
    }

    #[test]
    fn wrong_units_are_refused() {
        assert!(check("u + r").unwrap_err().to_string().contains("m s^-1"));
        assert!(check("sin(u)").unwrap_err().to_string().contains("Sin"));
        assert!(check("u + w").unwrap_err().to_string().contains("`w`"));
    }
}
