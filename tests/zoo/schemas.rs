//! The JSON Schemas under `models/schema` are those of the types; `UPDATE_SCHEMAS=1` rewrites them.

use std::path::PathBuf;

use schemars::{JsonSchema, schema_for};
use sistership_model::Model;
use sistership_model::effect::EffectFile;
use sistership_model::hybrid::HybridFile;
use sistership_model::law::LawFile;
use sistership_model::vessel::VesselFile;

fn check<T: JsonSchema>(name: &str) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../models/schema")
        .join(format!("{name}.json"));
    let current = serde_json::to_string_pretty(&schema_for!(T)).expect("a schema is JSON") + "\n";
    if std::env::var_os("UPDATE_SCHEMAS").is_some() {
        std::fs::write(&path, &current)
            .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    }
    let stored = std::fs::read_to_string(&path)
        .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert!(
        stored == current,
        "{} is not current: run this test with UPDATE_SCHEMAS=1",
        path.display()
    );
}

#[test]
fn schemas_are_those_of_the_types() {
    check::<LawFile>("law");
    check::<EffectFile>("effect");
    check::<HybridFile>("hybrid");
    check::<VesselFile>("vessel");
    check::<Model>("model");
}
