//! Aliases and `%TAG` directives, recognised by their form alone: false positives are accepted.

use std::collections::HashSet;

/// Refuses aliases of anchors, and directives of tags; returns the byte at fault and a message.
pub fn check_aliases(bytes: &[u8]) -> Result<(), (usize, String)> {
    let marks: Vec<(usize, &[u8])> =
        (0..bytes.len()).filter_map(|at| Some((at, mark_name(bytes, at)?))).collect();
    let anchors: HashSet<&[u8]> =
        marks.iter().filter(|(at, _)| bytes[*at] == b'&').map(|(_, name)| *name).collect();
    // An asterisk without an anchor of that name is part of a text.
    let alias = marks.iter().find(|(at, name)| bytes[*at] == b'*' && anchors.contains(name));
    if let Some((at, name)) = alias {
        let name = sistership_formula::text_head(&String::from_utf8_lossy(name));
        return Err((*at, format!("`*{name}` is an alias: write out what `&{name}` stands for")));
    }
    match (0..bytes.len()).find(|&at| begins_line(bytes, at) && bytes[at..].starts_with(b"%TAG")) {
        Some(at) => Err((at, "`%TAG` is not supported: remove the tags".into())),
        None => Ok(()),
    }
}

/// Returns the name of a possible anchor or alias at a position.
fn mark_name(bytes: &[u8], at: usize) -> Option<&[u8]> {
    if !matches!(bytes[at], b'&' | b'*') || !may_begin(bytes, at) {
        return None;
    }
    let rest = &bytes[at + 1..];
    let length =
        rest.iter().take_while(|b| b.is_ascii_alphanumeric() || matches!(b, b'_' | b'-')).count();
    (length > 0).then(|| &rest[..length])
}

/// Returns true if a token may begin at a position, by the byte before it; bytes above ASCII may be
/// a line break or a byte order mark.
fn may_begin(bytes: &[u8], at: usize) -> bool {
    let before = at.checked_sub(1).map(|place| bytes[place]);
    before.is_none_or(|b| b.is_ascii_whitespace() || !b.is_ascii() || b"[]{},:?\"'".contains(&b))
}

fn begins_line(bytes: &[u8], at: usize) -> bool {
    at.checked_sub(1)
        .is_none_or(|before| matches!(bytes[before], b'\n' | b'\r') || !bytes[before].is_ascii())
}
