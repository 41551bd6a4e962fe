//! Bundle as a file: a ZIP archive with a manifest of the SHA-256 of every file in it, which may be
//! signed.

use std::collections::BTreeMap;
use std::io::{Cursor, Read, Write};

use bytes::Bytes;
use serde::{Deserialize, Serialize};
use sistership_model::version::{code_revision, sha256_hex};
use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

use super::content::{Bundle, BundleContent};
use super::error::BundleError;
use super::signature::{ManifestSignature, SigningKey, VerifyingKey};

/// The format of a bundle.
const FORMAT: &str = "sistership-bundle/1";
const MANIFEST: &str = "manifest.json";
/// Signature of the manifest (64 bytes).
const SIGNATURE: &str = "manifest.sig";
const SIGNER: &str = "signer.der";
const CONTENT: &str = "content.json";
/// Largest bundle after unpacking, bytes: it is in memory as a whole.
const MAX_UNPACKED_BYTES: u64 = 1 << 30;

/// Manifest of a bundle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct BundleManifest {
    format: String,
    ship: String,
    made_by: String,
    /// The SHA-256 of each file.
    files: BTreeMap<String, String>,
}

impl Bundle {
    /// Packs the bundle into a file; the same bundle and key give the same bytes.
    ///
    /// # Errors
    /// Returns an error if the content cannot be serialised or the archive cannot be written.
    pub fn to_bytes(&self, key: Option<&SigningKey>) -> Result<Vec<u8>, BundleError> {
        let content = serde_json::to_vec(&self.content).map_err(file_error)?;
        let mut files = BTreeMap::from([(CONTENT.to_owned(), Bytes::from(content))]);
        let objects = self.objects.iter();
        files.extend(objects.map(|(hash, bytes)| (object_path(hash), bytes.clone())));
        let manifest = BundleManifest {
            format: FORMAT.to_owned(),
            ship: self.content.ship.clone(),
            made_by: code_revision().to_owned(),
            files: files.iter().map(|(name, bytes)| (name.clone(), sha256_hex(bytes))).collect(),
        };
        let manifest = serde_json::to_vec_pretty(&manifest).map_err(file_error)?;
        let signature = key.map(|key| key.sign_manifest(&manifest));
        // The manifest and its signature come first in the archive.
        let first = std::iter::once((MANIFEST.to_owned(), Bytes::from(manifest)));
        let first =
            first.chain(signature.into_iter().flat_map(|ManifestSignature { key, bytes }| {
                let signer = Bytes::copy_from_slice(key.as_der());
                [(SIGNATURE.to_owned(), Bytes::from(bytes)), (SIGNER.to_owned(), signer)]
            }));
        let pack = || -> zip::result::ZipResult<Vec<u8>> {
            let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
            // A fixed time of modification: the bytes must not depend on the time of export.
            let time = zip::DateTime::default();
            let options = SimpleFileOptions::default().last_modified_time(time);
            for (name, bytes) in first.chain(files) {
                writer.start_file(name, options)?;
                writer.write_all(&bytes)?;
            }
            Ok(writer.finish()?.into_inner())
        };
        pack().map_err(file_error)
    }

    /// Reads a file and checks every hash in it, and its signature if there is one; returns the
    /// bundle and the key that signed it.
    ///
    /// # Errors
    /// Returns an error if the file is no bundle, if a part of it differs from its hash in the
    /// manifest, or if the signature is not valid for the manifest.
    pub fn from_bytes(bytes: &[u8]) -> Result<(Self, Option<VerifyingKey>), BundleError> {
        let mut archive = ZipArchive::new(Cursor::new(bytes))
            .map_err(|error| BundleError::File(format!("is not a bundle: {error}")))?;
        let mut left = MAX_UNPACKED_BYTES;
        let manifest = read_entry(&mut archive, MANIFEST, &mut left)?;
        // The signature is checked over the bytes of the manifest, before these are interpreted.
        let signer = verified_signer(&mut archive, &manifest, &mut left)?;
        let manifest: BundleManifest = serde_json::from_slice(&manifest).map_err(file_error)?;
        if manifest.format != FORMAT {
            let found = manifest.format;
            return Err(BundleError::File(format!(
                "has the format `{found}` instead of `{FORMAT}`"
            )));
        }
        let mut files = BTreeMap::new();
        // Files that the manifest does not name are never read.
        for (name, hash) in &manifest.files {
            let bytes = read_entry(&mut archive, name, &mut left)?;
            if sha256_hex(&bytes) != *hash {
                return Err(BundleError::File(format!("{name} differs from the manifest")));
            }
            files.insert(name.clone(), Bytes::from(bytes));
        }
        Ok((Self::from_files(files)?, signer))
    }

    fn from_files(mut files: BTreeMap<String, Bytes>) -> Result<Self, BundleError> {
        let lacking = || BundleError::File(format!("lacks {CONTENT}"));
        let content: BundleContent =
            serde_json::from_slice(&files.remove(CONTENT).ok_or_else(lacking)?)
                .map_err(file_error)?;
        for (line, number, version) in content.versions() {
            if sha256_hex(version.document.as_bytes()) != version.sha256 {
                let message = format!("version {line}/{number} does not have its hash");
                return Err(BundleError::File(message));
            }
        }
        // An object is stored under its own hash, and everything that the content refers to must
        // exist.
        let mut objects = BTreeMap::new();
        for (name, bytes) in files {
            let hash = sha256_hex(&bytes);
            if name != object_path(&hash) {
                return Err(BundleError::File(format!("{name} does not have that hash")));
            }
            objects.insert(hash, bytes);
        }
        let lacks = |what: String| BundleError::File(format!("lacks the {what}"));
        if let Some(trial) = content.trials.iter().find(|one| !objects.contains_key(&one.sha256)) {
            return Err(lacks(format!("samples of {}", trial.name)));
        }
        for (line, number, version) in content.versions() {
            if version.weights.as_ref().is_some_and(|hash| !objects.contains_key(hash)) {
                return Err(lacks(format!("weights of version {line}/{number}")));
            }
        }
        Ok(Self { content, objects })
    }
}

impl BundleContent {
    /// Iterator over every version with its ship and number (from 1).
    pub fn versions(&self) -> impl Iterator<Item = (&str, i64, &super::content::VersionRecord)> {
        self.lines.iter().flat_map(|(line, versions)| {
            (1..).zip(versions).map(move |(number, version)| (line.as_str(), number, version))
        })
    }
}

fn object_path(hash: &str) -> String {
    format!("objects/{hash}")
}

fn file_error(error: impl std::fmt::Display) -> BundleError {
    BundleError::File(error.to_string())
}

/// Returns the key that signed the manifest; `None` for a bundle without signature.
fn verified_signer(
    archive: &mut ZipArchive<Cursor<&[u8]>>,
    manifest: &[u8],
    left: &mut u64,
) -> Result<Option<VerifyingKey>, BundleError> {
    // One of the two files without the other is an error, not an unsigned bundle.
    if ![SIGNATURE, SIGNER].iter().any(|name| archive.index_for_name(name).is_some()) {
        return Ok(None);
    }
    let (bytes, key) = (read_entry(archive, SIGNATURE, left)?, read_entry(archive, SIGNER, left)?);
    let key = VerifyingKey::from_der(&key)
        .ok_or_else(|| BundleError::File(format!("{SIGNER} is not an Ed25519 key")))?;
    let signer = ManifestSignature { key, bytes }.verify_manifest(manifest);
    let forged = || BundleError::File(format!("{SIGNATURE} does not match {MANIFEST}"));
    signer.ok_or_else(forged).map(Some)
}

/// Reads a file of the archive; `left` is the number of bytes that all files together may still
/// take.
fn read_entry(
    archive: &mut ZipArchive<Cursor<&[u8]>>,
    name: &str,
    left: &mut u64,
) -> Result<Vec<u8>, BundleError> {
    let file = archive
        .by_name(name)
        .map_err(|error| BundleError::File(format!("lacks {name}: {error}")))?;
    let mut bytes = Vec::new();
    // One byte more than allowed is read, so that a file above the limit is noticed.
    file.take(*left + 1).read_to_end(&mut bytes).map_err(file_error)?;
    *left = left.checked_sub(bytes.len() as u64).ok_or_else(|| {
        BundleError::File(format!("needs more than {MAX_UNPACKED_BYTES} bytes when unpacked"))
    })?;
    Ok(bytes)
}
