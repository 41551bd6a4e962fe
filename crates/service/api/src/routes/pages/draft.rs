//! Uploads in the browser: files arrive, the proposed reading is reviewed, and the trials are
//! stored.

use std::path::Path;
use std::sync::Arc;

use axum::extract::{Multipart, State};
use axum::response::Response;
use serde::Deserialize;
use sistership_auth::Role;
use sistership_pages::upload::{
    self, FilePreview, RangeRequest, StoredUpload, TemplatePlace, UploadProposal,
};
use sistership_pages::{FormFields, TOKEN_FIELD, say};
use sistership_trials::{
    Exclusion, GivenColumn, ImportTemplate, ManifestFile, ManifestProposal, ProposalRequest,
    propose_files,
};

use super::answer::{page_response, redirect_to};
use crate::app::App;
use crate::problem::{Fault, Problem, Result};
use crate::rights::check_server_role;
use crate::upload::{
    SpooledFile, TrialUpload, find_faults, read_each, read_one, spool_stream, store_upload,
    write_problem,
};
use crate::web::form::{PageForm, check_token, page_shell};
use crate::web::{Id, Name, PathParams, QueryParams};
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
            return Err(Problem::invalid(&name, say("upload-listed-twice")));
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
        false => Err(Problem::invalid("file", say("upload-file-names"))),
    }
}

async fn propose_draft(
    app: &App,
    ship: &str,
    folder: tempfile::TempDir,
    files: Vec<(String, String)>,
) -> Result<UploadDraft> {
    let ManifestProposal { guesses, manifest, .. } =
        identify_files(app, ship, folder.path(), &files, Vec::new()).await?;
    let proposed = UploadProposal {
        ship: ship.to_owned(),
        id: DraftTable::new_id(),
        guesses,
        manifest,
        diagnose: true,
        template: None,
    };
    let draft = UploadDraft { folder, files, proposed: proposed.into() };
    exclude_faults(app, &draft).await?;
    Ok(draft)
}

/// Identifies the columns of files in a folder, of which some may be given.
async fn identify_files(
    app: &App,
    ship: &str,
    folder: &Path,
    files: &[(String, String)],
    given: Vec<GivenColumn>,
) -> Result<ManifestProposal> {
    let paths: Vec<_> = files.iter().map(|(name, _)| folder.join(name)).collect();
    let (ship, folder) = (ship.to_owned(), folder.to_owned());
    let look = move || {
        let files: Vec<&Path> = paths.iter().map(AsRef::as_ref).collect();
        let folder = Some(folder.as_path());
        propose_files(&ProposalRequest { ship: &ship, files: &files, folder, given: &given })
    };
    app.read_files(look).await?.map_err(|errors| {
        let why = say("upload-cannot-read");
        let problem = Problem::new(axum::http::StatusCode::UNPROCESSABLE_ENTITY, why);
        errors.into_iter().fold(problem, |problem, error| {
            let name = error.file.rsplit('/').next().unwrap_or_default().to_owned();
            problem.with_fault(Fault::at_field(name, error.message))
        })
    })
}

/// Excludes the faults of a draft's files in its manifest.
async fn exclude_faults(app: &App, draft: &UploadDraft) -> Result<()> {
    let found = draft_faults(app, draft).await?;
    let mut proposed = draft.current_proposal();
    proposed.manifest.declarations.exclude.extend(found);
    draft.set_proposal(proposed);
    Ok(())
}

/// Returns faults of the values of a draft's files that are not excluded yet.
async fn draft_faults(app: &App, draft: &UploadDraft) -> Result<Vec<Exclusion>> {
    find_faults(&draft_upload(draft, app)?, app).await
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
    app.drafts().get(ship, id).ok_or_else(|| Problem::not_found(say("upload-expired")))
}

pub(super) async fn review_draft(
    State(app): State<App>,
    PathParams((ship, id)): PathParams<(Name, Id)>,
) -> Result<Response> {
    let draft = find_draft(&app, &ship, &id)?;
    let (files, proposal) = (draft_upload(&draft, &app)?, draft.current_proposal());
    let ManifestFile { manifest, declarations, .. } = proposal.manifest.clone();
    let previews = read_each(&files, &app, move |at, read| {
        let file = manifest.trials.get(at).map(|trial| trial.file.as_str());
        let own = declarations.exclude.iter().filter(|one| Some(one.file.as_str()) == file);
        let preview = FilePreview::from_result(read, &own.cloned().collect::<Vec<_>>());
        if at < PLOTTED_FILES { preview } else { preview.without_plots() }
    });
    let previews = previews.await?;
    let templates = app.store().templates().list_for_ship(&ship).await?;
    let page = upload::mapping_page(&page_shell(&app), &proposal, &previews, &templates)?;
    Ok(page_response(page))
}

/// Applies the form: corrections, a range, a template, or the storing of the trials.
pub(super) async fn apply_corrections(
    State(app): State<App>,
    PathParams((ship, id)): PathParams<(Name, Id)>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let draft = find_draft(&app, &ship, &id)?;
    let button = form.get_text("do").unwrap_or_default();
    if button == "use" {
        use_template(&app, &draft, TemplatePlace::from_list(&ship, &form)?).await?;
    } else {
        correct_draft(&app, &draft, &form).await?;
    }
    match button {
        "keep" => return store_draft(&app, &draft, &id).await,
        "save-template" => {
            let place = TemplatePlace::from_name(&ship, &form)?;
            save_template(&app, &draft, &place).await?;
        }
        "remove-template" => {
            let TemplatePlace { ship, name } = TemplatePlace::from_list(&ship, &form)?;
            check_owner(&ship)?;
            app.store().templates().remove(&ship, &name).await?;
        }
        _ => {}
    }
    Ok(redirect_to(&format!("/ships/{}/uploads/{}", &*ship, &*id)))
}

/// Applies the corrections of the form. Faults are sought anew in channels that are read otherwise
/// now.
async fn correct_draft(app: &App, draft: &UploadDraft, form: &FormFields) -> Result<()> {
    let before = draft.current_proposal();
    let mut proposal = upload::correct_proposal(&before, form)?;
    let changed = proposal.changed_channels(&before);
    draft.set_proposal(proposal.clone());
    if !changed.is_empty() {
        proposal.renew_exclusions(&changed, Vec::new());
        draft.set_proposal(proposal.clone());
        proposal.renew_exclusions(&changed, draft_faults(app, draft).await?);
    }
    if let Some(range) = RangeRequest::from_form(&proposal, form)? {
        let trial = read_one(&draft_upload(draft, app)?, app, range.trial).await?;
        range.apply(&mut proposal, &trial)?;
    }
    draft.set_proposal(proposal);
    Ok(())
}

/// Reads a draft's files anew by a template.
async fn use_template(app: &App, draft: &UploadDraft, place: TemplatePlace) -> Result<()> {
    let rows = app.store().templates().list_for_ship(&draft.current_proposal().ship).await?;
    let TemplatePlace { ship, name } = place;
    let row = rows.into_iter().find(|row| row.ship == ship && row.name == name);
    let row = row.ok_or_else(|| Problem::invalid("template", say("templates-removed")))?;
    let template: ImportTemplate =
        serde_json::from_str(&row.document).map_err(Problem::internal)?;
    let given = template.given_columns().map_err(|why| Problem::invalid("template", why))?;
    let before = draft.current_proposal();
    let (folder, files) = (draft.folder.path(), &draft.files);
    let ManifestProposal { guesses, manifest, .. } =
        identify_files(app, &before.ship, folder, files, given).await?;
    draft.set_proposal(UploadProposal { guesses, manifest, template: Some(name), ..before });
    exclude_faults(app, draft).await
}

async fn save_template(app: &App, draft: &UploadDraft, place: &TemplatePlace) -> Result<()> {
    check_owner(&place.ship)?;
    let TemplatePlace { ship, name } = place;
    let mut proposal = draft.current_proposal();
    let document = proposal.template_document(name)?;
    app.store().templates().save(ship, name, &document).await?;
    proposal.template = Some(name.clone());
    draft.set_proposal(proposal);
    Ok(())
}

/// Checks that the caller may change the templates of the server, if the ship is empty.
fn check_owner(ship: &str) -> Result<()> {
    if ship.is_empty() { check_server_role(Role::Engineer) } else { Ok(()) }
}

async fn store_draft(app: &App, draft: &UploadDraft, id: &str) -> Result<Response> {
    let (stored, job) = store_upload(app, draft_upload(draft, app)?).await?;
    app.drafts().remove(id);
    let ship = draft.current_proposal().ship;
    let trials = i64::try_from(stored.len()).map_err(Problem::internal)?;
    let stored = StoredUpload { ship, trials, job: job.map(|job| job.id) };
    Ok(redirect_to(&stored.address()))
}

/// Query of the page after an upload.
#[derive(Debug, Deserialize)]
pub(super) struct StoredQuery {
    trials: i64,
    job: Option<Id>,
}

pub(super) async fn stored_upload(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
    QueryParams(query): QueryParams<StoredQuery>,
) -> Result<Response> {
    let job = query.job.map(|job| job.to_string());
    let stored = StoredUpload { ship: ship.to_string(), trials: query.trials, job };
    Ok(page_response(upload::stored_page(&page_shell(&app), &stored)?))
}
