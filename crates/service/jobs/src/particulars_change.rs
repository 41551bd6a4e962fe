//! Change of single particulars of a ship, with the source of the new values.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};
use sistership_store::Ship;

use crate::archive::parse_vessel;
use crate::error::DeriveError;

/// Key of the source of figures that a person states.
pub const STATED_SOURCE: &str = "typed-in";

/// Particulars of a ship that differ from the present ones.
#[derive(Debug, Clone, PartialEq)]
pub struct ParticularsChange {
    document: Value,
    /// Names of those that are removed.
    removed: Vec<String>,
    /// New values by name.
    changed: BTreeMap<String, f64>,
}

impl ParticularsChange {
    /// Compares values with those of a ship; `None` removes a particular.
    ///
    /// # Errors
    /// Returns an error if the ship's document cannot be read.
    pub fn new(ship: &Ship, values: BTreeMap<String, Option<f64>>) -> Result<Self, DeriveError> {
        let vessel = parse_vessel(&ship.name, &ship.document)?;
        let document = serde_json::from_str(&ship.document)?;
        let mut change = Self { document, removed: Vec::new(), changed: BTreeMap::new() };
        for (name, value) in values {
            let before = vessel.particulars.get(&name).map(|of| of.value);
            match value {
                None => change.removed.push(name),
                // An equal value keeps its source.
                Some(value) if before == Some(value) => {}
                Some(value) => drop(change.changed.insert(name, value)),
            }
        }
        Ok(change)
    }

    /// Returns true if a value is new, so that it needs a source.
    pub fn needs_source(&self) -> bool {
        !self.changed.is_empty()
    }

    /// Returns the document of the ship after the change; new values get the source `citation`.
    pub fn into_document(self, citation: &str) -> Value {
        let Self { mut document, removed, changed } = self;
        if !changed.is_empty() {
            let key = add_source(&mut document, citation);
            for (name, value) in changed {
                document["particulars"]["values"][name] = json!({ "value": value, "source": key });
            }
        }
        let values = document["particulars"]["values"].as_object_mut();
        remove_all(values, &removed);
        document
    }
}

fn remove_all(values: Option<&mut Map<String, Value>>, names: &[String]) {
    if let Some(values) = values {
        values.retain(|name, _| !names.contains(name));
    }
}

/// Adds a source to a document unless it is there, and returns its key.
fn add_source(document: &mut Value, citation: &str) -> String {
    // An earlier source keeps its key, since other values refer to it.
    let keys = (2..).map(|number| format!("{STATED_SOURCE}-{number}"));
    for key in std::iter::once(STATED_SOURCE.to_owned()).chain(keys) {
        match document["sources"][&key]["citation"].as_str() {
            Some(known) if known != citation => {}
            Some(_) => return key,
            None => {
                document["sources"][&key] = json!({ "citation": citation });
                return key;
            }
        }
    }
    STATED_SOURCE.to_owned()
}
