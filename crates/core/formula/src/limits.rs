//! Limits of the length and depth of a formula, so that no walk over it runs out of stack or time.
//!
//! Parsing recurses with the nesting of a formula, so that the text is measured before it is
//! parsed; every walk over the resulting tree recurses at most as deep as there are operators. The
//! largest formula of the zoo has 22 operators, and none nests more than 5 deep.

use crate::error::FormulaError;

/// Largest length of one formula, bytes.
pub const MAX_LENGTH: usize = 8192;

/// Largest number of operators, commas and opening parentheses of one formula, which also bounds
/// the depth of its tree.
pub const MAX_OPERATORS: usize = 256;

/// Largest nesting depth of parentheses, signs and powers.
pub const MAX_NESTING: usize = 48;

/// Largest depth of operators from a formula down through the values that it mentions.
pub const MAX_DEPTH: usize = 512;

/// Refuses a formula that is too long or too deep to be parsed.
pub fn check_limits(text: &str) -> Result<(), FormulaError> {
    if text.len() > MAX_LENGTH {
        return Err(FormulaError::Long { length: text.len(), most: MAX_LENGTH });
    }
    let FormulaMeasure { nesting, operators } = FormulaMeasure::from_text(text.as_bytes());
    if nesting > MAX_NESTING {
        return Err(FormulaError::Nested {
            head: text_head(text),
            found: nesting,
            most: MAX_NESTING,
        });
    }
    if operators > MAX_OPERATORS {
        return Err(FormulaError::Operators {
            head: text_head(text),
            found: operators,
            most: MAX_OPERATORS,
        });
    }
    Ok(())
}

/// Returns the beginning of a long text, for a message.
pub fn text_head(text: &str) -> String {
    text.chars().take(24).collect()
}

#[derive(Default)]
struct FormulaMeasure {
    nesting: usize,
    operators: usize,
}

impl FormulaMeasure {
    fn from_text(text: &[u8]) -> Self {
        let mut found = Self::default();
        // For each open parenthesis, the number of signs and powers that wait for their operand;
        // their sum and the open parentheses are the current depth.
        let (mut waiting, mut depth) = (vec![0_usize], 0_usize);
        let mut before = None;
        for (at, &byte) in text.iter().enumerate().filter(|(_, byte)| !byte.is_ascii_whitespace()) {
            let is_operand = before
                .is_some_and(|b: u8| b.is_ascii_alphanumeric() || matches!(b, b'_' | b'.' | b')'));
            match byte {
                // A sign after an operand is a binary operator, otherwise a prefix, which nests.
                b'(' => {
                    waiting.push(0);
                    depth += 1;
                }
                b')' => {
                    let closed = waiting.pop().unwrap_or(0);
                    depth = depth.saturating_sub(closed + 1);
                    // An unmatched parenthesis; the parser refuses it later.
                    if waiting.is_empty() {
                        waiting.push(0);
                    }
                }
                b'+' | b'-' if is_exponent_sign(text, at) => {}
                b'^' => add_pending(&mut waiting, &mut depth),
                b'+' | b'-' if !is_operand => add_pending(&mut waiting, &mut depth),
                // A binary operator completes the operands that signs and powers waited for.
                b'+' | b'-' | b'*' | b'/' | b',' | b'<' | b'>' => {
                    let done = waiting.last_mut().map_or(0, std::mem::take);
                    depth = depth.saturating_sub(done);
                }
                _ => {}
            }
            found.operators += usize::from(b"(+-*/^,<>".contains(&byte));
            found.nesting = found.nesting.max(depth);
            before = Some(byte);
        }
        found
    }
}

fn add_pending(waiting: &mut [usize], depth: &mut usize) {
    if let Some(last) = waiting.last_mut() {
        *last += 1;
        *depth += 1;
    }
}

/// Returns true if the sign at a position may belong to a number's exponent, as in `1e-3`.
fn is_exponent_sign(text: &[u8], at: usize) -> bool {
    let before = |back: usize| at.checked_sub(back).map(|place| text[place]);
    matches!(before(1), Some(b'e' | b'E'))
        && before(2).is_some_and(|b| b.is_ascii_digit() || b == b'.')
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::parse;

    /// Name of a kind of nesting, text with so many levels, and the limit.
    type Way = (&'static str, fn(usize) -> String, usize);

    /// Each way of making a formula deep or long, and how many of it are just allowed.
    fn ways() -> Vec<Way> {
        fn around(open: &str, n: usize, close: &str) -> String {
            format!("{}u{}", open.repeat(n), close.repeat(n))
        }
        vec![
            ("parentheses", |n| around("(", n, ")"), MAX_NESTING),
            ("signs", |n| around("-", n, ""), MAX_NESTING),
            ("plus signs", |n| around("+ ", n, ""), MAX_NESTING),
            ("calls", |n| around("sqrt(", n, ")"), MAX_NESTING),
            ("calls of two", |n| around("max(1,", n, ")"), MAX_NESTING),
            ("powers", |n| around("", n, "^2"), MAX_NESTING),
            ("powers of numbers", |n| around("", n, "^1e-1"), MAX_NESTING),
            ("signed powers", |n| around("", n / 2, "^-2"), MAX_NESTING),
            ("conditions", |n| around("if(u<1,2,", n, ")"), MAX_NESTING),
            ("a sum", |n| around("", n, "+u"), MAX_OPERATORS),
            ("a difference", |n| around("", n, "-u"), MAX_OPERATORS),
            ("a product", |n| around("", n, "*u"), MAX_OPERATORS),
            ("a quotient", |n| around("", n, "/u"), MAX_OPERATORS),
            ("a long name", |n| "u".repeat(n), MAX_LENGTH),
        ]
    }

    #[test]
    fn formulas_are_bounded_before_they_are_parsed() {
        let small = std::thread::Builder::new().stack_size(512 << 10);
        let tried = small.spawn(|| {
            for (what, make, most) in ways() {
                for n in [most / 2, most] {
                    let expr = parse(&make(n)).unwrap_or_else(|e| panic!("{n} of {what}: {e}"));
                    assert_eq!(expr.clone(), expr);
                    let _ = (
                        expr.value(&|_| Some(1.0)),
                        expr.mentioned_names().len(),
                        expr.replace_names(&|_| None),
                    );
                }
                for n in [most + 2, 10 * most, 1_000_000 / 8] {
                    let refused = parse(&make(n)).unwrap_err().to_string();
                    assert!(
                        refused.contains("the limit is") && refused.len() < 200,
                        "{n} of {what}: {refused}"
                    );
                }
            }
        });
        tried.unwrap().join().unwrap();
    }

    #[test]
    fn what_is_wide_is_not_deep() {
        let nesting = |text: &str| FormulaMeasure::from_text(text.as_bytes()).nesting;
        assert_eq!(nesting("u^2 + v^2*r^2 - (u^3)/(v^2)"), 2);
        assert_eq!(nesting("-u*-v + 1e-3 - 2E-5"), 1);
        assert_eq!(nesting("2^1e-3^x"), 2);
        assert_eq!(nesting(")))((u))"), 2);
    }
}
