//! Definitions of ROS messages (`.msg` text, types concatenated), parsed generically.

use std::collections::HashMap;

/// Largest number of fields of all types, and depth of types in types.
const MAX_FIELDS: usize = 2000;
const MAX_DEPTH: usize = 10;

/// Number type of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PrimitiveType {
    Bool,
    Int {
        size: usize,
        is_signed: bool,
    },
    Float {
        size: usize,
    },
    Text,
    /// Text of two bytes a character.
    WideText,
}

/// Type of a field.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum FieldType {
    Primitive(PrimitiveType),
    Message(Vec<MessageField>),
}

/// Number of values of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FieldCount {
    One,
    Fixed(usize),
    /// Any number, which the message has before the values.
    Sequence,
}

/// Field of a message.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MessageField {
    pub name: String,
    pub kind: FieldType,
    pub count: FieldCount,
}

/// Parses the definition of a message; `None` if a type of it is not defined.
pub(crate) fn parse_schema(text: &str) -> Option<Vec<MessageField>> {
    let mut types: HashMap<&str, Vec<&str>> = HashMap::new();
    let mut name = "";
    for line in text.lines() {
        let line = line.split('#').next().unwrap_or_default().trim();
        if let Some(next) = line.strip_prefix("MSG:") {
            name = next.trim();
        } else if !line.is_empty() && !line.starts_with("===") {
            types.entry(name).or_default().push(line);
        }
    }
    let mut left = MAX_FIELDS;
    resolve_type(&types, "", 0, &mut left)
}

fn resolve_type(
    types: &HashMap<&str, Vec<&str>>,
    name: &str,
    depth: usize,
    left: &mut usize,
) -> Option<Vec<MessageField>> {
    let empty = Vec::new();
    // The outer message may have no field.
    let lines = types.get(name).or_else(|| name.is_empty().then_some(&empty))?;
    let mut fields = Vec::new();
    for line in lines {
        let mut words = line.split_whitespace();
        let (Some(kind), Some(field)) = (words.next(), words.next()) else { continue };
        // A constant has its value after its name.
        let is_constant =
            field.contains('=') || words.next().is_some_and(|next| next.starts_with('='));
        if is_constant {
            continue;
        }
        *left = left.checked_sub(1)?;
        let (kind, count) = split_count(kind)?;
        let kind = match primitive_type(kind) {
            Some(known) => FieldType::Primitive(known),
            None if depth < MAX_DEPTH => {
                let inner = match time_fields(kind) {
                    Some(fields) => fields,
                    None => resolve_type(types, &find_type(types, kind)?, depth + 1, left)?,
                };
                FieldType::Message(inner)
            }
            None => return None,
        };
        fields.push(MessageField { name: field.to_owned(), kind, count });
    }
    Some(fields)
}

/// Splits `float64[36]`, `float64[]` or `float64[<=4]`.
fn split_count(kind: &str) -> Option<(&str, FieldCount)> {
    let Some((name, rest)) = kind.split_once('[') else {
        return Some((unbounded_type(kind), FieldCount::One));
    };
    let count = rest.strip_suffix(']')?;
    let count = match count.parse() {
        Ok(fixed) => FieldCount::Fixed(fixed),
        Err(_) => FieldCount::Sequence,
    };
    Some((unbounded_type(name), count))
}

/// Returns a type without the bound of a text (`string<=16`).
fn unbounded_type(kind: &str) -> &str {
    kind.split("<=").next().unwrap_or(kind)
}

fn primitive_type(kind: &str) -> Option<PrimitiveType> {
    let int = |size: usize, is_signed: bool| Some(PrimitiveType::Int { size, is_signed });
    match kind {
        "bool" => Some(PrimitiveType::Bool),
        "byte" | "char" | "uint8" => int(1, false),
        "int8" => int(1, true),
        "int16" => int(2, true),
        "uint16" => int(2, false),
        "int32" => int(4, true),
        "uint32" => int(4, false),
        "int64" => int(8, true),
        "uint64" => int(8, false),
        "float32" => Some(PrimitiveType::Float { size: 4 }),
        "float64" => Some(PrimitiveType::Float { size: 8 }),
        "string" => Some(PrimitiveType::Text),
        "wstring" => Some(PrimitiveType::WideText),
        _ => None,
    }
}

/// Returns the fields of ROS 1's types of time, which have no definition of their own, and of
/// ROS 2's, which some recorders leave out.
fn time_fields(kind: &str) -> Option<Vec<MessageField>> {
    let int = |name: &str, is_signed: bool| MessageField {
        name: name.to_owned(),
        kind: FieldType::Primitive(PrimitiveType::Int { size: 4, is_signed }),
        count: FieldCount::One,
    };
    match kind {
        "time" => Some(vec![int("sec", false), int("nanosec", false)]),
        "duration" | "builtin_interfaces/Time" | "builtin_interfaces/msg/Time" => {
            Some(vec![int("sec", true), int("nanosec", false)])
        }
        _ => None,
    }
}

/// Returns the full name of a type that may be written without its package or without `msg`.
fn find_type(types: &HashMap<&str, Vec<&str>>, kind: &str) -> Option<String> {
    let last = |name: &str| name.rsplit('/').next().unwrap_or_default().to_owned();
    let package = |name: &str| name.split('/').next().unwrap_or_default().to_owned();
    let same = |known: &&&str| {
        let bare = !kind.contains('/');
        last(known) == last(kind) && (bare || package(known) == package(kind))
    };
    types.keys().find(same).map(|known| (*known).to_owned())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn definitions_are_resolved_and_bounded() {
        let text = "# comment\nuint8 KIND=3\nstd_msgs/Header header\nfloat64[9] covariance\n\
                    Vector3 rate # rad/s\nstring<=8 note\n===\nMSG: std_msgs/Header\n\
                    builtin_interfaces/Time stamp\nstring frame_id\n===\n\
                    MSG: geometry_msgs/Vector3\nfloat64 x 0\nfloat64 y\nfloat64 z\n";
        let fields = parse_schema(text).unwrap();
        let names: Vec<&str> = fields.iter().map(|field| field.name.as_str()).collect();
        assert_eq!(names, ["header", "covariance", "rate", "note"]);
        assert_eq!(fields[1].count, FieldCount::Fixed(9));
        assert!(matches!(&fields[2].kind, FieldType::Message(inner) if inner.len() == 3));
        assert_eq!(parse_schema("Missing one"), None);
        // A type within itself would have no end.
        assert_eq!(parse_schema("A a\n===\nMSG: p/A\nA a\n"), None);
    }
}
