//! Values that follow a schema, and values that follow none.

use proptest::prelude::*;
use proptest::strategy::ValueTree as _;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use rand::SeedableRng as _;
use rand_chacha::ChaCha12Rng;
use serde_json::{Value, json};

use super::contract::Contract;

/// How deep values of recursive schemas go.
const DEPTH: usize = 8;
/// Names that exist on the server.
const NAMES: &[&str] =
    &["target", "mariner", "kvlcc2", "sr108", "polynomial", "champion", "latest", "1", "one.csv"];

/// A seeded source of requests.
pub struct Grammar {
    pub(super) contract: Contract,
    pub(super) rng: ChaCha12Rng,
    runner: TestRunner,
    values: BoxedStrategy<Value>,
}

impl Grammar {
    /// By a seed.
    pub fn new(seed: u64, contract: Contract) -> Self {
        let mut bytes = [0; 32];
        bytes[..8].copy_from_slice(&seed.to_le_bytes());
        let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &bytes);
        let runner = TestRunner::new_with_rng(
            Config { failure_persistence: None, ..Config::default() },
            rng,
        );
        Self { contract, rng: ChaCha12Rng::seed_from_u64(seed), runner, values: values() }
    }

    /// How many routes there are.
    pub fn routes(&self) -> usize {
        self.contract.routes.len()
    }

    /// True so often.
    pub(super) fn chance(&mut self, probability: f64) -> bool {
        self.rng.random_bool(probability)
    }

    /// One of some.
    pub(super) fn pick<'a, T: ?Sized>(&mut self, of: &[&'a T]) -> &'a T {
        of[self.rng.random_range(0..of.len())]
    }

    /// A size between 1 and `most`, as likely from 1 to 10 as from 1,000 to 10,000.
    pub(super) fn size(&mut self, most: usize) -> usize {
        self.rng.random_range(0.0..(most as f64).ln()).exp() as usize
    }

    /// Any value of JSON.
    pub(super) fn value(&mut self) -> Value {
        self.values.new_tree(&mut self.runner).map_or(Value::Null, |tree| tree.current())
    }

    /// A value that follows a schema, more or less.
    pub(super) fn instance(&mut self, schema: &Value, depth: usize) -> Value {
        let schema = self.contract.resolve(schema).clone();
        for choice in ["oneOf", "anyOf", "allOf"] {
            if let Some(choices) = schema[choice].as_array().filter(|choices| !choices.is_empty()) {
                let place = self.rng.random_range(0..choices.len());
                return self.instance(&choices[place], depth);
            }
        }
        if let Some(allowed) = schema["enum"].as_array().filter(|allowed| !allowed.is_empty()) {
            return allowed[self.rng.random_range(0..allowed.len())].clone();
        }
        let kind = match &schema["type"] {
            Value::Array(kinds) => kinds[self.rng.random_range(0..kinds.len())].clone(),
            kind => kind.clone(),
        };
        match kind.as_str() {
            Some("object") => self.object(&schema, depth),
            Some("array") if depth < DEPTH => (0..self.rng.random_range(0..4))
                .map(|_| self.instance(&schema["items"], depth + 1))
                .collect(),
            Some("array") => json!([]),
            Some("integer") => json!(self.rng.random_range(-1..4)),
            Some("number") => json!(self.rng.random_range(-1.0..30.0)),
            Some("boolean") => json!(self.chance(0.5)),
            Some("string") => json!(self.pick(NAMES)),
            _ => Value::Null,
        }
    }

    fn object(&mut self, schema: &Value, depth: usize) -> Value {
        let mut object = serde_json::Map::new();
        let Some(properties) = schema["properties"].as_object().filter(|_| depth < DEPTH) else {
            return self.value();
        };
        for (name, property) in properties {
            let required =
                schema["required"].as_array().is_some_and(|names| names.contains(&json!(name)));
            if required || self.chance(0.5) {
                object.insert(name.clone(), self.instance(property, depth + 1));
            }
        }
        Value::Object(object)
    }

    /// Puts something else in the place of some part of a value.
    pub(super) fn spoil(&mut self, value: &mut Value) {
        let more = self.value();
        match value {
            Value::Object(object) if !object.is_empty() && self.chance(0.8) => {
                let place = self.rng.random_range(0..object.len());
                match self.rng.random_range(0..8) {
                    0 => {
                        let name = object.keys().nth(place).cloned().unwrap_or_default();
                        object.remove(&name);
                    }
                    1 => {
                        object.insert(self.text(), more);
                    }
                    _ => {
                        object.values_mut().nth(place).into_iter().for_each(|part| self.spoil(part))
                    }
                }
            }
            Value::Array(items) if !items.is_empty() && self.chance(0.8) => {
                let place = self.rng.random_range(0..items.len());
                match self.rng.random_range(0..6) {
                    0 => items.resize(self.size(5000), more),
                    _ => self.spoil(&mut items[place]),
                }
            }
            part => *part = more,
        }
    }

    /// A hostile text.
    pub(super) fn text(&mut self) -> String {
        let length = self.size(20_000);
        match self.rng.random_range(0..10) {
            0 => "a".repeat(length),
            1 => "\0".to_owned(),
            2 => "../../../../etc/passwd".to_owned(),
            3 => "'; DROP TABLE ships; --".to_owned(),
            4 => "é\u{202e}\u{feff}𝔘".repeat(length.min(50)),
            5 => String::new(),
            6 => "%00%ff%2e%2e%2f".to_owned(),
            7 => "9".repeat(length.min(400)),
            8 => "<script>alert(1)</script>".to_owned(),
            _ => self.pick(NAMES).to_owned(),
        }
    }
}

/// Values of JSON as proptest makes them: numbers of every size, texts of every character, some
/// depth.
fn values() -> BoxedStrategy<Value> {
    let leaf = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<i64>().prop_map(Value::from),
        any::<u64>().prop_map(Value::from),
        any::<f64>().prop_map(Value::from),
        prop::sample::select(vec![0.0, -0.0, 1e308, -1e308, 5e-324, 1e-300, 9007199254740993.0])
            .prop_map(Value::from),
        ".{0,40}".prop_map(Value::from),
        prop::sample::select(vec!["NaN", "Infinity", "-1", "1e999", "\u{0}", "null", "2026-02-30"])
            .prop_map(Value::from),
    ];
    let deeper = leaf.prop_recursive(6, 60, 6, |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..6).prop_map(Value::Array),
            prop::collection::btree_map("[a-z_]{0,8}", inner, 0..6)
                .prop_map(|map| Value::Object(map.into_iter().collect())),
        ]
    });
    deeper.boxed()
}
