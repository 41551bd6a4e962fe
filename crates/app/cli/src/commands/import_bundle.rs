//! `sistership import --bundle`: import of a ship from another store.

use std::path::{Path, PathBuf};

use serde::Serialize;
use sistership_jobs::bundle::{Bundle, Taken, VerifyingKey, take, trusted};

use super::export::key;
use super::store::{StoreArguments, with_archive};
use crate::failure::{Failure, about_file};
use crate::output::{self, count};

/// Result of the import, with the signer.
#[derive(Serialize)]
struct Import {
    #[serde(flatten)]
    taken: Taken,
    /// SHA-256 of the key that signed the bundle.
    signed_by: Option<String>,
    /// True if that key was one of the required ones.
    known_signer: bool,
}

/// Imports a bundle into a store.
///
/// # Errors
/// Returns an error if the file is no bundle, is not signed by a required key, or contradicts the
/// store; nothing is written then.
pub fn run(
    path: &Path,
    signed_by: &[PathBuf],
    store: &StoreArguments,
    json: bool,
) -> Result<(), Failure> {
    let keys = signed_by.iter().map(|path| key(path, VerifyingKey::from_pem));
    let keys = keys.collect::<Result<Vec<_>, _>>()?;
    let bytes = std::fs::read(path).map_err(|error| about_file(path, error))?;
    let (bundle, signer) = Bundle::unpacked(&bytes).map_err(|error| about_file(path, error))?;
    trusted(signer.as_ref(), &keys).map_err(|error| about_file(path, error))?;
    let taken = with_archive(store, async |archive| take(archive, &bundle).await)?;
    let signed_by = signer.map(|signer| signer.to_string());
    // With keys given, an unknown signer was refused above.
    let import = Import { taken, signed_by, known_signer: !keys.is_empty() };
    output::print(json, &import, || text(&import))
}

fn text(import: &Import) -> String {
    let Taken { ship, ships, versions, trials, known } = &import.taken;
    let named = |names: &[String]| if names.is_empty() { "none".into() } else { names.join(", ") };
    let signer = match &import.signed_by {
        None => "not signed".to_owned(),
        Some(key) if import.known_signer => format!("signed by {key}"),
        Some(key) => format!("signed by {key}, which no --signed-by has asked for"),
    };
    format!(
        "{ship}, {signer}\n  new ships: {}\n  new versions: {}\n  {} of them there already\n  {}\n",
        named(ships),
        named(versions),
        count(*known, "version"),
        count(*trials, "new trial")
    )
}
