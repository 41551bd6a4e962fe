//! Formulas of a law as people read them: MathML Core (W3C), which browsers set without a script.

/// A formula as MathML, from its text in a file.
///
/// Names become italic letters with what follows the first `_` below them; products are set side by
/// side, powers raised. What stands in the file is not rearranged.
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

/// Names, numbers, and single marks.
fn tokens(formula: &str) -> Vec<String> {
    let mut tokens: Vec<String> = Vec::new();
    let mut open = false;
    for letter in formula.chars() {
        // What a coefficient's name may hold beside letters.
        let part = letter.is_alphanumeric() || "_.@|".contains(letter);
        match (part && letter != '|', open) {
            (true, true) => tokens.iter_mut().last().into_iter().for_each(|last| last.push(letter)),
            (true, false) => tokens.push(letter.to_string()),
            (false, _) if letter.is_whitespace() => {}
            (false, _) => tokens.push(letter.to_string()),
        }
        open = part && letter != '|';
    }
    tokens
}

/// What a power may follow: a bracketed group, a name with its arguments, a number; or a mark.
fn atom(tokens: &[String], at: &mut usize) -> String {
    let Some(token) = tokens.get(*at) else { return String::new() };
    *at += 1;
    match token.as_str() {
        "(" => format!("<mrow>{}</mrow>", group(tokens, at)),
        "*" => "<mo>\u{2062}</mo>".to_owned(),
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

/// A name: its first part, with the rest below it.
pub(super) fn symbol(name: &str) -> String {
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
        assert!(mathml("a<b").contains("&lt;"), "what is written is not taken for a tag");
        assert!(mathml("((((").contains("math"), "an open bracket ends");
    }
}
