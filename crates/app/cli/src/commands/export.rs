//! `sistership export`: export of a model to another tool, or of a ship to another store.

use std::path::{Path, PathBuf};

use clap::Args;
use sistership_export::ExportSubject;
use sistership_jobs::bundle::{BundleError, SigningKey, collect_bundle};
use sistership_model::version::sha256_hex;
use sistership_model::{Model, Zoo};

use super::store::{StoreArguments, with_archive};
use crate::failure::{Failure, about_file};
use crate::files::OutputFile;
use crate::values::{ExportFormat, export_format};
use crate::{output, resolve};

const EXAMPLES: &str = "\
Examples:
  sistership export mariner --format c --out mariner.c
  cc -DSISTERSHIP_EXAMPLE -O2 mariner.c -lm && ./a.out 35 > turn.csv
  sistership export my-model.yaml --format python --out my_model.py
  sistership export kvlcc2 --format matlab --out kvlcc2_mmg.m
  sistership export kvlcc2 --format fmu2 --out kvlcc2.fmu
  sistership export kvlcc2 --format ssp --out kvlcc2.ssp
  sistership export my-ship --format bundle --sign-key key.pem --data-dir here --out my-ship.bundle
  sistership import --bundle my-ship.bundle --signed-by key.pub.pem --data-dir there

The export contains what `sistership manoeuvre` simulates: the law with the effects and the learned
correction of the model, the steering gear, and a current as an input. An FMU (fmu2, fmu3) runs on
Linux, Windows and macOS without a compiler; coefficients, parameters and particulars are its
parameters. A package of SSP (ssp) holds an FMU with a file of parameter values to vary.

A bundle holds a ship of a store: its versions with all inputs, trials and reports. Another store
imports it with all hashes and the whole lineage.";

/// Export a model to another tool, or a ship to another store.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct ExportArguments {
    /// The model: a name in the zoo, a model file, or a vessel file with a model; of a bundle the
    /// ship in the store.
    model: String,
    /// The format.
    #[arg(long, value_parser = export_format)]
    format: ExportFormat,
    /// The file to write.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Sign a bundle with this Ed25519 key (PEM, as `openssl genpkey -algorithm ed25519` makes it).
    #[arg(long, value_name = "FILE")]
    sign_key: Option<PathBuf>,
    #[command(flatten)]
    store: StoreArguments,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the model cannot be exported, or if the file cannot be written.
pub fn run(zoo: &Zoo, asked: &ExportArguments) -> Result<(), Failure> {
    let format = match asked.format {
        ExportFormat::Bundle => return export_bundle(asked),
        // Refused instead of ignored: the user expects a signed file.
        ExportFormat::Model(_) if asked.sign_key.is_some() => {
            return Err(Failure::Call(
                "--sign-key: only a bundle can be signed; add --format bundle".to_owned(),
            ));
        }
        ExportFormat::Model(format) => format,
    };
    let (model, law) = resolve::resolve_model(zoo, &asked.model)?;
    let file = OutputFile::new(&asked.out, &[PathBuf::from(&asked.model)])?;
    let refused = |error: &dyn std::fmt::Display| Failure::Refused(error.to_string());
    // The hash identifies the model in the exported file; a model outside a store has no version.
    let sha256 = model_hash(&model)?;
    let subject = ExportSubject { model: &model, law: &law, version: None, sha256 };
    let plan = format.prepare(&subject).map_err(|error| refused(&error))?;
    file.write(&format.write(&plan).map_err(|error| refused(&error))?)?;
    output::print_note(&format!("{} as {}: {}", model.name, format.name(), asked.out.display()));
    Ok(())
}

fn export_bundle(asked: &ExportArguments) -> Result<(), Failure> {
    let file = OutputFile::new(&asked.out, &[])?;
    let ship = &asked.model;
    let key =
        asked.sign_key.as_deref().map(|path| read_key(path, SigningKey::from_pem)).transpose()?;
    let bytes = with_archive(&asked.store, async |archive| {
        collect_bundle(archive, ship).await?.to_bytes(key.as_ref())
    })?;
    file.write(&bytes)?;
    let by = key.map_or_else(String::new, |key| format!(", signed by {}", key.verifying_key()));
    output::print_note(&format!("{ship} with all versions: {}{by}", asked.out.display()));
    Ok(())
}

/// Reads a key from a PEM file.
pub(super) fn read_key<T>(
    path: &Path,
    from_pem: fn(&[u8]) -> Result<T, BundleError>,
) -> Result<T, Failure> {
    let text = std::fs::read(path).map_err(|error| about_file(path, error))?;
    from_pem(&text).map_err(|error| about_file(path, error))
}

/// Returns the SHA-256 of the model's document, as JSON without spaces.
fn model_hash(model: &Model) -> Result<String, Failure> {
    let document = serde_json::to_vec(model)
        .map_err(|error| Failure::Refused(format!("{}: {error}", model.name)))?;
    Ok(sha256_hex(&document))
}
