//! Libraries of effects: the effects that a diagnosis tests and that a calibration uses. A library
//! is one document, the files of its effects one after another, stored under its hash. The store
//! keeps the libraries that recipes name.

use std::sync::{Arc, OnceLock};

use sistership_model::version::sha256_hex;
use sistership_model::{Effect, FileError, Zoo};
use sistership_store::{Store, StoreError};

/// First line of the file of each effect.
const FIRST_LINE: &str = "kind: effect";

/// A library of effects.
#[derive(Debug)]
pub struct EffectLibrary {
    /// The effects, by name.
    pub effects: Vec<Arc<Effect>>,
    /// The SHA-256 of `document`.
    pub sha256: String,
    /// Their files, one after another, sorted by name.
    pub document: String,
}

impl EffectLibrary {
    /// Parses a library.
    ///
    /// # Errors
    /// Returns an error that names the effect that cannot be parsed, by its number in the library.
    pub fn parse(document: &str) -> Result<Self, FileError> {
        let hash = sha256_hex(document.as_bytes());
        let read = |(index, text): (usize, String)| {
            Effect::parse(&format!("library of effects {hash}, effect {}", index + 1), &text)
                .map(Arc::new)
        };
        let effects =
            split_files(document).into_iter().enumerate().map(read).collect::<Result<_, _>>()?;
        Ok(Self { effects, sha256: hash, document: document.to_owned() })
    }
}

/// Splits a document into its files; text before the first `kind:` line belongs to the first file.
fn split_files(document: &str) -> Vec<String> {
    let mut files = vec![String::new()];
    for line in document.split_inclusive('\n') {
        // Text before the first `kind: effect` line must not become a file of its own.
        let begun =
            files.last().is_some_and(|file| file.lines().any(|line| line.trim_end() == FIRST_LINE));
        if begun && line.trim_end() == FIRST_LINE {
            files.push(String::new());
        }
        files.last_mut().into_iter().for_each(|file| file.push_str(line));
    }
    files
}

/// Returns the library that is embedded in this program.
///
/// # Errors
/// Returns an error if a file cannot be parsed, which a test rules out for releases.
pub fn embedded_library() -> Result<&'static EffectLibrary, FileError> {
    static LIBRARY: OnceLock<Result<EffectLibrary, FileError>> = OnceLock::new();
    LIBRARY
        .get_or_init(|| parse_embedded(&Zoo::load_embedded()?))
        .as_ref()
        .map_err(FileError::clone)
}

fn parse_embedded(zoo: &Zoo) -> Result<EffectLibrary, FileError> {
    EffectLibrary::parse(
        &zoo.effects().filter_map(|effect| zoo.effect_text(&effect.name)).collect::<String>(),
    )
}

/// Stores the library that is embedded in this program, in addition to existing ones.
pub async fn store_library(store: &Store) -> Result<(), StoreError> {
    let library = embedded_library()
        .map_err(|error| StoreError::Invalid { field: "effects", message: error.to_string() })?;
    store.effect_libraries().insert_absent(&library.document).await.map(drop)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_document_of_the_library_reads_back_as_the_effects_of_the_zoo() {
        let zoo = Zoo::load_embedded().unwrap();
        assert_eq!(embedded_library().unwrap().effects, zoo.effects().cloned().collect::<Vec<_>>());
        assert_eq!(
            embedded_library().unwrap().sha256,
            sha256_hex(embedded_library().unwrap().document.as_bytes())
        );
    }

    #[test]
    fn the_effect_that_does_not_read_is_named() {
        let library = embedded_library().unwrap();
        let place = library.effects.iter().position(|effect| effect.name == "wind").unwrap();
        let damaged = library.document.replace("name: wind\n", "nome: wind\n");
        let error = EffectLibrary::parse(&damaged).unwrap_err().to_string();
        assert!(error.contains(&format!("effect {}", place + 1)), "{error}");
    }
}
