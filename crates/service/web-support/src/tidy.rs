//! What the library that writes the document cannot say, put right in the document as a whole.

use serde_json::{Map, Value, json};

/// Puts right what is known to be written wrongly, wherever it stands.
pub fn tidy(document: &mut Value) {
    match document {
        Value::Object(object) => {
            described(object);
            parameter(object);
            events(object);
            yaml(object);
            if let Some(not) = object.remove("x-not") {
                object.insert("not".to_owned(), not);
            }
            object.values_mut().for_each(tidy);
        }
        Value::Array(items) => items.iter_mut().for_each(tidy),
        _ => {}
    }
}

/// A schema and what is said of the field that has it are one schema, not two that both must hold:
/// the second would be an object.
fn described(object: &mut Map<String, Value>) {
    let Some([Value::Object(schema), Value::Object(about)]) =
        object.get("allOf").and_then(Value::as_array).map(Vec::as_slice)
    else {
        return;
    };
    let only =
        |name: &String| ["description", "type", "deprecated", "example"].contains(&name.as_str());
    if !about.keys().all(only) || about.get("type").is_some_and(|kind| kind != "object") {
        return;
    }
    let (mut merged, mut about) = (schema.clone(), about.clone());
    about.remove("type");
    merged.extend(about);
    object.remove("allOf");
    object.extend(merged);
}

/// A parameter is there or not: none is null.
fn parameter(object: &mut Map<String, Value>) {
    if !object.contains_key("in") || !object.contains_key("name") {
        return;
    }
    let Some(schema) = object.get_mut("schema").and_then(Value::as_object_mut) else { return };
    if let Some(types) = schema.get_mut("type").and_then(Value::as_array_mut) {
        types.retain(|kind| kind != "null");
        if let [only] = types.as_slice() {
            let only = only.clone();
            schema.insert("type".to_owned(), only);
        }
    }
    let of = schema.get("oneOf").and_then(Value::as_array);
    let real = of.and_then(|of| of.iter().find(|kind| kind["type"] != "null").cloned());
    if let Some(real) = real {
        object.insert("schema".to_owned(), real);
    }
}

/// A schema is about what YAML says, not about its text; all documents here are maps.
fn yaml(object: &mut Map<String, Value>) {
    if let Some(media) = object.get_mut("application/yaml").and_then(Value::as_object_mut) {
        media.insert("schema".to_owned(), json!({ "type": "object" }));
    }
}

/// The schema of an event stream is that of one event's data.
fn events(object: &mut Map<String, Value>) {
    let Some(stream) = object.get_mut("text/event-stream").and_then(Value::as_object_mut) else {
        return;
    };
    let Some(data) = stream.remove("schema") else { return };
    let data =
        json!({ "type": "string", "contentMediaType": "application/json", "contentSchema": data });
    let event = json!({ "type": "object", "required": ["event", "data"],
        "properties": { "event": { "type": "string", "const": "job" }, "data": data } });
    stream.insert("x-itemSchema".to_owned(), event);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_of_a_field_is_no_schema_of_its_own() {
        let mut document = json!({ "allOf": [{ "type": "string", "maxLength": 3 },
            { "type": "object", "description": "a" }] });
        tidy(&mut document);
        assert_eq!(document, json!({ "type": "string", "maxLength": 3, "description": "a" }));
        let both = json!({ "allOf": [{ "$ref": "#/a" }, { "type": "object", "properties": { "b": {} } }] });
        let mut kept = both.clone();
        tidy(&mut kept);
        assert_eq!(kept, both);
    }

    #[test]
    fn parameters_are_never_null_and_events_are_described_one_by_one() {
        let mut document = json!({ "parameters": [
            { "in": "query", "name": "a", "schema": { "type": ["string", "null"], "x-not": { "const": "b" } } },
            { "in": "query", "name": "b", "schema": { "oneOf": [{ "type": "null" }, { "type": "integer" }] } },
        ], "content": { "text/event-stream": { "schema": { "type": "object" } } } });
        tidy(&mut document);
        assert_eq!(
            document["parameters"][0]["schema"],
            json!({ "type": "string", "not": { "const": "b" } })
        );
        assert_eq!(document["parameters"][1]["schema"], json!({ "type": "integer" }));
        let stream = &document["content"]["text/event-stream"];
        assert_eq!(
            stream["x-itemSchema"]["properties"]["data"]["contentSchema"],
            json!({ "type": "object" })
        );
    }
}
