//! Nesting depth of brackets and braces, determined without knowledge of where strings, comments
//! and block scalars begin and end.
//!
//! Outside brackets, the meaning of a byte depends on the indentation of everything before it;
//! inside, on few rules. Each bracket is therefore taken as the outermost one, and the following
//! text is read by the rules for the inside. For true outermost brackets this is how the parser
//! reads them; for those within a text the reading is superfluous, and seldom deep.

use super::line_break::break_at;

/// Largest nesting depth of brackets and braces.
pub const MAX_DEPTH: usize = 64;

/// Largest number of passes over a document: one for each level of nesting, and one for each
/// bracket that is never closed.
const MAX_PASSES: usize = 16;

/// Smallest length that is assumed of a document, bytes: short ones may have more brackets that are
/// never closed.
const SHORT: usize = 256 << 10;

/// Refuses brackets that nest deeper than [`MAX_DEPTH`]; returns the byte at fault and a message.
pub fn check(bytes: &[u8]) -> Result<(), (usize, String)> {
    // Every byte that is read is subtracted from the budget, which bounds the time.
    let mut budget = MAX_PASSES * bytes.len().max(SHORT);
    for at in (0..bytes.len()).filter(|&at| matches!(bytes[at], b'[' | b'{')) {
        // Each opening bracket is read as if it were the outermost one.
        let mut inside = Inside { bytes, at, depth: 0, most: 0 };
        inside.read();
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
                    "brackets nest too deep or are not closed: {MAX_PASSES} are the most in a long \
                     document"
                ),
            ));
        };
        budget = left;
    }
    Ok(())
}

/// Reader of the text inside brackets, by the rules of libyaml's scanner.
struct Inside<'a> {
    bytes: &'a [u8],
    at: usize,
    depth: usize,
    most: usize,
}

impl Inside<'_> {
    /// Reads tokens until the bracket is closed, the limit of depth is exceeded or the text ends.
    fn read(&mut self) {
        while let Some(byte) = self.peek() {
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
                b'"' => self.quoted(),
                b'\'' => self.single_quoted(),
                b'#' => self.comment(),
                b'!' => self.tag(),
                b'&' | b'*' => self.anchor(),
                b' ' | b'\t' | b',' | b':' | b'?' => self.at += 1,
                b'-' if self.bytes.get(self.at + 1).is_none_or(|next| !next.is_ascii_graphic()) => {
                    self.at += 1
                }
                _ => match break_at(self.bytes, self.at) {
                    Some(length) => self.at += length,
                    None => self.plain(),
                },
            }
            // At depth 0 the bracket is closed.
            if self.depth == 0 || self.most > MAX_DEPTH {
                return;
            }
        }
    }

    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    fn skip_while(&mut self, wanted: impl Fn(u8) -> bool) {
        while self.peek().is_some_and(&wanted) {
            self.at += 1;
        }
    }

    fn quoted(&mut self) {
        self.at += 1;
        while let Some(byte) = self.peek() {
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
    fn single_quoted(&mut self) {
        self.at += 1;
        self.skip_while(|byte| byte != b'\'');
        self.at = (self.at + 1).min(self.bytes.len());
    }

    fn comment(&mut self) {
        while self.at < self.bytes.len() && break_at(self.bytes, self.at).is_none() {
            self.at += 1;
        }
    }

    /// Skips a tag. Only a verbatim tag, `!<...>`, may contain brackets.
    fn tag(&mut self) {
        self.at += 1;
        if self.peek() == Some(b'<') {
            self.skip_while(|byte| byte != b'>' && !byte.is_ascii_whitespace());
        }
        self.skip_while(|byte| !byte.is_ascii_whitespace() && !b",[]{}".contains(&byte));
    }

    fn anchor(&mut self) {
        self.at += 1;
        self.skip_while(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'-'));
    }

    /// Skips a plain scalar: quotes, spaces and line breaks are part of it, up to the character
    /// that ends it.
    fn plain(&mut self) {
        let mut after_space = false;
        while let Some(byte) = self.peek() {
            let line_break = break_at(self.bytes, self.at);
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
