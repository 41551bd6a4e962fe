//! Actions of the pages' forms. Each does the same as the endpoint of the same name.

use axum::extract::State;
use axum::response::Response;
use serde_json::{Value, json};

use super::super::{aliases, diagnoses, families, refinements};
use super::answer::redirect_to;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::field::Remark;
use crate::web::form::PageForm;
use crate::web::{Id, Name, PathParams, Word};
use sistership_jobs::aliases::CHAMPION;
use sistership_pages::FormFields;
use sistership_store::ExpectedRevision;

/// Queues a refinement, and leads to its job.
pub(super) async fn refine_ship(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let settings = form.get_text("method").map_or(json!({}), |method| json!({ "method": method }));
    // Only the fields that are filled in: the endpoint knows the defaults.
    let mut asked = json!({ "ship": &*ship, "settings": settings });
    for name in ["source", "law"] {
        if let Some(text) = form.get_text(name) {
            asked[name] = Value::from(text);
        }
    }
    Ok(redirect_to(&format!("/jobs/{}", refinements::queue_from_page(&app, &asked).await?.id)))
}

pub(super) async fn diagnose_ship(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let asked = json!({ "model": format!("{}/{}", &*ship, form.whole_number("version")?) });
    Ok(redirect_to(&format!("/jobs/{}", diagnoses::queue_from_page(&app, &asked).await?.id)))
}

/// Moves the champion if its position is still that which the page showed.
pub(super) async fn promote_version(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let expect = match form.get_text("revision") {
        None => ExpectedRevision::Absent,
        Some(_) => ExpectedRevision::Revision(form.whole_number("revision")?),
    };
    let reason = form.required_text("reason")?;
    aliases::move_to(&app, &ship, CHAMPION, form.whole_number("version")?, expect, reason).await?;
    Ok(redirect_to(&format!("/ships/{}", &*ship)))
}

pub(super) async fn add_note(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
    PageForm(form): PageForm,
) -> Result<Response> {
    // Forms send ends of lines as two characters (WHATWG, HTML, 4.10.22); the note has one.
    let text = form.required_text("text")?.replace("\r\n", "\n").parse::<Remark>();
    let text = text.map_err(|message| Problem::invalid("text", message))?;
    app.store().ships().add_note(&ship, &text).await?;
    Ok(redirect_to(&format!("/ships/{}#notes", &*ship)))
}

pub(super) async fn add_tag(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let word = form.required_text("tag")?.parse::<Word>();
    let word = word.map_err(|message| Problem::invalid("tag", message))?;
    app.store().ships().add_tag(&ship, &word).await?;
    Ok(redirect_to(&format!("/ships/{}#actions", &*ship)))
}

pub(super) async fn remove_tag(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
    PageForm(form): PageForm,
) -> Result<Response> {
    app.store().ships().remove_tag(&ship, form.required_text("tag")?).await?;
    Ok(redirect_to(&format!("/ships/{}#actions", &*ship)))
}

pub(super) async fn cancel_job(
    State(app): State<App>,
    PathParams(id): PathParams<Id>,
    // The form is extracted for the check of its token.
    PageForm(_): PageForm,
) -> Result<Response> {
    Ok(redirect_to(&format!("/jobs/{}", app.store().jobs().request_cancel(&id).await?.id)))
}

pub(super) async fn retry_job(
    State(app): State<App>,
    PathParams(id): PathParams<Id>,
    PageForm(_): PageForm,
) -> Result<Response> {
    Ok(redirect_to(&format!("/jobs/{}", app.store().jobs().retry(&id).await?.id)))
}

/// Creates a family with the ships that the form names.
pub(super) async fn create_family(
    State(app): State<App>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let asked = json!({
        "name": form.required_text("name")?,
        "title": form.required_text("title")?,
        "foundation": form.required_text("foundation")?,
        "members": ship_names(&form),
    });
    let family = families::create_from_page(&app, asked).await?;
    Ok(redirect_to(&format!("/families/{}", family.name)))
}

pub(super) async fn add_members(
    State(app): State<App>,
    PathParams(family): PathParams<Word>,
    PageForm(form): PageForm,
) -> Result<Response> {
    form.required_text("members")?;
    app.store().families().add_members(&family, &ship_names(&form)).await?;
    Ok(redirect_to(&format!("/families/{}", &*family)))
}

/// Names of ships, separated by spaces or commas.
fn ship_names(form: &FormFields) -> Vec<String> {
    let text = form.get_text("members").unwrap_or_default();
    let names = text.split([' ', ',', '\n', '\r', '\t']).filter(|name| !name.is_empty());
    names.map(str::to_owned).collect()
}
