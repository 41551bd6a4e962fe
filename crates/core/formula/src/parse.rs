//! Parser from text to the syntax tree, with winnow's expression combinator.

use winnow::ascii::{float, multispace0};
use winnow::combinator::{
    Infix, Prefix, alt, cut_err, delimited, dispatch, empty, expression, fail, peek, preceded,
    separated, terminated,
};
use winnow::error::{ContextError, ErrMode, StrContext, StrContextValue};
use winnow::prelude::*;
use winnow::token::{any, one_of, take_while};

use crate::error::FormulaError;
use crate::syntax::{Comparison, Expr, Function};

type ParseResult<T> = winnow::Result<T, ErrMode<ContextError>>;

/// Parses one formula.
///
/// # Errors
/// Returns an error with the position of the first fault and the expected input; or an error for a
/// formula that exceeds [`crate::MAX_LENGTH`], [`crate::MAX_NESTING`] or [`crate::MAX_OPERATORS`].
pub fn parse(text: &str) -> std::result::Result<Expr, FormulaError> {
    crate::limits::check_limits(text)?;
    let parsed = delimited(multispace0, parse_sum, multispace0).parse(text);
    parsed.map_err(|error| {
        // The error has a byte offset; the message shows the next characters.
        let rest: String =
            text.chars().skip(text[..error.offset()].chars().count()).take(12).collect();
        let place = if rest.is_empty() { "its end".into() } else { format!("`{rest}`") };
        let expected = error.inner().to_string().replace('\n', ", ");
        let expected = if expected.is_empty() { String::new() } else { format!(": {expected}") };
        FormulaError::Syntax { formula: text.to_owned(), place, expected }
    })
}

/// Parses a comparison such as `u < 0` to a formula that is 1 if it holds and 0 otherwise. Its
/// derivative is zero.
///
/// # Errors
/// Returns the errors of [`parse`], and an error for a text without a comparison.
pub fn parse_condition(text: &str) -> std::result::Result<Expr, FormulaError> {
    match text.find(['<', '>']) {
        Some(_) => {
            crate::limits::check_limits(text)?;
            parse(&format!("if({text}, 1, 0)"))
                .map_err(|_| FormulaError::Condition(text.to_owned()))
        }
        None => Err(FormulaError::Comparison(text.to_owned())),
    }
}

fn boxed(a: Expr, b: Expr, make: fn(Box<Expr>, Box<Expr>) -> Expr) -> Expr {
    make(Box::new(a), Box::new(b))
}

/// Parses an expression. Binding powers: sums 1, products 3, unary minus 5, powers 7 (right
/// associative), so that `-u^2` is `-(u^2)`.
fn parse_sum(input: &mut &str) -> ParseResult<Expr> {
    expression(delimited(multispace0, parse_operand, multispace0))
        .prefix(preceded(
            multispace0,
            dispatch! { any;
                '-' => empty.value(Prefix(5, |_: &mut &str, a| Ok(Expr::Negate(Box::new(a))))),
                '+' => empty.value(Prefix(5, |_: &mut &str, a| Ok(a))),
                _ => fail,
            },
        ))
        .infix(dispatch! { any;
            '+' => empty.value(Infix::Left(1, |_: &mut &str, a, b| Ok(boxed(a, b, Expr::Add)))),
            '-' => empty.value(Infix::Left(1, |_: &mut &str, a, b| Ok(boxed(a, b, Expr::Subtract)))),
            '*' => empty.value(Infix::Left(3, |_: &mut &str, a, b| Ok(boxed(a, b, Expr::Multiply)))),
            '/' => empty.value(Infix::Left(3, |_: &mut &str, a, b| Ok(boxed(a, b, Expr::Divide)))),
            '^' => empty.value(Infix::Right(7, |_: &mut &str, a, b| Ok(boxed(a, b, Expr::Power)))),
            _ => fail,
        })
        .parse_next(input)
}

fn parse_operand(input: &mut &str) -> ParseResult<Expr> {
    alt((
        parse_number,
        delimited('(', parse_sum, cut_err(')').context(expected_context("a closing parenthesis"))),
        parse_name_or_call,
    ))
    .context(expected_context("a number, a name or a parenthesis"))
    .parse_next(input)
}

fn expected_context(what: &'static str) -> StrContext {
    StrContext::Expected(StrContextValue::Description(what))
}

fn parse_number(input: &mut &str) -> ParseResult<Expr> {
    // `float` would also accept a sign, `inf` and `nan`: here a sign is an operator, and the others
    // are names.
    preceded(peek(one_of(('0'..='9', '.'))), float).map(Expr::Number).parse_next(input)
}

fn parse_identifier<'a>(input: &mut &'a str) -> ParseResult<&'a str> {
    (one_of(('a'..='z', 'A'..='Z', '_')), take_while(0.., ('a'..='z', 'A'..='Z', '0'..='9', '_')))
        .take()
        .parse_next(input)
}

fn parse_name_or_call(input: &mut &str) -> ParseResult<Expr> {
    let name = parse_identifier.parse_next(input)?;
    // A name is a call only if a parenthesis follows.
    if peek((multispace0::<_, ErrMode<ContextError>>, '(')).parse_next(input).is_err() {
        return Ok(Expr::Name(name.to_owned()));
    }
    if name == "if" {
        return cut_err(parse_alternatives).parse_next(input);
    }
    // After an opening parenthesis no other alternative can match: `cut_err` keeps this error.
    let Some((function, count)) = Function::by_name(name) else {
        return cut_err(fail.context(expected_context("a known function"))).parse_next(input);
    };
    let arguments: Vec<Expr> =
        cut_err(delimited((multispace0, '('), separated(1.., parse_sum, ','), ')'))
            .parse_next(input)?;
    if arguments.len() != count {
        return cut_err(fail.context(expected_context("as many arguments as the function takes")))
            .parse_next(input);
    }
    Ok(Expr::Call(function, arguments))
}

/// Parses the arguments of `if`: `(a < b, c, d)`.
fn parse_alternatives(input: &mut &str) -> ParseResult<Expr> {
    let compare = alt((
        "<=".value(Comparison::LessOrEqual),
        ">=".value(Comparison::GreaterOrEqual),
        "<".value(Comparison::Less),
        ">".value(Comparison::Greater),
    ))
    .context(expected_context("a comparison"));
    let (left, comparison, right) =
        preceded((multispace0, '('), (parse_sum, compare, parse_sum)).parse_next(input)?;
    let (then, otherwise) = (preceded(',', parse_sum), preceded(',', terminated(parse_sum, ')')))
        .context(expected_context("two alternatives"))
        .parse_next(input)?;
    Ok(Expr::If(comparison, Box::new([left, right, then, otherwise])))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn value(text: &str) -> f64 {
        let lookup = |name: &str| (name == "u").then_some(3.0);
        parse(text).unwrap_or_else(|e| panic!("{e}")).value(&lookup).unwrap()
    }

    #[test]
    fn precedence_is_that_of_mathematics() {
        assert_eq!(value("1 + 2*u^2"), 19.0);
        assert_eq!(value("-u^2"), -9.0);
        assert_eq!(value("2^3^2"), 512.0);
        assert_eq!(value("8/4/2"), 1.0);
        assert_eq!(value("2 - -u"), 5.0);
        assert_eq!(value("0.605e0/304.8*304.8"), 0.605);
    }

    #[test]
    fn functions_and_conditions() {
        assert_eq!(value("if(u >= 3, max(1, u), 0)"), 3.0);
        assert_eq!(value("abs(-u) + sign(-u)"), 2.0);
        assert!((value("atan2(1, 0)") - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    }

    #[test]
    fn conditions_are_one_or_zero() {
        let holds = |text: &str| parse_condition(text).unwrap().value(&|_| Some(3.0)).unwrap();
        assert_eq!((holds("u >= 3"), holds("max(u, 1) - 5 > 0")), (1.0, 0.0));
        assert!(parse_condition("u + 1").unwrap_err().to_string().contains("comparison"));
        assert!(parse_condition("u <").unwrap_err().to_string().contains("`u <`"));
        assert!(parse_condition("u < 0, 1").is_err());
    }

    #[test]
    fn errors_name_the_place() {
        assert!(parse("u + ").unwrap_err().to_string().contains("its end"));
        assert!(parse("u + (v").unwrap_err().to_string().contains("closing parenthesis"));
        assert!(parse("foo(u)").unwrap_err().to_string().contains("known function"));
        assert!(parse("atan2(u)").unwrap_err().to_string().contains("arguments"));
        assert!(parse("u v").is_err());
    }
}
