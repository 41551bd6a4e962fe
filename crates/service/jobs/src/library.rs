//! Libraries of effects: what a diagnosis knows, and what a calibration is learned with. Each is a
//! document under its hash, the files of its effects one after another, which the store keeps
//! beside those of earlier releases.

use std::sync::{Arc, OnceLock};

use sistership_model::version::sha256;
use sistership_model::{Effect, FileError, Zoo};
use sistership_store::{Store, StoreError};

/// The library that recipes mean which do not name one: that of the releases that made them. It
/// never changes.
pub const FIRST_SHA256: &str = "4ffa596faa665cb151e92fab50bfd47e95ca36c187ac9218ee4a6d1a04b0e769";
const FIRST: &str = include_str!("../../../../models/libraries/first.yaml");
/// The line that the file of each effect begins with.
const BEGIN: &str = "kind: effect";

/// A library of effects.
#[derive(Debug)]
pub struct Library {
    /// The effects, by name.
    pub effects: Vec<Arc<Effect>>,
    /// The SHA-256 of [`Library::document`].
    pub sha256: String,
    /// Their files, one after another by name.
    pub document: String,
}

impl Library {
    /// Reads a library.
    ///
    /// # Errors
    /// The effect that does not read, with its number in the library.
    pub fn parse(document: &str) -> Result<Self, FileError> {
        let hash = sha256(document.as_bytes());
        let read = |(index, text): (usize, String)| {
            Effect::parse(&format!("library of effects {hash}, effect {}", index + 1), &text)
                .map(Arc::new)
        };
        let effects =
            files(document).into_iter().enumerate().map(read).collect::<Result<_, _>>()?;
        Ok(Self { effects, sha256: hash, document: document.to_owned() })
    }
}

/// The files that a document is made of; what comes before the first is part of it.
fn files(document: &str) -> Vec<String> {
    let mut files = vec![String::new()];
    for line in document.split_inclusive('\n') {
        let begun =
            files.last().is_some_and(|file| file.lines().any(|line| line.trim_end() == BEGIN));
        if begun && line.trim_end() == BEGIN {
            files.push(String::new());
        }
        files.last_mut().into_iter().for_each(|file| file.push_str(line));
    }
    files
}

/// The library that this program carries.
///
/// # Errors
/// The file that does not read; a test keeps this from happening in a release.
pub fn library() -> Result<&'static Library, FileError> {
    static LIBRARY: OnceLock<Result<Library, FileError>> = OnceLock::new();
    LIBRARY.get_or_init(|| of(&Zoo::embedded()?)).as_ref().map_err(FileError::clone)
}

fn of(zoo: &Zoo) -> Result<Library, FileError> {
    Library::parse(
        &zoo.effects().filter_map(|effect| zoo.effect_text(&effect.name)).collect::<String>(),
    )
}

/// Puts the libraries that this program carries into a store, beside those that are there.
pub async fn keep(store: &Store) -> Result<(), StoreError> {
    let current = match library() {
        Ok(library) => &library.document,
        Err(error) => {
            return Err(StoreError::Invalid { field: "effects", message: error.to_string() });
        }
    };
    for document in [FIRST, current] {
        store.effects().keep(document).await?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_document_of_the_library_reads_back_as_the_effects_of_the_zoo() {
        let zoo = Zoo::embedded().unwrap();
        assert_eq!(library().unwrap().effects, zoo.effects().cloned().collect::<Vec<_>>());
        assert_eq!(library().unwrap().sha256, sha256(library().unwrap().document.as_bytes()));
    }

    #[test]
    fn the_first_library_is_what_it_was() {
        let first = Library::parse(FIRST).unwrap();
        assert_eq!((first.sha256.as_str(), first.effects.len()), (FIRST_SHA256, 15));
        assert!(first.effects.iter().any(|effect| effect.name == "current"));
    }

    #[test]
    fn the_effect_that_does_not_read_is_named() {
        let error =
            Library::parse(&FIRST.replace("name: wind\n", "nome: wind\n")).unwrap_err().to_string();
        assert!(error.contains("effect 14"), "{error}");
    }
}
