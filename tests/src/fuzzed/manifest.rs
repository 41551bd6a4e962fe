//! Manifests of trials.

use sistership_trials::read_manifest_file;

/// A manifest that is read, is written to one that is read to the same.
pub fn run(data: &[u8]) {
    let Some(text) = super::text(data) else { return };
    let Ok(manifest) = read_manifest_file("fuzz.yaml", text) else { return };
    let written = serde_json::to_string(&manifest).expect("a manifest is written");
    let again = read_manifest_file("fuzz.yaml", &written);
    assert!(again.as_ref() == Ok(&manifest), "{again:?}");
}
