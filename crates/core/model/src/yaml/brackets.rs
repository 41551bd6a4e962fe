//! How deep brackets and braces nest, told without knowing where strings, comments and block
//! scalars begin and end.
//!
//! Outside brackets, what a byte means depends on the indentation of everything before it; inside,
//! on few rules. So each bracket is taken for the outermost one, and what follows is read by the
//! rules for what is inside. For the brackets that are, that is how the parser reads it; for those
//! that stand in some text it is read in vain, and seldom deep.

use super::line_break::break_at;

/// Brackets and braces within each other.
pub const MAX_DEPTH: usize = 64;

/// How often a document may be read over: as often as its brackets nest, and once for each that is
/// never closed.
const MAX_PASSES: usize = 16;

/// A document that counts as this long at least, bytes: short ones may have more brackets that are
/// never closed.
const SHORT: usize = 256 << 10;

/// Refuses brackets that nest deeper than [`MAX_DEPTH`], at a byte.
pub fn check(bytes: &[u8]) -> Result<(), (usize, String)> {
    let mut budget = MAX_PASSES * bytes.len().max(SHORT);
    for at in (0..bytes.len()).filter(|&at| matches!(bytes[at], b'[' | b'{')) {
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

/// A reader of what is inside brackets, as libyaml's scanner has it.
struct Inside<'a> {
    bytes: &'a [u8],
    at: usize,
    depth: usize,
    most: usize,
}

impl Inside<'_> {
    /// Reads tokens until the bracket is closed, they nest too deep or the text ends.
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
            self.at += if byte == b'\\' { 2 } else { 1 };
            if byte == b'"' {
                return;
            }
        }
        self.at = self.bytes.len();
    }

    /// A doubled quote reads as the end of one string and the beginning of the next, to the same
    /// end.
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

    /// Only a verbatim tag, `!<...>`, may have brackets in it.
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

    /// A plain scalar: quotes are part of it, and so are spaces and lines, up to what ends it.
    fn plain(&mut self) {
        let mut after_space = false;
        while let Some(byte) = self.peek() {
            let line_break = break_at(self.bytes, self.at);
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
