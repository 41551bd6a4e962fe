//! Text in UTF-16, as Excel saves it, is decoded to UTF-8; other text is passed on as it is.

use std::borrow::Cow;
use std::io::{self, Cursor, Read};

/// Number of bytes that are decoded at a time.
const PIECE: usize = 8 << 10;

/// Decodes one code unit from its bytes.
type DecodeUnit = fn([u8; 2]) -> u16;

/// Returns text as it is, or as Latin-1, where every byte is a character, if it is not UTF-8.
pub(crate) fn decode_text(bytes: &[u8]) -> Cow<'_, str> {
    let latin_1 = || bytes.iter().map(|&byte| char::from(byte)).collect::<String>();
    std::str::from_utf8(bytes).map_or_else(|_| latin_1().into(), Cow::from)
}

/// Reader of text whose first bytes, a byte order mark, show whether it is UTF-16.
pub(crate) struct TextDecoder<R> {
    inner: R,
    has_begun: bool,
    /// Byte order of UTF-16; `None` for other text.
    order: Option<DecodeUnit>,
    /// Bytes that are not decoded yet.
    open: Vec<u8>,
    text: Cursor<Vec<u8>>,
}

impl<R: Read> TextDecoder<R> {
    pub(crate) fn new(inner: R) -> Self {
        let (open, text) = (Vec::new(), Cursor::default());
        Self { inner, has_begun: false, order: None, open, text }
    }

    fn read_mark(&mut self) -> io::Result<()> {
        let mut start = Vec::new();
        self.inner.by_ref().take(2).read_to_end(&mut start)?;
        self.order = match start[..] {
            [0xff, 0xfe] => Some(u16::from_le_bytes),
            [0xfe, 0xff] => Some(u16::from_be_bytes),
            _ => None,
        };
        // The two bytes belong to the text where they are no mark.
        if self.order.is_none() {
            self.text = Cursor::new(start);
        }
        self.has_begun = true;
        Ok(())
    }

    /// Decodes the next piece; returns false at the end.
    fn decode_piece(&mut self, order: DecodeUnit) -> io::Result<bool> {
        let mut piece = vec![0; PIECE];
        let read = self.inner.read(&mut piece)?;
        self.open.extend_from_slice(&piece[..read]);
        let mut units: Vec<u16> = self.open.as_chunks().0.iter().map(|unit| order(*unit)).collect();
        // The second half of a pair may be in the next piece.
        if read > 0 && units.last().is_some_and(|unit| (0xd800..0xdc00).contains(unit)) {
            units.pop();
        }
        // An odd byte waits for its other half.
        self.open.drain(..2 * units.len());
        self.text = Cursor::new(String::from_utf16_lossy(&units).into_bytes());
        Ok(read > 0)
    }
}

impl<R: Read> Read for TextDecoder<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        if !self.has_begun {
            self.read_mark()?;
        }
        loop {
            let read = self.text.read(out)?;
            if read > 0 || out.is_empty() {
                return Ok(read);
            }
            let Some(order) = self.order else { return self.inner.read(out) };
            if !self.decode_piece(order)? {
                // The last bytes may have completed a character.
                return self.text.read(out);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn decoded(bytes: &[u8]) -> String {
        let mut text = String::new();
        TextDecoder::new(bytes).read_to_string(&mut text).unwrap();
        text
    }

    #[test]
    fn text_of_both_byte_orders_is_decoded() {
        // A character of two units stands across the end of the first piece.
        let wanted = format!("{}\u{1f6a2};°\r\n", "a".repeat(PIECE / 2 - 1));
        let units: Vec<u16> = std::iter::once(0xfeff).chain(wanted.encode_utf16()).collect();
        let little: Vec<u8> = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
        let big: Vec<u8> = units.iter().flat_map(|unit| unit.to_be_bytes()).collect();
        assert!(decoded(&little) == wanted && decoded(&big) == wanted);
    }

    #[test]
    fn other_text_is_left_as_it_is() {
        for text in ["", "t", "t_s,u_kn\n", "\u{feff}t_s\n"] {
            assert_eq!(decoded(text.as_bytes()), text);
        }
    }
}
