//! Files of the kind `law`.

use sistership_model::Law;

/// A file that is read once is read twice to the same.
pub fn run(data: &[u8]) {
    let Some(text) = super::text(data) else { return };
    if let Ok(read) = Law::parse("fuzz.yaml", text) {
        assert!(
            Law::parse("fuzz.yaml", text).as_ref() == Ok(&read),
            "read twice to something else"
        );
    }
}
