//! `models/schema/trials.json` is the schema of the type; `UPDATE_SCHEMAS=1` rewrites it.

#![allow(clippy::unwrap_used)]

use std::path::PathBuf;

use sistership_trials::ManifestFile;

#[test]
fn the_schema_of_manifests_is_that_of_the_type() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../models/schema/trials.json");
    let schema = schemars::schema_for!(ManifestFile);
    let current = serde_json::to_string_pretty(&schema).unwrap() + "\n";
    if std::env::var_os("UPDATE_SCHEMAS").is_some() {
        std::fs::write(&path, &current).unwrap();
    }
    let stored = std::fs::read_to_string(&path).unwrap();
    assert!(stored == current, "run this test with UPDATE_SCHEMAS=1");
}
