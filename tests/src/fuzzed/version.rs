//! Version documents.

use sistership_jobs::version::VersionDocument;

/// What a document is written to, is read to the same document and written to the same bytes.
pub fn run(data: &[u8]) {
    let Ok(document) = serde_json::from_slice::<VersionDocument>(data) else { return };
    let Ok(written) = document.to_canonical_json() else { return };
    let again: VersionDocument = serde_json::from_str(&written).expect("what is written is read");
    assert_eq!(again.to_canonical_json().ok(), Some(written), "other bytes the second time");
}
