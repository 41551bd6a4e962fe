//! All faults of a document's shape, by the schema of its type: the parser stops at the first.

use schemars::JsonSchema;
use serde_json::{Map, Value};

use super::{MAX_FAULTS, read_document};

/// A dotted path and the fault there.
pub type ShapeFault = (String, String);

/// Returns the places where a text does not have the shape of its type, at most [`MOST_FAULTS`];
/// empty if the schema finds none, or if the text is not YAML.
pub fn find_faults<T: JsonSchema>(text: &str) -> Vec<ShapeFault> {
    // `read` checks the limits before the text is parsed.
    let Ok(document) = read_document::<Value>(text) else { return Vec::new() };
    let schema = schemars::schema_for!(T);
    let shape = SchemaChecker { root: schema.as_value() };
    shape.check_value(schema.as_value(), &document, "")
}

/// Checker for the keywords of schemas that are derived from types.
struct SchemaChecker<'a> {
    root: &'a Value,
}

impl SchemaChecker<'_> {
    fn check_value(&self, schema: &Value, value: &Value, path: &str) -> Vec<ShapeFault> {
        // Schemas of named types are references into the root schema.
        if let Some(target) = schema["$ref"].as_str() {
            let target = target.strip_prefix('#').and_then(|pointer| self.root.pointer(pointer));
            return target.map_or_else(Vec::new, |schema| self.check_value(schema, value, path));
        }
        if let Some(words) = permitted_words(schema) {
            let is_known = words.contains(&value);
            return single_fault(!is_known, path, || {
                unknown_word_message(value, words.iter().copied())
            });
        }
        let choice = schema["anyOf"].as_array().or_else(|| schema["oneOf"].as_array());
        if let Some(choice) = choice {
            return self.check_choice(choice, value, path);
        }
        if !has_type(schema, value) {
            let message =
                || format!("is {}, but should be {}", value_kind(value), expected_kind(schema));
            return single_fault(true, path, message);
        }
        match value {
            Value::Object(fields) => self.check_object(schema, fields, path),
            Value::Array(items) => {
                let of = |(place, item)| {
                    self.check_value(&schema["items"], item, &path_below(path, place))
                };
                items.iter().enumerate().flat_map(of).take(MAX_FAULTS).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Returns the faults of a choice: those of the alternative that its tag selects, or that
    /// matches best.
    fn check_choice(&self, choice: &[Value], value: &Value, path: &str) -> Vec<ShapeFault> {
        let each = choice.iter().map(|schema| self.check_value(schema, value, path));
        let mut each: Vec<Vec<ShapeFault>> = each.collect();
        if each.iter().any(Vec::is_empty) {
            return Vec::new();
        }
        let tags = choice.iter().filter_map(|schema| self.choice_tag(schema));
        let tags: Vec<(&str, &Value)> = tags.collect();
        if let Some(&(name, _)) = tags.first()
            && let Some(given) = value.get(name)
        {
            let at = tags.iter().position(|(_, word)| *word == given);
            // Indices match only if every alternative has a tag.
            return match at.filter(|_| tags.len() == each.len()) {
                Some(at) => each.swap_remove(at),
                None => vec![(
                    path_below(path, name),
                    unknown_word_message(given, tags.iter().map(|tag| tag.1)),
                )],
            };
        }
        // The alternative whose faults lie deepest accepted most of the value.
        let deepest = |faults: &Vec<ShapeFault>| faults.iter().map(|fault| fault.0.len()).max();
        each.into_iter().max_by_key(deepest).unwrap_or_default()
    }

    /// Returns the field that distinguishes the alternatives of a choice, and its value.
    fn choice_tag<'v>(&'v self, schema: &'v Value) -> Option<(&'v str, &'v Value)> {
        let target = schema["$ref"].as_str().and_then(|target| target.strip_prefix('#'));
        let schema = target.and_then(|pointer| self.root.pointer(pointer)).unwrap_or(schema);
        let mut fields = schema["properties"].as_object()?.iter();
        fields.find_map(|(name, field)| Some((name.as_str(), field.get("const")?)))
    }

    fn check_object(
        &self,
        schema: &Value,
        fields: &Map<String, Value>,
        path: &str,
    ) -> Vec<ShapeFault> {
        let (known, others) = (&schema["properties"], &schema["additionalProperties"]);
        let names = known.as_object().into_iter().flat_map(Map::keys);
        let names: Vec<&str> = names.map(String::as_str).collect();
        let mut found = Vec::new();
        for (name, value) in fields {
            // The number of faults is limited, because each is searched in the text later.
            if found.len() >= MAX_FAULTS {
                break;
            }
            let at = path_below(path, name);
            match known.get(name) {
                Some(schema) => found.extend(self.check_value(schema, value, &at)),
                None if *others == Value::Bool(false) => {
                    found
                        .push((at, format!("is not a field; the fields are {}", names.join(", "))));
                }
                None if others.is_object() => found.extend(self.check_value(others, value, &at)),
                None => {}
            }
        }
        let required = schema["required"].as_array().into_iter().flatten();
        let missing = required.filter_map(Value::as_str).filter(|name| !fields.contains_key(*name));
        found.extend(missing.map(|name| (path_below(path, name), "is missing".to_owned())));
        found
    }
}

fn single_fault(is_wrong: bool, path: &str, message: impl Fn() -> String) -> Vec<ShapeFault> {
    if is_wrong { vec![(path.to_owned(), message())] } else { Vec::new() }
}

fn path_below(path: &str, name: impl std::fmt::Display) -> String {
    if path.is_empty() { name.to_string() } else { format!("{path}.{name}") }
}

/// Returns the permitted words of a schema, if it lists any; words with descriptions are listed as
/// alternatives.
fn permitted_words(schema: &Value) -> Option<Vec<&Value>> {
    let one = schema.get("const").map(|word| vec![word]);
    let described = || schema["oneOf"].as_array()?.iter().map(|one| one.get("const")).collect();
    let all = || schema["enum"].as_array().map(|words| words.iter().collect());
    one.or_else(all).or_else(described)
}

fn unknown_word_message<'v>(value: &Value, words: impl Iterator<Item = &'v Value>) -> String {
    let known: Vec<String> = words.map(display_value).collect();
    format!("is {}, but should be one of {}", display_value(value), known.join(", "))
}

fn schema_types(schema: &Value) -> Vec<&str> {
    match &schema["type"] {
        Value::String(one) => vec![one],
        Value::Array(all) => all.iter().filter_map(Value::as_str).collect(),
        _ => Vec::new(),
    }
}

fn has_type(schema: &Value, value: &Value) -> bool {
    let is = |name: &&str| match *name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "integer" => value.is_i64() || value.is_u64(),
        // YAML has numbers that JSON lacks, such as infinity: they are read as null.
        "number" => value.is_number() || value.is_null(),
        "boolean" => value.is_boolean(),
        _ => value.is_null(),
    };
    let types = schema_types(schema);
    types.is_empty() || types.iter().any(is)
}

fn expected_kind(schema: &Value) -> String {
    let named = |name: &&str| match *name {
        "object" => "a mapping",
        "array" => "a list",
        "string" => "text",
        "integer" => "a whole number",
        "number" => "a number",
        "boolean" => "true or false",
        _ => "nothing",
    };
    schema_types(schema).iter().map(named).collect::<Vec<_>>().join(" or ")
}

fn value_kind(value: &Value) -> String {
    match value {
        Value::Object(_) => "a mapping".to_owned(),
        Value::Array(_) => "a list".to_owned(),
        Value::Null => "empty".to_owned(),
        other => display_value(other),
    }
}

/// Formats a value for readers.
fn display_value(value: &Value) -> String {
    match value {
        Value::String(text) => format!("`{text}`"),
        other => other.to_string(),
    }
}
