//! Values on both sides of what a schema allows.

use regex::Regex;
use serde_json::Value;

/// Texts that match some pattern.
const SAMPLES: [&str; 10] = [
    "mariner",
    "walked",
    "*",
    "\"1\"",
    "lpp_m:1..2",
    "turn_35.advance_m:..9",
    "IjAi",
    "a",
    "https://example.com/hook",
    "2026-11-29",
];
/// Texts that most patterns refuse.
const ODD: [&str; 9] = ["", " ", "a b", "-", "A", "\u{7}", "é", "a/b/c", "\"\""];

/// Returns texts that a schema refuses.
pub(super) fn unfit(schema: &Value) -> Vec<String> {
    let mut all: Vec<String> = ODD.iter().map(|text| (*text).to_owned()).collect();
    all.extend(["x", "1.5", "0", "-1", "NaN", "maybe", "99999999999999999999"].map(str::to_owned));
    all.extend(schema["minimum"].as_i64().map(|least| (least - 1).to_string()));
    all.extend(schema["maximum"].as_i64().map(|most| (most + 1).to_string()));
    all.extend(schema["maxLength"].as_u64().map(|most| "a".repeat(most as usize + 1)));
    all.retain(|text| !fits(schema, text));
    all
}

/// Returns the longest text that a schema accepts: letters if it has no pattern; passwords must not
/// be guessable.
fn longest(schema: &Value, length: usize) -> String {
    if schema["minLength"].as_u64().is_none_or(|least| least < 12) {
        return "a".repeat(length);
    }
    // Linear congruential generator of Numerical Recipes.
    let next = |last: &u32| Some(last.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    let numbers = std::iter::successors(Some(1_u32), next).take(length);
    numbers.map(|number| char::from(b'a' + ((number >> 24) % 26) as u8)).collect()
}

/// Returns texts that a schema accepts, at its limits if it has some.
pub(super) fn fitting(schema: &Value) -> Vec<String> {
    let mut all: Vec<String> = SAMPLES.iter().map(|text| (*text).to_owned()).collect();
    all.extend(["true", "false", "0.1", "7"].map(str::to_owned));
    all.extend(schema["minimum"].as_i64().map(|least| least.to_string()));
    all.extend(schema["maximum"].as_i64().map(|most| most.to_string()));
    all.extend(schema["maxLength"].as_u64().map(|most| longest(schema, most as usize)));
    all.extend(
        schema["enum"]
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(Value::as_str)
            .map(str::to_owned),
    );
    // A cursor is the one that a page returned, and no other text of its form.
    all.retain(|text| fits(schema, text) && schema["maxLength"] != 4096);
    all
}

/// Returns true if a text in a path, a query or a header satisfies a schema.
pub(super) fn fits(schema: &Value, text: &str) -> bool {
    match schema["type"].as_str() {
        Some("integer") => text.parse::<i64>().is_ok_and(|value| within(schema, value as f64)),
        Some("number") => {
            text.parse::<f64>().is_ok_and(|value| value.is_finite() && within(schema, value))
        }
        Some("boolean") => ["true", "false"].contains(&text),
        Some("array") => fits(&schema["items"], text),
        _ => string(schema, text),
    }
}

/// Returns true if a number is within the limits of a schema.
pub(super) fn within(schema: &Value, value: f64) -> bool {
    let limit = |name: &str| schema[name].as_f64();
    limit("minimum").is_none_or(|least| value >= least)
        && limit("maximum").is_none_or(|most| value <= most)
        && limit("exclusiveMinimum").is_none_or(|least| value > least)
        && schema["not"]["const"].as_f64().is_none_or(|not| value != not)
}

/// Returns true if a text has the length and the form of a schema.
pub(super) fn string(schema: &Value, text: &str) -> bool {
    let length = text.chars().count() as u64;
    schema["minLength"].as_u64().is_none_or(|least| length >= least)
        && schema["maxLength"].as_u64().is_none_or(|most| length <= most)
        && schema["pattern"]
            .as_str()
            .is_none_or(|pattern| Regex::new(pattern).unwrap().is_match(text))
        && schema["enum"].as_array().is_none_or(|known| known.iter().any(|known| known == text))
        && schema["const"].as_str().is_none_or(|known| known == text)
}

/// Returns a text that a schema accepts.
pub(super) fn sample(schema: &Value) -> String {
    let word = schema["enum"][0].as_str().or_else(|| schema["const"].as_str());
    word.map_or_else(
        || SAMPLES.into_iter().find(|text| string(schema, text)).unwrap_or_default().to_owned(),
        str::to_owned,
    )
}
