//! Line breaks according to libyaml.

/// Length in bytes of the line break at a position; `None` if there is none. NEL, LS and PS are
/// included, which libyaml takes for line breaks.
pub fn line_break_length(bytes: &[u8], at: usize) -> Option<usize> {
    match bytes[at] {
        b'\n' | b'\r' => Some(1),
        0xC2 if bytes.get(at + 1) == Some(&0x85) => Some(2),
        0xE2 if matches!(bytes.get(at + 1..at + 3), Some([0x80, 0xA8 | 0xA9])) => Some(3),
        _ => None,
    }
}
