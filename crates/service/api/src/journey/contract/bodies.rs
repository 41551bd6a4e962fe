//! Bodies that are JSON documents: each field with values on both sides of what its schema allows.

use serde_json::{Value, json};

use super::values::{fitting, sample, unfit, within};
use super::{Faults, Operation};
use crate::journey::harness::Harness;

/// Depth to which the fields of a type are walked; of files of the zoo only the first level, as
/// other tests read them in full.
const DEPTH: usize = 4;
const FILES: [&str; 2] = ["VesselFile", "Model"];

/// A field of a body.
struct Field {
    /// Names and indices from the top.
    at: Vec<String>,
    schema: Value,
    required: bool,
    nullable: bool,
    /// Least document of each object above it.
    above: Vec<Value>,
}

impl Field {
    /// Returns a body with everything above the field.
    fn body(&self, base: &Value) -> Value {
        let mut body = base.clone();
        for (depth, made) in self.above.iter().enumerate() {
            let at = &self.at[..=depth];
            let pointer: String = at.iter().map(|key| format!("/{key}")).collect();
            if body.pointer(&pointer).is_none() {
                body = with(&body, at, made.clone());
            }
        }
        body
    }
}

/// Sends every field of a body with values that it may and may not have.
pub(super) async fn walk(
    operation: &Operation,
    harness: &Harness,
    document: &Value,
    faults: &mut Faults,
) {
    let schema = &operation.about["requestBody"]["content"]["application/json"]["schema"];
    if schema.is_null() {
        return;
    }
    let base = made(document, schema);
    let (top, _) = resolved(document, schema);
    let mut fields = Vec::new();
    let file =
        FILES.iter().any(|file| schema["$ref"].as_str().is_some_and(|name| name.ends_with(file)));
    collect(document, &top, (&[], &[]), if file { 1 } else { DEPTH }, &mut fields);
    let send =
        |body: Value| operation.request(harness, None, &[]).header("if-match", "*").json(&body);
    if top["additionalProperties"] == false {
        operation
            .refused(send(with(&base, &["nonsense".into()], json!(1))), &[422], "nonsense", faults)
            .await;
    }
    for field in fields {
        let name = field.at.iter().rfind(|key| key.parse::<usize>().is_err()).unwrap().clone();
        let base = field.body(&base);
        if field.required {
            operation.refused(send(without(&base, &field.at)), &[422], &name, faults).await;
        }
        for wrong in wrong(&field) {
            operation
                .refused(send(with(&base, &field.at, wrong)), &[422, 400], &name, faults)
                .await;
        }
        for right in right(&field) {
            operation.taken(send(with(&base, &field.at, right)), &field.at.join("."), faults).await;
        }
        if field.schema["additionalProperties"] == false && field.schema["properties"].is_object() {
            let mut at = field.at.clone();
            at.push("nonsense".to_owned());
            operation.refused(send(with(&base, &at, json!(1))), &[422], "nonsense", faults).await;
        }
    }
}

/// Returns a schema without references, and whether it may be null as well.
fn resolved(document: &Value, schema: &Value) -> (Value, bool) {
    if let Some(name) = schema["$ref"].as_str() {
        let pointer = name.trim_start_matches('#');
        let found =
            document.pointer(pointer).unwrap_or_else(|| panic!("{name} is not in the document"));
        return resolved(document, found);
    }
    for of in ["oneOf", "anyOf"] {
        let Some(all) = schema[of].as_array() else { continue };
        let real: Vec<_> = all.iter().filter(|one| one["type"] != "null").collect();
        let words = real.iter().all(|one| one["const"].is_string());
        match real.as_slice() {
            [only] => return (resolved(document, only).0, real.len() < all.len()),
            _ if words => {
                let words: Vec<_> = real.iter().map(|one| one["const"].clone()).collect();
                return (json!({ "type": "string", "enum": words }), real.len() < all.len());
            }
            _ => return (json!({}), true),
        }
    }
    let mut schema = schema.clone();
    let types = schema["type"].as_array().cloned();
    let nullable = types.as_ref().is_some_and(|types| types.contains(&json!("null")));
    if let Some(real) = types.and_then(|types| types.into_iter().find(|kind| kind != "null")) {
        schema["type"] = real;
    }
    (schema, nullable)
}

fn collect(
    document: &Value,
    schema: &Value,
    (at, above): (&[String], &[Value]),
    depth: usize,
    fields: &mut Vec<Field>,
) {
    let Some(properties) = schema["properties"].as_object().filter(|_| depth > 0) else { return };
    let required = |name: &str| {
        schema["required"].as_array().is_some_and(|all| all.iter().any(|known| known == name))
    };
    for (name, property) in properties {
        let (found, nullable) = resolved(document, property);
        let at: Vec<String> = at.iter().cloned().chain([name.clone()]).collect();
        let file = FILES
            .iter()
            .any(|file| property["$ref"].as_str().is_some_and(|name| name.ends_with(file)));
        if !file {
            let below: Vec<Value> = above.iter().cloned().chain([made(document, &found)]).collect();
            collect(document, &found, (&at, &below), depth - 1, fields);
            // An entry of a list is walked if it is a text or a number.
            let (item, item_nullable) = resolved(document, &found["items"]);
            if found["type"] == "array" && !item["type"].is_null() && item["type"] != "object" {
                let at = at.iter().cloned().chain(["0".to_owned()]).collect();
                fields.push(Field {
                    at,
                    schema: item,
                    required: false,
                    nullable: item_nullable,
                    above: above.to_vec(),
                });
            }
        }
        fields.push(Field {
            at,
            schema: found,
            required: required(name),
            nullable,
            above: above.to_vec(),
        });
    }
}

/// Returns the least document of a schema.
fn made(document: &Value, schema: &Value) -> Value {
    let (schema, nullable) = resolved(document, schema);
    match schema["type"].as_str() {
        Some("object") => {
            let required =
                schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str);
            required
                .map(|name| (name.to_owned(), made(document, &schema["properties"][name])))
                .collect()
        }
        Some("array") => {
            let least = schema["minItems"].as_u64().unwrap_or(0);
            (0..least).map(|_| made(document, &schema["items"])).collect()
        }
        Some("string") => json!(sample(&schema)),
        Some("integer") => [1_u64, 2, 10].into_iter().find(|n| within(&schema, *n as f64)).into(),
        Some("number") => [1.0, 0.5].into_iter().find(|n| within(&schema, *n)).into(),
        Some("boolean") => json!(false),
        _ if nullable => Value::Null,
        _ => json!({}),
    }
}

fn wrong(field: &Field) -> Vec<Value> {
    let schema = &field.schema;
    let Some(kind) = schema["type"].as_str() else { return Vec::new() };
    let mut all = vec![json!([[]]), json!("\u{0}"), json!(true), json!({ "nonsense": 1 })];
    all.retain(|value| !is(kind, value));
    if !field.nullable {
        all.push(Value::Null);
    }
    match kind {
        "string" => all.extend(
            unfit(schema)
                .into_iter()
                .filter(|text| !super::values::string(schema, text))
                .map(Value::from),
        ),
        "integer" | "number" => {
            let limits = [
                schema["minimum"].as_f64().map(|n| n - 1.0),
                schema["maximum"].as_f64().map(|n| n + 1.0),
            ];
            let exclusive = schema["exclusiveMinimum"].as_f64();
            let numbers =
                limits.into_iter().chain([exclusive, schema["not"]["const"].as_f64()]).flatten();
            all.extend(numbers.filter(|n| !within(schema, *n)).map(|n| number(kind, n)));
            all.extend((kind == "integer").then(|| json!(1.5)));
        }
        "array" => {
            all.extend(schema["minItems"].as_u64().filter(|least| *least > 0).map(|_| json!([])));
            all.extend(
                schema["maxItems"]
                    .as_u64()
                    .and_then(|most| Some(vec![item(schema)?; most as usize + 1].into())),
            );
        }
        _ => {}
    }
    all
}

fn right(field: &Field) -> Vec<Value> {
    let schema = &field.schema;
    let mut all = Vec::new();
    if field.nullable {
        all.push(Value::Null);
    }
    match schema["type"].as_str() {
        Some("string") => all.extend(
            fitting(schema)
                .into_iter()
                .filter(|text| super::values::string(schema, text))
                .map(Value::from),
        ),
        Some(kind @ ("integer" | "number")) => {
            let limits = [
                schema["minimum"].as_f64(),
                schema["maximum"].as_f64().filter(|most| *most < 1e15),
                Some(1.0),
            ];
            all.extend(
                limits
                    .into_iter()
                    .flatten()
                    .filter(|n| within(schema, *n))
                    .map(|n| number(kind, n)),
            );
        }
        Some("boolean") => all.extend([json!(true), json!(false)]),
        _ => {}
    }
    all
}

fn is(kind: &str, value: &Value) -> bool {
    match kind {
        "string" => value.is_string(),
        "integer" | "number" => value.is_number(),
        "boolean" => value.is_boolean(),
        "array" => value.is_array(),
        _ => value.is_object(),
    }
}

fn number(kind: &str, value: f64) -> Value {
    if kind == "integer" && value.abs() < 9e15 { json!(value as i64) } else { json!(value) }
}

/// Returns an entry of a list of texts or numbers.
fn item(schema: &Value) -> Option<Value> {
    match schema["items"]["type"].as_str()? {
        "string" => Some(json!(sample(&schema["items"]))),
        "number" => Some(json!(1.0)),
        _ => None,
    }
}

fn with(base: &Value, at: &[String], value: Value) -> Value {
    let Some((first, rest)) = at.split_first() else { return value };
    if first.parse::<usize>().is_ok() {
        return json!([with(&base[0], rest, value)]);
    }
    let mut changed = if base.is_object() { base.clone() } else { json!({}) };
    changed[first] = with(&base[first], rest, value);
    changed
}

/// Removes a field; missing fields above it are created.
fn without(base: &Value, at: &[String]) -> Value {
    let mut changed = with(base, at, Value::Null);
    let (last, above) = at.split_last().unwrap();
    let pointer: String = above.iter().map(|key| format!("/{key}")).collect();
    if let Some(object) = changed.pointer_mut(&pointer).and_then(Value::as_object_mut) {
        object.remove(last);
    }
    changed
}
