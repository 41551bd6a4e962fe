//! Number of strings that the XML of a workbook announces, for which a reader allocates memory at
//! once.

/// Largest number of strings that a workbook may announce.
const STRINGS: u64 = 4_000_000;
/// XML attribute that announces the number of strings, as the number of its bytes.
const ATTRIBUTE: u128 = name_bits(b"uniqueCount");
/// Bits of that name.
const ATTRIBUTE_BITS: u128 = (1 << (8 * b"uniqueCount".len())) - 1;

const fn name_bits(name: &[u8]) -> u128 {
    let (mut bits, mut at) = (0, 0);
    while at < name.len() {
        bits = (bits << 8) | name[at] as u128;
        at += 1;
    }
    bits
}

/// Search for announced numbers in a text that comes in pieces. Nothing of a piece is kept: blanks
/// and zeros of any number may stand between the attribute and its digits.
#[derive(Debug, Default)]
pub(super) struct AnnouncedStrings {
    /// The last bytes of the text.
    recent: u128,
    position: Position,
}

/// Position relative to the attribute.
#[derive(Debug, Default)]
enum Position {
    #[default]
    Outside,
    /// After the name, before the first digit.
    AfterName,
    /// Within the digits, with their value so far.
    Digits(u64),
}

impl AnnouncedStrings {
    /// Reads the next piece.
    ///
    /// # Errors
    /// Refuses a number beyond the limit.
    pub fn read_piece(&mut self, piece: &[u8]) -> Result<(), String> {
        piece.iter().try_for_each(|&byte| self.read_byte(byte))
    }

    fn read_byte(&mut self, byte: u8) -> Result<(), String> {
        self.recent = ((self.recent << 8) | u128::from(byte)) & ATTRIBUTE_BITS;
        let digit = u64::from(byte.wrapping_sub(b'0'));
        self.position = match self.position {
            _ if self.recent == ATTRIBUTE => Position::AfterName,
            Position::AfterName if b" \t\r\n='\"".contains(&byte) => Position::AfterName,
            Position::AfterName if byte.is_ascii_digit() => Position::Digits(digit),
            Position::Digits(count) if byte.is_ascii_digit() => {
                Position::Digits(count.saturating_mul(10).saturating_add(digit))
            }
            Position::Digits(count) if count > STRINGS => return Err(too_many(count)),
            _ => Position::Outside,
        };
        Ok(())
    }
}

fn too_many(count: u64) -> String {
    format!("announces {count} strings, more than the limit of {STRINGS}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_in_pieces(text: &str, size: usize) -> Result<(), String> {
        let mut announced = AnnouncedStrings::default();
        text.as_bytes().chunks(size).try_for_each(|piece| announced.read_piece(piece))
    }

    #[test]
    fn a_large_number_is_found_however_it_is_written_and_divided() {
        let blanks = " ".repeat(500);
        let zeros = "0".repeat(500);
        for text in [
            "<sst uniqueCount=\"5000000\">".to_owned(),
            "<sst count='1'\tuniqueCount\n= '5000000'>".to_owned(),
            format!("<sst uniqueCount{blanks}={blanks}\"5000000\">"),
            format!("<sst uniqueCount=\"{zeros}5000000\">"),
            format!("<sst uniqueCount=\"{}\">", "9".repeat(500)),
        ] {
            for size in [1, 7, 64, 1000, 10_000] {
                assert!(read_in_pieces(&text, size).is_err(), "{size}: {text}");
            }
        }
    }

    #[test]
    fn other_numbers_are_accepted() {
        for text in [
            "<sst count=\"5000000\" uniqueCount=\"4000000\">",
            "<sst uniqueCount=\"2\"><si><t>5000000</t></si>",
            "<si><t>the uniqueCount is 5000000</t></si>",
        ] {
            assert_eq!(read_in_pieces(text, 3), Ok(()), "{text}");
        }
    }
}
