//! Output: results on standard output, everything else on standard error.

use std::io::{ErrorKind, Write};

use serde::Serialize;

use crate::failure::Failure;

/// Prints a result: one JSON document, or text.
///
/// # Errors
/// Returns an error if standard output cannot be written. A reader that stopped reading (`| head`)
/// is no error.
pub fn print_result(
    json: bool,
    document: &impl Serialize,
    text: impl FnOnce() -> String,
) -> Result<(), Failure> {
    let mut result = if json {
        serde_json::to_string_pretty(document)
            .map_err(|error| Failure::Refused(format!("the result cannot be written: {error}")))?
    } else {
        text()
    };
    result.truncate(result.trim_end().len());
    result.push('\n');
    let mut out = std::io::stdout().lock();
    match out.write_all(result.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::Refused(format!("standard output cannot be written: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints a line on standard error. A failure is ignored: notes are no results.
pub fn print_note(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// `1 trial`, `2 trials`.
pub fn format_count(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

/// Shortens long lines of a message, which may quote a file.
pub fn shorten_lines(message: &str) -> String {
    const MOST: usize = 1000;
    let short = |line: &str| match line.char_indices().nth(MOST) {
        Some((end, _)) => format!("{} ...", &line[..end]),
        None => line.to_owned(),
    };
    message.lines().map(short).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endless_lines_are_cut() {
        assert_eq!(shorten_lines("a\nb"), "a\nb");
        assert_eq!(shorten_lines(&"ü".repeat(5000)).chars().count(), 1004);
    }

    #[test]
    fn numbers_agree() {
        assert_eq!(
            (format_count(1, "trial"), format_count(0, "trial")),
            ("1 trial".to_owned(), "0 trials".to_owned())
        );
    }
}
