//! Uploads in the browser: files arrive, the proposed reading is reviewed, and the trials are
//! stored.

use std::path::Path;
use std::sync::Arc;

use axum::extract::{Multipart, State};
use axum::response::Response;
use sistership_pages::upload::{self, FilePreview, UploadProposal};
use sistership_pages::{FormFields, TOKEN_FIELD};
use sistership_trials::propose_manifest;

use super::answer::{page_response, redirect_to};
use crate::app::App;
use crate::problem::{Fault, Problem, Result};
use crate::upload::{
    SpooledFile, TrialUpload, read_each, spool_stream, store_upload, write_problem,
};
use crate::web::form::{PageForm, check_token, page_shell};
use crate::web::{Id, Name, PathParams};
use sistership_web_support::drafts::{DraftTable, UploadDraft};

/// Number of files whose plots are on the page.
const PLOTTED_FILES: usize = 4;

pub(super) async fn choose_files(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
) -> Result<Response> {
    app.store().ships().get(&ship).await?;
    Ok(page_response(upload::choose_page(&page_shell(&app), &ship)?))
}

/// Receives the files, proposes how to read them, and leads to the review.
pub(super) async fn receive_files(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
    mut form: Multipart,
) -> Result<Response> {
    app.store().ships().get(&ship).await?;
    let (mut allowed, mut files) = (false, Vec::new());
    let folder = app.spool().temporary_folder().map_err(write_problem)?;
    while let Some(field) = form.next_field().await? {
        if field.name() == Some(TOKEN_FIELD) {
            let token = field.text().await?;
            check_token(&app, Some(&token))?;
            allowed = true;
            continue;
        }
        // The token precedes the files in the form.
        check_token(&app, None).or_else(|refused| if allowed { Ok(()) } else { Err(refused) })?;
        let name = plain_name(field.file_name().unwrap_or_default())?;
        if files.len() >= app.limits().upload_files || files.iter().any(|(known, _)| *known == name)
        {
            return Err(Problem::invalid(&name, "is listed twice, or there are too many files"));
        }
        let SpooledFile { path, sha256 } = spool_stream(app.spool(), field).await?;
        path.persist(folder.path().join(&name)).map_err(|error| write_problem(error.error))?;
        files.push((name, sha256));
    }
    let draft = propose_draft(&app, &ship, folder, files).await?;
    let id = draft.current_proposal().id;
    app.drafts().insert_draft(id.clone(), draft);
    Ok(redirect_to(&format!("/ships/{}/uploads/{id}", &*ship)))
}

/// Returns the last part of a path, without names that a file in a folder must not have.
fn plain_name(path: &str) -> Result<String> {
    let name = path.rsplit(['/', '\\']).next().unwrap_or_default();
    let plain = !name.is_empty() && name.len() <= 200 && !name.starts_with('.');
    match plain && !name.chars().any(char::is_control) {
        true => Ok(name.to_owned()),
        false => Err(Problem::invalid("file", "choose files with names of 1 to 200 bytes")),
    }
}

async fn propose_draft(
    app: &App,
    ship: &str,
    folder: tempfile::TempDir,
    files: Vec<(String, String)>,
) -> Result<UploadDraft> {
    let paths: Vec<_> = files.iter().map(|(name, _)| folder.path().join(name)).collect();
    let owner = ship.to_owned();
    let look =
        move || propose_manifest(&owner, &paths.iter().map(AsRef::as_ref).collect::<Vec<&Path>>());
    let proposal = app.read_files(look).await?.map_err(|errors| {
        let why = "a file cannot be read; see its errors below";
        let problem = Problem::new(axum::http::StatusCode::UNPROCESSABLE_ENTITY, why);
        errors.into_iter().fold(problem, |problem, error| {
            let name = error.file.rsplit('/').next().unwrap_or_default().to_owned();
            problem.with_fault(Fault::at_field(name, error.message))
        })
    })?;
    let (guesses, manifest) = (proposal.guesses, proposal.manifest);
    let (ship, id) = (ship.to_owned(), DraftTable::new_id());
    let proposed = UploadProposal { ship, id, guesses, manifest, diagnose: true };
    Ok(UploadDraft { folder, files, proposed: proposed.into() })
}

/// Returns a draft's upload as it is read now; its files are hard links to those of the draft.
fn draft_upload(draft: &UploadDraft, app: &App) -> Result<TrialUpload> {
    let UploadProposal { manifest, diagnose, .. } = draft.current_proposal();
    let linked = |(name, sha256): &(String, String)| {
        let path = app.spool().temporary_file().map_err(write_problem)?.into_temp_path();
        std::fs::remove_file(&path).map_err(write_problem)?;
        let from = draft.folder.path().join(name);
        // A file system without hard links gets copies.
        std::fs::hard_link(&from, &path)
            .or_else(|_| std::fs::copy(&from, &path).map(drop))
            .map_err(write_problem)?;
        Ok((name.clone(), SpooledFile { path, sha256: sha256.clone() }))
    };
    let files = draft.files.iter().map(linked).collect::<Result<_>>()?;
    let mut upload = TrialUpload::from_listed(manifest, files)?;
    upload.diagnose = diagnose;
    Ok(upload)
}

fn find_draft(app: &App, ship: &str, id: &str) -> Result<Arc<UploadDraft>> {
    app.drafts().get(ship, id).ok_or_else(|| {
        Problem::not_found("this upload has expired or was stored already; choose the files again")
    })
}

pub(super) async fn review_draft(
    State(app): State<App>,
    PathParams((ship, id)): PathParams<(Name, Id)>,
) -> Result<Response> {
    let draft = find_draft(&app, &ship, &id)?;
    let files = draft_upload(&draft, &app)?;
    let previews = read_each(&files, &app, |at, read| {
        let preview = FilePreview::from_result(read);
        if at < PLOTTED_FILES { preview } else { preview.without_plots() }
    });
    Ok(page_response(upload::mapping_page(
        &page_shell(&app),
        &draft.current_proposal(),
        &previews.await?,
    )?))
}

/// Applies the corrections of the form, and stores the trials if it says so.
pub(super) async fn apply_corrections(
    State(app): State<App>,
    PathParams((ship, id)): PathParams<(Name, Id)>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let draft = find_draft(&app, &ship, &id)?;
    draft.set_proposal(corrected_proposal(&draft.current_proposal(), &form)?);
    if form.get_text("do") != Some("keep") {
        return Ok(redirect_to(&format!("/ships/{}/uploads/{}", &*ship, &*id)));
    }
    let (_, job) = store_upload(&app, draft_upload(&draft, &app)?).await?;
    app.drafts().remove(&id);
    Ok(match job {
        Some(job) => redirect_to(&format!("/jobs/{}", job.id)),
        None => redirect_to(&format!("/ships/{}", &*ship)),
    })
}

fn corrected_proposal(proposed: &UploadProposal, form: &FormFields) -> Result<UploadProposal> {
    let (manifest, diagnose) =
        (upload::correct_manifest(proposed, form)?, form.get_text("diagnose").is_some());
    Ok(UploadProposal { manifest, diagnose, ..proposed.clone() })
}
