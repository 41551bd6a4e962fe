//! The library of effects that this program carries, read once.

use std::sync::{Arc, OnceLock};

use sistership_model::version::sha256;
use sistership_model::{Effect, FileError, Zoo};

/// The effects that a diagnosis knows.
#[derive(Debug)]
pub struct Library {
    /// The effects, by name.
    pub effects: Vec<Arc<Effect>>,
    /// The SHA-256 of their files, one after another by name.
    pub sha256: String,
}

/// The library that this program carries.
///
/// # Errors
/// The file that does not read; a test keeps this from happening in a release.
pub fn library() -> Result<&'static Library, FileError> {
    static LIBRARY: OnceLock<Result<Library, FileError>> = OnceLock::new();
    LIBRARY.get_or_init(|| Ok(of(&Zoo::embedded()?))).as_ref().map_err(FileError::clone)
}

fn of(zoo: &Zoo) -> Library {
    let effects: Vec<Arc<Effect>> = zoo.effects().cloned().collect();
    let texts = effects.iter().filter_map(|effect| zoo.effect_text(&effect.name));
    Library { sha256: sha256(texts.collect::<String>().as_bytes()), effects }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_library_has_the_effects_and_a_hash() {
        let library = library().unwrap();
        assert!(library.effects.iter().any(|effect| effect.name == "current"));
        assert_eq!(library.sha256.len(), 64);
    }
}
