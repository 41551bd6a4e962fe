//! Rows for tests.

use sistership_model::version::sha256_hex;
use sistership_store::NewTrial;

/// Returns a trial whose samples are known by its name alone.
pub(crate) fn new_trial(ship: &str, name: &str, manoeuvre: Option<&str>) -> NewTrial {
    let (text, hash) = (|text: &str| text.to_owned(), sha256_hex(name.as_bytes()));
    NewTrial {
        ship: text(ship),
        sha256: hash.clone(),
        name: text(name),
        manifest: text("{}"),
        conventions: text("{}"),
        manoeuvre: manoeuvre.map(text),
        sample_rows: 10,
        duration_s: 1.0,
        warnings: text("[]"),
        object_key: hash,
    }
}
