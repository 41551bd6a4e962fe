//! Files of the kind `effect`.

use sistership_model::Effect;

/// A file that is read once is read twice to the same.
pub fn run(data: &[u8]) {
    let Some(text) = super::text(data) else { return };
    if let Ok(read) = Effect::parse("fuzz.yaml", text) {
        assert!(
            Effect::parse("fuzz.yaml", text).as_ref() == Ok(&read),
            "read twice to something else"
        );
    }
}
