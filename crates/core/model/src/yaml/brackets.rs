//! Nesting depth of brackets and braces, determined without knowledge of where strings, comments
//! and block scalars begin and end.
//!
//! Outside brackets, the meaning of a byte depends on the indentation of everything before it;
//! inside, on few rules. Each bracket is therefore taken as the outermost one, and the following
//! text is read by the rules for the inside. For true outermost brackets this is how the parser
//! reads them; for those within a text the reading is superfluous, and seldom deep.

use super::line_break::line_break_length;

/// Largest nesting depth of brackets and braces.
pub const MAX_DEPTH: usize = 64;

/// Largest number of passes over a document: one for each level of nesting, and one for each
/// bracket that is never closed.
const MAX_PASSES: usize = 16;

/// Smallest length that is assumed of a document, bytes: short ones may have more brackets that are
/// never closed.
const MIN_BUDGET_LENGTH: usize = 256 << 10;

/// Refuses brackets that nest deeper than [`MAX_DEPTH`]; returns the byte at fault and a message.
pub fn check_brackets(bytes: &[u8]) -> Result<(), (usize, String)> {
    // Every byte that is read is subtracted from the budget, which bounds the time.
    let mut budget = MAX_PASSES * bytes.len().max(MIN_BUDGET_LENGTH);
    for at in (0..bytes.len()).filter(|&at| matches!(bytes[at], b'[' | b'{')) {
        // Each opening bracket is read as if it were the outermost one.
        let mut inside = BracketScanner { bytes, at, depth: 0, most: 0 };
        inside.scan_tokens();
        if inside.most > MAX_DEPTH {
            return Err((
                inside.at,
                format!("brackets and braces nest more than {MAX_DEPTH} deep"),
            ));
        }
        let Some(left) = budget.checked_sub(inside.at - at) else {
            return Err((
                at,
                format!(
                    "brackets nest too deep or are not closed: the limit is {MAX_PASSES} in a \
                     long document"
                ),
            ));
        };
        budget = left;
    }
    Ok(())
}

/// Reader of the text inside brackets, by the rules of libyaml's scanner.
struct BracketScanner<'a> {
    bytes: &'a [u8],
    at: usize,
    depth: usize,
    most: usize,
}

impl BracketScanner<'_> {
    /// Reads tokens until the bracket is closed, the limit of depth is exceeded or the text ends.
    fn scan_tokens(&mut self) {
        while let Some(byte) = self.peek_byte() {
            match byte {
                b'[' | b'{' => {
                    self.depth += 1;
                    self.most = self.most.max(self.depth);
                    self.at += 1;
                }
                b']' | b'}' => {
                    self.depth -= 1;
                    self.at += 1;
                }
                b'"' => self.skip_double_quoted(),
                b'\'' => self.skip_single_quoted(),
                b'#' => self.skip_comment(),
                b'!' => self.skip_tag(),
                b'&' | b'*' => self.skip_anchor(),
                b' ' | b'\t' | b',' | b':' | b'?' => self.at += 1,
                b'-' if self.bytes.get(self.at + 1).is_none_or(|next| !next.is_ascii_graphic()) => {
                    self.at += 1
                }
                _ => match line_break_length(self.bytes, self.at) {
                    Some(length) => self.at += length,
                    None => self.skip_plain(),
                },
            }
            // At depth 0 the bracket is closed.
            if self.depth == 0 || self.most > MAX_DEPTH {
                return;
            }
        }
    }

    fn peek_byte(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    fn skip_while(&mut self, wanted: impl Fn(u8) -> bool) {
        while self.peek_byte().is_some_and(&wanted) {
            self.at += 1;
        }
    }

    fn skip_double_quoted(&mut self) {
        self.at += 1;
        while let Some(byte) = self.peek_byte() {
            // A backslash escapes the next byte.
            self.at += if byte == b'\\' { 2 } else { 1 };
            if byte == b'"' {
                return;
            }
        }
        // A string that is not closed extends to the end of the text.
        self.at = self.bytes.len();
    }

    /// Skips a single-quoted string. A doubled quote is read as the end of one string and the
    /// beginning of the next, with the same end.
    fn skip_single_quoted(&mut self) {
        self.at += 1;
        self.skip_while(|byte| byte != b'\'');
        self.at = (self.at + 1).min(self.bytes.len());
    }

    fn skip_comment(&mut self) {
        while self.at < self.bytes.len() && line_break_length(self.bytes, self.at).is_none() {
            self.at += 1;
        }
    }

    /// Skips a tag. Only a verbatim tag, `!<...>`, may contain brackets.
    fn skip_tag(&mut self) {
        self.at += 1;
        if self.peek_byte() == Some(b'<') {
            self.skip_while(|byte| byte != b'>' && !byte.is_ascii_whitespace());
        }
        self.skip_while(|byte| !byte.is_ascii_whitespace() && !b",[]{}".contains(&byte));
    }

    fn skip_anchor(&mut self) {
        self.at += 1;
        self.skip_while(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'-'));
    }

    /// Skips a plain scalar: quotes, spaces and line breaks are part of it, up to the character
    /// that ends it.
    fn skip_plain(&mut self) {
        let mut after_space = false;
        while let Some(byte) = self.peek_byte() {
            let line_break = line_break_length(self.bytes, self.at);
            // Indicators that end a plain scalar inside brackets.
            let ends = match byte {
                b',' | b'[' | b']' | b'{' | b'}' => true,
                b'#' => after_space,
                b':' => self.bytes.get(self.at + 1).is_none_or(|next| !next.is_ascii_graphic()),
                _ => false,
            };
            if ends {
                return;
            }
            after_space = matches!(byte, b' ' | b'\t') || line_break.is_some();
            self.at += line_break.unwrap_or(1);
        }
    }
}
