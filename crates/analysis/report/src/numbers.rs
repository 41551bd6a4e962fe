//! Formatting of numbers for readers: significant digits, a typographic minus sign, powers of ten.

/// Value with `digits` significant digits; very small and very large ones as a power of ten.
pub fn format_significant(value: f64, digits: usize) -> String {
    if !value.is_finite() || value.abs() >= 1e300 {
        return "–".into();
    }
    if value == 0.0 {
        return "0".into();
    }
    // The exponent after rounding: 9.996 with three digits is 10.0, not 9.99.
    let exponent = rounded_exponent(value, digits);
    // Powers of ten start where the digits would be hidden among zeros.
    if exponent < -4 || exponent >= (digits as i32 + 2).min(6) {
        return power_of_ten(value, digits, exponent);
    }
    let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
    format_fixed(value, decimals)
}

/// Value with at most `digits` significant digits, without trailing zeros.
pub fn format_stated(value: f64, digits: usize) -> String {
    let text = format_significant(value, digits);
    // Trailing zeros are removed from the mantissa, not from the power of ten.
    let (number, power) = text
        .split_once('×')
        .map_or((text.as_str(), String::new()), |(number, power)| (number, format!("×{power}")));
    // Zeros before a decimal point are significant and stay.
    let trimmed = if number.contains('.') {
        number.trim_end_matches('0').trim_end_matches('.')
    } else {
        number
    };
    format!("{trimmed}{power}")
}

/// Decimal exponent of a value after rounding to `digits` significant digits.
fn rounded_exponent(value: f64, digits: usize) -> i32 {
    let text = format!("{:.*e}", digits.saturating_sub(1), value);
    text.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0)
}

fn power_of_ten(value: f64, digits: usize, exponent: i32) -> String {
    let mantissa = format_fixed(value / 10_f64.powi(exponent), digits.saturating_sub(1));
    format!("{mantissa}×10{}", format_superscript(exponent))
}

/// Integer in superscript digits.
pub(crate) fn format_superscript(number: i32) -> String {
    let raised = |c: char| match c {
        '-' => '⁻',
        _ => {
            ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][c.to_digit(10).unwrap_or(0) as usize]
        }
    };
    number.to_string().chars().map(raised).collect()
}

/// Value with a fixed number of decimals; a dash if it is not finite.
pub fn format_fixed(value: f64, decimals: usize) -> String {
    if !value.is_finite() || value.abs() >= 1e300 {
        return "–".into();
    }
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        // A negative number that rounds to zero has no sign.
        Some(zero) if zero.chars().all(|c| c == '0' || c == '.') => zero.to_owned(),
        Some(positive) => format!("−{positive}"),
        None => text,
    }
}

/// The same with a plus sign if the value is not negative.
pub fn format_signed(value: f64, decimals: usize) -> String {
    let text = format_fixed(value, decimals);
    // The second character is the dash of an unknown value, which has no sign.
    if text.starts_with(['−', '–']) { text } else { format!("+{text}") }
}

/// Value that may be unknown, which is a dash.
pub fn format_known(value: Option<f64>, format: impl Fn(f64) -> String) -> String {
    value.map_or_else(|| "–".into(), format)
}

/// Value with two decimals that may be unknown.
pub fn format_hundredths(value: Option<f64>) -> String {
    format_known(value, |value| format_fixed(value, 2))
}

/// Words joined to a list: `a, b and c`.
pub(crate) fn join_words(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_those_that_mean_something() {
        let cases = [
            (12.345, "12.3"),
            (0.012_345, "0.0123"),
            (-1.84e-5, "−1.84×10⁻⁵"),
            (0.0, "0"),
            (99.96, "100"),
            (f64::MAX, "–"),
        ];
        for (value, text) in cases {
            assert_eq!(format_significant(value, 3), text);
        }
        assert_eq!(
            (format_significant(1.2345e7, 3), format_significant(171_298.0, 2)),
            ("1.23×10⁷".into(), "1.7×10⁵".into())
        );
        let stated = [175.0, 0.562, 21222.0, -4.646e-5, 0.0].map(|value| format_stated(value, 5));
        assert_eq!(stated, ["175", "0.562", "21222", "−4.646×10⁻⁵", "0"]);
        assert_eq!(
            (format_fixed(-0.001, 1), format_signed(2.0, 1), format_signed(-2.0, 1)),
            ("0.0".into(), "+2.0".into(), "−2.0".into())
        );
    }

    #[test]
    fn lists_read_as_sentences() {
        let words = ["a", "b", "c"].map(str::to_owned);
        assert_eq!(
            (join_words(&words), join_words(&words[..1])),
            ("a, b and c".into(), "a".into())
        );
    }
}
