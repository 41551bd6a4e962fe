//! Wrapping of long sums and comments over several lines.

use crate::quoting::single_line;

/// Largest length of a line of generated code.
const WIDTH: usize = 96;

/// Sum over as many lines as needed; `next` ends one line and begins another.
pub fn wrap_sum(head: &str, terms: &[String], next: &str) -> String {
    let mut text = head.to_owned();
    let mut line = head.len();
    for (index, term) in terms.iter().enumerate() {
        let plus = if index == 0 { "" } else { " + " };
        if index > 0 && line + plus.len() + term.len() > WIDTH {
            text.push_str(next);
            // The new line starts with the indentation after the line break.
            line = next.rsplit('\n').next().map_or(0, str::len);
        }
        text.push_str(plus);
        text.push_str(term);
        line += plus.len() + term.len();
    }
    text
}

/// Comment over as many lines as needed, each after a comment mark; the indentation of the text is
/// kept.
pub fn wrap_comment(mark: &str, text: &str) -> Vec<String> {
    let indent = &text[..text.len() - text.trim_start_matches(' ').len()];
    let (mut lines, mut line) = (Vec::new(), format!("{mark}{indent}"));
    for word in single_line(text).split_whitespace() {
        if line.len() + 1 + word.len() > WIDTH && line.len() > mark.len() + indent.len() {
            // Continued lines are indented further.
            lines.push(std::mem::replace(&mut line, format!("{mark}{indent}   ")));
        }
        line.push(' ');
        line.push_str(word);
    }
    lines.push(line);
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_break_between_terms() {
        let terms: Vec<String> = (0..40).map(|k| format!("X_{k:02}*t{k:02}")).collect();
        let text = wrap_sum("    X = ", &terms, "\n        ");
        assert!(text.lines().count() > 3 && text.lines().all(|line| line.len() <= WIDTH));
        assert_eq!(text.replace("\n        ", ""), format!("    X = {}", terms.join(" + ")));
    }

    #[test]
    fn comments_break_between_words() {
        let lines = wrap_comment("#", &"abc defghi ".repeat(30));
        assert!(lines.len() > 3 && lines.iter().all(|line| line.len() <= WIDTH));
        assert!(lines.iter().all(|line| line.starts_with('#')));
    }

    #[test]
    fn line_breaks_of_a_text_do_not_end_its_comment() {
        assert_eq!(wrap_comment("#", "\n  a\rb\n@@mark"), ["# a b @ @mark"]);
        assert_eq!(wrap_comment("#", "  a"), ["#   a"]);
    }
}
