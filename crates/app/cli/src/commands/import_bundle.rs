//! `sistership import --bundle`: import of a ship from another store.

use std::path::{Path, PathBuf};

use serde::Serialize;
use sistership_jobs::bundle::{Bundle, BundleImport, VerifyingKey, check_signer, import_bundle};

use super::export::read_key;
use super::store::{StoreArguments, with_archive};
use crate::failure::{Failure, about_file};
use crate::output::{self, format_count};

/// Result of the import, with the signer.
#[derive(Serialize)]
struct BundleImportDocument {
    #[serde(flatten)]
    taken: BundleImport,
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
pub fn run_import(
    path: &Path,
    signed_by: &[PathBuf],
    store: &StoreArguments,
    json: bool,
) -> Result<(), Failure> {
    let keys = signed_by.iter().map(|path| read_key(path, VerifyingKey::from_pem));
    let keys = keys.collect::<Result<Vec<_>, _>>()?;
    let bytes = std::fs::read(path).map_err(|error| about_file(path, error))?;
    let (bundle, signer) = Bundle::from_bytes(&bytes).map_err(|error| about_file(path, error))?;
    check_signer(signer.as_ref(), &keys).map_err(|error| about_file(path, error))?;
    let taken = with_archive(store, async |archive| import_bundle(archive, &bundle).await)?;
    let signed_by = signer.map(|signer| signer.to_string());
    // With keys given, an unknown signer was refused above.
    let import = BundleImportDocument { taken, signed_by, known_signer: !keys.is_empty() };
    output::print_result(json, &import, || format_import(&import))
}

fn format_import(import: &BundleImportDocument) -> String {
    let BundleImport { ship, ships, versions, trials, known } = &import.taken;
    let named = |names: &[String]| if names.is_empty() { "none".into() } else { names.join(", ") };
    let signer = match &import.signed_by {
        None => "not signed".to_owned(),
        Some(key) if import.known_signer => format!("signed by {key}"),
        Some(key) => format!("signed by {key} (not checked: give --signed-by)"),
    };
    format!(
        "{ship}, {signer}\n  new ships: {}\n  new versions: {}\n  versions present already: {}\n  \
         {}\n",
        named(ships),
        named(versions),
        format_count(*known, "version"),
        format_count(*trials, "new trial")
    )
}
