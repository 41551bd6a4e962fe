//! Corrections of the OpenAPI document that the library which writes it cannot express.

use serde_json::{Map, Value, json};

/// Applies all corrections to the document.
pub fn tidy_document(document: &mut Value) {
    match document {
        Value::Object(object) => {
            merge_description(object);
            remove_null(object);
            set_event_schema(object);
            set_yaml_schema(object);
            // The library has no keyword `not`; types write it as an extension.
            if let Some(not) = object.remove("x-not") {
                object.insert("not".to_owned(), not);
            }
            object.values_mut().for_each(tidy_document);
        }
        Value::Array(items) => items.iter_mut().for_each(tidy_document),
        _ => {}
    }
}

/// Merges a schema and the description of its field into one schema: the library writes two that
/// both must hold, and the second would be an object.
fn merge_description(object: &mut Map<String, Value>) {
    let Some([Value::Object(schema), Value::Object(about)]) =
        object.get("allOf").and_then(Value::as_array).map(Vec::as_slice)
    else {
        return;
    };
    let only =
        |name: &String| ["description", "type", "deprecated", "example"].contains(&name.as_str());
    // Two schemas that both have rules are left alone.
    if !about.keys().all(only) || about.get("type").is_some_and(|kind| kind != "object") {
        return;
    }
    let (mut merged, mut about) = (schema.clone(), about.clone());
    about.remove("type");
    merged.extend(about);
    object.remove("allOf");
    object.extend(merged);
}

/// Removes null from the types of parameters: a parameter is present or absent, never null.
fn remove_null(object: &mut Map<String, Value>) {
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

/// Sets the schema of YAML bodies to an object: the schema describes the content, not the text, and
/// all documents here are maps.
fn set_yaml_schema(object: &mut Map<String, Value>) {
    if let Some(media) = object.get_mut("application/yaml").and_then(Value::as_object_mut) {
        media.insert("schema".to_owned(), json!({ "type": "object" }));
    }
}

/// Sets the schema of an event stream to that of the data of one event.
fn set_event_schema(object: &mut Map<String, Value>) {
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
        tidy_document(&mut document);
        assert_eq!(document, json!({ "type": "string", "maxLength": 3, "description": "a" }));
        let both = json!({ "allOf": [{ "$ref": "#/a" }, { "type": "object", "properties": { "b": {} } }] });
        let mut kept = both.clone();
        tidy_document(&mut kept);
        assert_eq!(kept, both);
    }

    #[test]
    fn parameters_are_never_null_and_events_are_described_one_by_one() {
        let mut document = json!({ "parameters": [
            { "in": "query", "name": "a", "schema": { "type": ["string", "null"], "x-not": { "const": "b" } } },
            { "in": "query", "name": "b", "schema": { "oneOf": [{ "type": "null" }, { "type": "integer" }] } },
        ], "content": { "text/event-stream": { "schema": { "type": "object" } } } });
        tidy_document(&mut document);
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
