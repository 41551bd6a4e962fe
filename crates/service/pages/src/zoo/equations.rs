//! Formulas of a law for people: MathML Core (W3C), which browsers render without a script.

/// Returns a formula as MathML, from its text in a file.
///
/// Names become italic letters with the part after the first `_` as subscript; powers are raised.
/// The order of the terms is that of the file.
pub(super) fn formula_mathml(formula: &str) -> String {
    let tokens = tokenize(formula);
    let mut row = String::new();
    let mut at = 0;
    while at < tokens.len() {
        let base = parse_atom(&tokens, &mut at);
        if tokens.get(at).is_some_and(|token| token == "^") {
            at += 1;
            let power = parse_atom(&tokens, &mut at);
            row.push_str(&format!("<msup>{base}{power}</msup>"));
        } else {
            row.push_str(&base);
        }
    }
    format!("<math><mrow>{row}</mrow></math>")
}

/// Splits a formula into names, numbers and marks; comparisons may have two characters.
fn tokenize(formula: &str) -> Vec<String> {
    let letters: Vec<char> = formula.chars().collect();
    let (mut tokens, mut at) = (Vec::new(), 0);
    while at < letters.len() {
        let first = letters[at];
        let length = match first {
            _ if first.is_ascii_digit() => number_length(&letters[at..]),
            _ if is_name_char(first) => {
                letters[at..].iter().take_while(|one| is_name_char(**one)).count()
            }
            '<' | '>' | '=' | '!' if letters.get(at + 1) == Some(&'=') => 2,
            _ => 1,
        };
        if !first.is_whitespace() {
            tokens.push(letters[at..at + length].iter().collect());
        }
        at += length;
    }
    tokens
}

/// Returns true for characters of a name.
fn is_name_char(letter: char) -> bool {
    letter.is_alphanumeric() || "_.@".contains(letter)
}

/// Length of a number, with its exponent, in characters.
fn number_length(letters: &[char]) -> usize {
    let mut length = 0;
    for (at, letter) in letters.iter().enumerate() {
        // A sign belongs to a number only after the mark of its exponent.
        let signed = "+-".contains(*letter) && at > 0 && "eE".contains(letters[at - 1]);
        if !(letter.is_ascii_digit() || ".eE".contains(*letter) || signed) {
            break;
        }
        length = at + 1;
    }
    length
}

/// Parses the base of a power: a bracketed group, a name with its arguments, a number; or a mark.
fn parse_atom(tokens: &[String], at: &mut usize) -> String {
    let Some(token) = tokens.get(*at) else { return String::new() };
    *at += 1;
    match token.as_str() {
        "(" => format!("<mrow>{}</mrow>", parse_group(tokens, at)),
        "*" => "<mo>\u{00b7}</mo>".to_owned(),
        ">=" => "<mo>\u{2265}</mo>".to_owned(),
        "<=" => "<mo>\u{2264}</mo>".to_owned(),
        "-" => "<mo>\u{2212}</mo>".to_owned(),
        // The guards are tried in order: marks have no letters, numbers begin with a digit, and
        // functions are names before a bracket.
        mark if mark.chars().all(|letter| !letter.is_alphanumeric()) => {
            format!("<mo>{}</mo>", escape_html(mark))
        }
        number if number.starts_with(|letter: char| letter.is_ascii_digit()) => {
            format!("<mn>{}</mn>", escape_html(number))
        }
        name if tokens.get(*at).is_some_and(|next| next == "(") => {
            *at += 1;
            format!("<mrow><mi>{}</mi>{}</mrow>", escape_html(name), parse_group(tokens, at))
        }
        name => name_symbol(name),
    }
}

/// Parses up to the closing bracket, and returns the group with both brackets.
fn parse_group(tokens: &[String], at: &mut usize) -> String {
    let mut inside = String::from("<mo>(</mo>");
    while *at < tokens.len() && tokens[*at] != ")" {
        let base = parse_atom(tokens, at);
        if tokens.get(*at).is_some_and(|token| token == "^") {
            *at += 1;
            let power = parse_atom(tokens, at);
            inside.push_str(&format!("<msup>{base}{power}</msup>"));
        } else {
            inside.push_str(&base);
        }
    }
    // Past the closing bracket; an open one ends with the formula.
    *at += 1;
    inside + "<mo>)</mo>"
}

const GREEK: [(&str, &str); 12] = [
    ("delta", "δ"),
    ("psi", "ψ"),
    ("phi", "φ"),
    ("beta", "β"),
    ("gamma", "γ"),
    ("rho", "ρ"),
    ("eta", "η"),
    ("kappa", "κ"),
    ("epsilon", "ε"),
    ("lambda", "λ"),
    ("alpha", "α"),
    ("tau", "τ"),
];

/// Symbols of particulars, without their units.
const PARTICULAR_SYMBOLS: [(&str, &str); 4] = [
    ("lpp_m", "<msub><mi>L</mi><mi>pp</mi></msub>"),
    ("beam_m", "<mi>B</mi>"),
    ("draught_m", "<mi>d</mi>"),
    ("water_density_kg_m3", "<mi>\u{03c1}</mi>"),
];

/// Returns the symbol of a name: its first part, with the rest as subscript; a particular by its
/// letter.
pub(super) fn name_symbol(name: &str) -> String {
    if let Some((_, letter)) = PARTICULAR_SYMBOLS.iter().find(|(known, _)| *known == name) {
        return (*letter).to_owned();
    }
    let (first, below) = name.split_once('_').unwrap_or((name, ""));
    let letter = format!("<mi>{}</mi>", escape_html(&replace_greek(first)));
    match below {
        "" => letter,
        below => format!("<msub>{letter}<mi>{}</mi></msub>", escape_html(&replace_greek(below))),
    }
}

/// Replaces names of Greek letters by the letters.
fn replace_greek(text: &str) -> String {
    GREEK.iter().fold(text.to_owned(), |text, (name, letter)| text.replace(name, letter))
}

fn escape_html(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_are_set_as_they_are_written() {
        assert_eq!(
            formula_mathml("u^2 + v"),
            "<math><mrow><msup><mi>u</mi><mn>2</mn></msup><mo>+</mo><mi>v</mi></mrow></math>"
        );
        assert!(formula_mathml("(u - U0)/U").contains("<mo>(</mo><mi>u</mi><mo>\u{2212}</mo>"));
        assert!(formula_mathml("sqrt(u^2)").contains("<mi>sqrt</mi><mo>(</mo><msup>"));
        assert_eq!(name_symbol("Y_vvdelta"), "<msub><mi>Y</mi><mi>vvδ</mi></msub>");
        assert_eq!(tokenize("1e-4*lpp_m>=x^2"), ["1e-4", "*", "lpp_m", ">=", "x", "^", "2"]);
        assert!(formula_mathml("0.5*draught_m").contains("<mn>0.5</mn><mo>\u{b7}</mo><mi>d</mi>"));
        assert!(formula_mathml("a<b").contains("&lt;"), "what is written is not taken for a tag");
        assert!(formula_mathml("((((").contains("math"), "an open bracket ends");
    }
}
