//! The shape of a JSON document: its paths and types without its values, which differ from machine
//! to machine.

use std::collections::BTreeSet;

use serde_json::Value;

/// One line for each path, with the types that were seen there.
pub fn of(document: &Value) -> String {
    let mut lines = BTreeSet::new();
    walk(document, "$", &mut lines);
    lines.into_iter().collect::<Vec<_>>().join("\n")
}

fn walk(value: &Value, path: &str, lines: &mut BTreeSet<String>) {
    match value {
        Value::Object(fields) => {
            fields.iter().for_each(|(key, value)| walk(value, &format!("{path}.{key}"), lines))
        }
        Value::Array(items) => {
            items.iter().for_each(|item| walk(item, &format!("{path}[]"), lines))
        }
        Value::Null => drop(lines.insert(format!("{path}: null"))),
        Value::Bool(_) => drop(lines.insert(format!("{path}: boolean"))),
        Value::Number(_) => drop(lines.insert(format!("{path}: number"))),
        Value::String(_) => drop(lines.insert(format!("{path}: text"))),
    }
}
