//! Uploads of a manifest and its files as the parts of a form.

use axum::extract::multipart::{Field, Multipart};
use axum::extract::{FromRequest as _, Request};
use axum::http::StatusCode;
use sistership_model::manifest::ManifestTrial;
use sistership_trials::{ManifestFile, read_manifest_file};

use super::place::UploadPlace;
use super::received::{TrialUpload, canonical_manifest};
use crate::payload::reserve_yaml_memory;
use crate::problem::{Fault, Problem, Result};
use crate::spool::{SpooledFile, spool_stream};
use sistership_jobs::budget;

/// Received parts of a form.
#[derive(Default)]
struct FormParts {
    manifest: Option<String>,
    ship: Option<String>,
    files: Vec<FormPart>,
}

struct FormPart {
    field: String,
    name: String,
    file: SpooledFile,
}

pub(super) async fn receive_form(request: Request, place: &UploadPlace) -> Result<TrialUpload> {
    let form = Multipart::from_request(request, &()).await;
    let mut form = form.map_err(|error| {
        Problem::bad_request(format!("the form cannot be read: {}", error.body_text()))
    })?;
    let mut parts = FormParts::default();
    while let Some(field) = form.next_field().await? {
        parts.take_field(field, place).await?;
    }
    // Either a manifest that names the ship, or the name of the ship and files with canonical
    // columns.
    match (parts.manifest.take(), parts.ship.take()) {
        (Some(manifest), None) => {
            let manifest = parse_manifest(&manifest).await?;
            if manifest.manifest.ship.is_empty() {
                let message = "the manifest has no ship; add `ship:`";
                return Err(Problem::invalid("manifest", message));
            }
            parts.match_manifest(manifest)
        }
        (None, Some(ship)) => parts.into_canonical(ship),
        (Some(_), Some(_)) => {
            Err(Problem::invalid("ship", "the manifest has the ship already; omit the part `ship`"))
        }
        (None, None) => Err(Problem::invalid(
            "manifest",
            "send a part `manifest` (YAML), or a part `ship` for files with canonical columns",
        )),
    }
}

async fn parse_manifest(manifest: &str) -> Result<ManifestFile> {
    reserve_yaml_memory(manifest.len()).await?;
    Ok(read_manifest_file("manifest", manifest)?)
}

impl TrialUpload {
    /// Creates an upload from files by name and the manifest that lists them.
    ///
    /// # Errors
    /// Returns an error if a file is missing, or is not listed.
    pub fn from_listed(manifest: ManifestFile, files: Vec<(String, SpooledFile)>) -> Result<Self> {
        let part =
            |(name, file): (String, SpooledFile)| FormPart { field: name.clone(), name, file };
        let files = files.into_iter().map(part).collect();
        FormParts { files, ..FormParts::default() }.match_manifest(manifest)
    }
}

impl FormParts {
    async fn take_field(&mut self, field: Field<'_>, place: &UploadPlace) -> Result<()> {
        let name = field.name().unwrap_or_default().to_owned();
        match (name.as_str(), field.file_name().map(str::to_owned)) {
            ("manifest", _) => {
                set_once(&mut self.manifest, "manifest", read_text(field, place).await?)
            }
            ("ship", None) => {
                set_once(&mut self.ship, "ship", read_text(field, place).await?.trim().to_owned())
            }
            (_, Some(file_name)) => self.take_file(name, file_name, field, place).await,
            (other, None) => Err(Problem::invalid(
                other,
                "is not a part of this form: send `manifest`, `ship`, and files with a filename",
            )),
        }
    }

    async fn take_file(
        &mut self,
        field: String,
        name: String,
        content: Field<'_>,
        place: &UploadPlace,
    ) -> Result<()> {
        let most = place.files;
        if self.files.len() >= most {
            return Err(Problem::new(
                StatusCode::PAYLOAD_TOO_LARGE,
                format!("an upload has at most {most} files; send several uploads"),
            ));
        }
        self.files.push(FormPart { field, name, file: spool_stream(&place.spool, content).await? });
        Ok(())
    }

    /// Matches the files with the manifest; each listed file must be present, and no other.
    fn match_manifest(mut self, manifest: ManifestFile) -> Result<TrialUpload> {
        let (mut files, mut names, mut places) = (Vec::new(), Vec::new(), Vec::new());
        // Several trials may share a file; the index refers to `files` of the upload.
        let mut place = |parts: &mut Self, field: String, name: &str| -> Result<usize> {
            if let Some(known) = names.iter().position(|known| known == name) {
                return Ok(known);
            }
            let found = parts.find_file(name).ok_or_else(|| parts.missing_file(field, name))?;
            files.push(parts.files.swap_remove(found).file);
            names.push(name.to_owned());
            Ok(files.len() - 1)
        };
        for (index, trial) in manifest.manifest.trials.iter().enumerate() {
            let main = place(&mut self, format!("trials[{index}].file"), trial.file_path())?;
            let sensors = manifest.sensors[index].iter().enumerate().map(|(at, sensor)| {
                let field = format!("trials[{index}].sensors[{at}].file");
                place(&mut self, field, sensor.file_path())
            });
            places.push((main, sensors.collect::<Result<_>>()?));
        }
        // Matched files were taken out of the list; a file that is left was not listed.
        match self.files.first() {
            Some(extra) => Err(Problem::invalid(
                &extra.name,
                "is not listed under `trials` of the manifest; list it or do not send it",
            )),
            None => Ok(TrialUpload { manifest, diagnose: true, files, places }),
        }
    }

    /// Finds a file by its whole path, else by its name alone if it is unique: many programs send
    /// no more than the name.
    fn find_file(&self, path: &str) -> Option<usize> {
        let exact = self.files.iter().position(|part| part.name == path || part.field == path);
        let base = |path: &str| path.rsplit('/').next().map(str::to_owned);
        let mut alike = self
            .files
            .iter()
            .enumerate()
            .filter(|(_, part)| base(&part.name) == base(path))
            .map(|(index, _)| index);
        exact.or_else(|| alike.next().filter(|_| alike.next().is_none()))
    }

    fn missing_file(&self, field: String, path: &str) -> Problem {
        let sent: Vec<&str> = self.files.iter().map(|part| part.name.as_str()).collect();
        let sent = if sent.is_empty() {
            "no unlisted file was sent".to_owned()
        } else {
            format!("unlisted files are {}", sent.join(", "))
        };
        let message = format!("the manifest lists `{path}`, but no part has that filename; {sent}");
        Problem::new(StatusCode::UNPROCESSABLE_ENTITY, message.clone())
            .with_fault(Fault::at_field(field, message))
    }

    fn into_canonical(self, ship: String) -> Result<TrialUpload> {
        if self.files.is_empty() {
            return Err(Problem::invalid("file", "send at least one part with a filename"));
        }
        let trial = |part: &FormPart| ManifestTrial::from_file_name(part.name.clone());
        let manifest = canonical_manifest(ship, self.files.iter().map(trial).collect())?;
        Ok(TrialUpload::from_files(
            manifest.into(),
            true,
            self.files.into_iter().map(|part| part.file).collect(),
        ))
    }
}

fn set_once(place: &mut Option<String>, name: &str, text: String) -> Result<()> {
    match place.replace(text) {
        Some(_) => Err(Problem::invalid(name, "was sent twice; send it once")),
        None => Ok(()),
    }
}

/// Reads a part that is a short text.
async fn read_text(mut field: Field<'_>, place: &UploadPlace) -> Result<String> {
    let mut bytes = Vec::new();
    while let Some(chunk) = field.chunk().await? {
        // Twice the size, because the buffer grows by doubling.
        budget::reserve_for_request(2 * chunk.len() as u64).await?;
        bytes.extend_from_slice(&chunk);
        if bytes.len() > place.yaml_bytes {
            return Err(Problem::new(
                StatusCode::PAYLOAD_TOO_LARGE,
                "the manifest is too large; send several uploads",
            ));
        }
    }
    String::from_utf8(bytes)
        .map_err(|error| Problem::bad_request(format!("a part is not UTF-8: {error}")))
}
