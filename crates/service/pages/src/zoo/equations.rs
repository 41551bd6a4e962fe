//! Formulas of a law as people read them: MathML Core (W3C), which browsers set without a script.

/// A formula as MathML, from its text in a file.
///
/// Names become italic letters with what follows the first `_` below them, powers are raised. What
/// stands in the file is not rearranged.
pub(super) fn mathml(formula: &str) -> String {
    let tokens = tokens(formula);
    let mut row = String::new();
    let mut at = 0;
    while at < tokens.len() {
        let base = atom(&tokens, &mut at);
        if tokens.get(at).is_some_and(|token| token == "^") {
            at += 1;
            let power = atom(&tokens, &mut at);
            row.push_str(&format!("<msup>{base}{power}</msup>"));
        } else {
            row.push_str(&base);
        }
    }
    format!("<math><mrow>{row}</mrow></math>")
}

/// Names, numbers, and marks, of which comparisons have two letters.
fn tokens(formula: &str) -> Vec<String> {
    let letters: Vec<char> = formula.chars().collect();
    let (mut tokens, mut at) = (Vec::new(), 0);
    while at < letters.len() {
        let first = letters[at];
        let length = match first {
            _ if first.is_ascii_digit() => number_length(&letters[at..]),
            _ if is_name(first) => letters[at..].iter().take_while(|one| is_name(**one)).count(),
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

/// What a name may hold.
fn is_name(letter: char) -> bool {
    letter.is_alphanumeric() || "_.@".contains(letter)
}

/// How many letters a number has, with its exponent.
fn number_length(letters: &[char]) -> usize {
    let mut length = 0;
    for (at, letter) in letters.iter().enumerate() {
        let signed = "+-".contains(*letter) && at > 0 && "eE".contains(letters[at - 1]);
        if !(letter.is_ascii_digit() || ".eE".contains(*letter) || signed) {
            break;
        }
        length = at + 1;
    }
    length
}

/// What a power may follow: a bracketed group, a name with its arguments, a number; or a mark.
fn atom(tokens: &[String], at: &mut usize) -> String {
    let Some(token) = tokens.get(*at) else { return String::new() };
    *at += 1;
    match token.as_str() {
        "(" => format!("<mrow>{}</mrow>", group(tokens, at)),
        "*" => "<mo>\u{00b7}</mo>".to_owned(),
        ">=" => "<mo>\u{2265}</mo>".to_owned(),
        "<=" => "<mo>\u{2264}</mo>".to_owned(),
        "-" => "<mo>\u{2212}</mo>".to_owned(),
        mark if mark.chars().all(|letter| !letter.is_alphanumeric()) => {
            format!("<mo>{}</mo>", escaped(mark))
        }
        number if number.starts_with(|letter: char| letter.is_ascii_digit()) => {
            format!("<mn>{}</mn>", escaped(number))
        }
        name if tokens.get(*at).is_some_and(|next| next == "(") => {
            *at += 1;
            format!("<mrow><mi>{}</mi>{}</mrow>", escaped(name), group(tokens, at))
        }
        name => symbol(name),
    }
}

/// What stands up to the closing bracket, with both brackets.
fn group(tokens: &[String], at: &mut usize) -> String {
    let mut inside = String::from("<mo>(</mo>");
    while *at < tokens.len() && tokens[*at] != ")" {
        let base = atom(tokens, at);
        if tokens.get(*at).is_some_and(|token| token == "^") {
            *at += 1;
            let power = atom(tokens, at);
            inside.push_str(&format!("<msup>{base}{power}</msup>"));
        } else {
            inside.push_str(&base);
        }
    }
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

/// Particulars by the letters that stand for them, without their units.
const PARTICULARS: [(&str, &str); 4] = [
    ("lpp_m", "<msub><mi>L</mi><mi>pp</mi></msub>"),
    ("beam_m", "<mi>B</mi>"),
    ("draught_m", "<mi>d</mi>"),
    ("water_density_kg_m3", "<mi>\u{03c1}</mi>"),
];

/// A name: its first part, with the rest below it; a particular by its letter.
pub(super) fn symbol(name: &str) -> String {
    if let Some((_, letter)) = PARTICULARS.iter().find(|(known, _)| *known == name) {
        return (*letter).to_owned();
    }
    let (first, below) = name.split_once('_').unwrap_or((name, ""));
    let letter = format!("<mi>{}</mi>", escaped(&greek(first)));
    match below {
        "" => letter,
        below => format!("<msub>{letter}<mi>{}</mi></msub>", escaped(&greek(below))),
    }
}

/// Greek letters in the place of their names.
fn greek(text: &str) -> String {
    GREEK.iter().fold(text.to_owned(), |text, (name, letter)| text.replace(name, letter))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_are_set_as_they_are_written() {
        assert_eq!(
            mathml("u^2 + v"),
            "<math><mrow><msup><mi>u</mi><mn>2</mn></msup><mo>+</mo><mi>v</mi></mrow></math>"
        );
        assert!(mathml("(u - U0)/U").contains("<mo>(</mo><mi>u</mi><mo>\u{2212}</mo>"));
        assert!(mathml("sqrt(u^2)").contains("<mi>sqrt</mi><mo>(</mo><msup>"));
        assert_eq!(symbol("Y_vvdelta"), "<msub><mi>Y</mi><mi>vvδ</mi></msub>");
        assert_eq!(tokens("1e-4*lpp_m>=x^2"), ["1e-4", "*", "lpp_m", ">=", "x", "^", "2"]);
        assert!(mathml("0.5*draught_m").contains("<mn>0.5</mn><mo>\u{b7}</mo><mi>d</mi>"));
        assert!(mathml("a<b").contains("&lt;"), "what is written is not taken for a tag");
        assert!(mathml("((((").contains("math"), "an open bracket ends");
    }
}
