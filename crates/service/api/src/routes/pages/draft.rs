//! Uploads in the browser: files arrive, the proposed reading is reviewed, and the trials are
//! stored.

use std::path::Path;
use std::sync::Arc;

use axum::extract::{Multipart, State};
use axum::response::Response;
use sistership_pages::upload::{self, Preview, Proposed};
use sistership_pages::{Fields, TOKEN};
use sistership_trials::propose;

use super::answer::{answer, then};
use crate::app::App;
use crate::problem::{Fault, Problem, Result};
use crate::upload::{Spooled, Upload, each, keep, spool, unwritten};
use crate::web::form::{PageForm, checked, shell};
use crate::web::{Id, Name, Place};
use sistership_web_support::drafts::{Draft, Drafts};

/// Number of files whose plots are on the page.
const PLOTTED: usize = 4;

pub(super) async fn choose(State(app): State<App>, Place(ship): Place<Name>) -> Result<Response> {
    app.store().ships().get(&ship).await?;
    Ok(answer(upload::choose(&shell(&app), &ship)?))
}

/// Receives the files, proposes how to read them, and leads to the review.
pub(super) async fn arrived(
    State(app): State<App>,
    Place(ship): Place<Name>,
    mut form: Multipart,
) -> Result<Response> {
    app.store().ships().get(&ship).await?;
    let (mut allowed, mut files) = (false, Vec::new());
    let folder = app.spool().folder_under_way().map_err(unwritten)?;
    while let Some(field) = form.next_field().await? {
        if field.name() == Some(TOKEN) {
            let token = field.text().await?;
            checked(&app, Some(&token))?;
            allowed = true;
            continue;
        }
        // The token precedes the files in the form.
        checked(&app, None).or_else(|refused| if allowed { Ok(()) } else { Err(refused) })?;
        let name = plain_name(field.file_name().unwrap_or_default())?;
        if files.len() >= app.limits().upload_files || files.iter().any(|(known, _)| *known == name)
        {
            return Err(Problem::invalid(&name, "is there twice, or one file too many"));
        }
        let Spooled { path, sha256 } = spool(app.spool(), field).await?;
        path.persist(folder.path().join(&name)).map_err(|error| unwritten(error.error))?;
        files.push((name, sha256));
    }
    let draft = proposed_for(&app, &ship, folder, files).await?;
    let id = draft.proposed().id;
    app.drafts().put(id.clone(), draft);
    Ok(then(&format!("/ships/{}/uploads/{id}", &*ship)))
}

/// Returns the last part of a path, without names that a file in a folder must not have.
fn plain_name(path: &str) -> Result<String> {
    let name = path.rsplit(['/', '\\']).next().unwrap_or_default();
    let plain = !name.is_empty() && name.len() <= 200 && !name.starts_with('.');
    match plain && !name.chars().any(char::is_control) {
        true => Ok(name.to_owned()),
        false => Err(Problem::invalid("file", "choose files with a name of 1 to 200 bytes")),
    }
}

async fn proposed_for(
    app: &App,
    ship: &str,
    folder: tempfile::TempDir,
    files: Vec<(String, String)>,
) -> Result<Draft> {
    let paths: Vec<_> = files.iter().map(|(name, _)| folder.path().join(name)).collect();
    let owner = ship.to_owned();
    let look = move || propose(&owner, &paths.iter().map(AsRef::as_ref).collect::<Vec<&Path>>());
    let proposal = app.compute(look).await?.map_err(|errors| {
        let why = "a file cannot be read; see below";
        let problem = Problem::new(axum::http::StatusCode::UNPROCESSABLE_ENTITY, why);
        errors.into_iter().fold(problem, |problem, error| {
            let name = error.file.rsplit('/').next().unwrap_or_default().to_owned();
            problem.with(Fault::at(name, error.message))
        })
    })?;
    let (guesses, manifest) = (proposal.guesses, proposal.manifest);
    let (ship, id) = (ship.to_owned(), Drafts::id());
    let proposed = Proposed { ship, id, guesses, manifest, diagnose: true };
    Ok(Draft { folder, files, proposed: proposed.into() })
}

/// Returns a draft's upload as it is read now; its files are hard links to those of the draft.
fn uploaded(draft: &Draft, app: &App) -> Result<Upload> {
    let Proposed { manifest, diagnose, .. } = draft.proposed();
    let linked = |(name, sha256): &(String, String)| {
        let path = app.spool().temporary().map_err(unwritten)?.into_temp_path();
        std::fs::remove_file(&path).map_err(unwritten)?;
        let from = draft.folder.path().join(name);
        // A file system without hard links gets copies.
        std::fs::hard_link(&from, &path)
            .or_else(|_| std::fs::copy(&from, &path).map(drop))
            .map_err(unwritten)?;
        Ok((name.clone(), Spooled { path, sha256: sha256.clone() }))
    };
    let files = draft.files.iter().map(linked).collect::<Result<_>>()?;
    let mut upload = Upload::listed(manifest, files)?;
    upload.diagnose = diagnose;
    Ok(upload)
}

fn found(app: &App, ship: &str, id: &str) -> Result<Arc<Draft>> {
    app.drafts().get(ship, id).ok_or_else(|| {
        Problem::not_found("the upload has waited too long, or was kept; choose the files again")
    })
}

pub(super) async fn shown(
    State(app): State<App>,
    Place((ship, id)): Place<(Name, Id)>,
) -> Result<Response> {
    let draft = found(&app, &ship, &id)?;
    let files = uploaded(&draft, &app)?;
    let previews = each(&files, &app, |at, read| {
        let preview = Preview::of(read);
        if at < PLOTTED { preview } else { preview.without_plots() }
    });
    Ok(answer(upload::mapping(&shell(&app), &draft.proposed(), &previews.await?)?))
}

/// Applies the corrections of the form, and stores the trials if it says so.
pub(super) async fn corrected(
    State(app): State<App>,
    Place((ship, id)): Place<(Name, Id)>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let draft = found(&app, &ship, &id)?;
    draft.set(changed(&draft.proposed(), &form)?);
    if form.text("do") != Some("keep") {
        return Ok(then(&format!("/ships/{}/uploads/{}", &*ship, &*id)));
    }
    let (_, job) = keep(&app, uploaded(&draft, &app)?).await?;
    app.drafts().remove(&id);
    app.wake().notify_one();
    Ok(match job {
        Some(job) => then(&format!("/jobs/{}", job.id)),
        None => then(&format!("/ships/{}", &*ship)),
    })
}

fn changed(proposed: &Proposed, form: &Fields) -> Result<Proposed> {
    let (manifest, diagnose) =
        (upload::corrected(proposed, form)?, form.text("diagnose").is_some());
    Ok(Proposed { manifest, diagnose, ..proposed.clone() })
}
