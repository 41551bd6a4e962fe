//! Actions of the pages' forms. Each does the same as the endpoint of the same name.

use axum::extract::State;
use axum::response::Response;
use serde_json::{Value, json};

use super::super::{aliases, diagnoses, refinements};
use super::answer::then;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::field::Remark;
use crate::web::form::PageForm;
use crate::web::{Id, Name, Place, Word};
use sistership_jobs::line::CHAMPION;
use sistership_store::Expect;

/// Queues a refinement, and leads to its job.
pub(super) async fn refine(
    State(app): State<App>,
    Place(ship): Place<Name>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let settings = form.text("method").map_or(json!({}), |method| json!({ "method": method }));
    // Only the fields that are filled in: the endpoint knows the defaults.
    let mut asked = json!({ "ship": &*ship, "settings": settings });
    for name in ["source", "law"] {
        if let Some(text) = form.text(name) {
            asked[name] = Value::from(text);
        }
    }
    Ok(then(&format!("/jobs/{}", refinements::ask(&app, &asked).await?.id)))
}

pub(super) async fn diagnose(
    State(app): State<App>,
    Place(ship): Place<Name>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let asked = json!({ "model": format!("{}/{}", &*ship, form.whole("version")?) });
    Ok(then(&format!("/jobs/{}", diagnoses::ask(&app, &asked).await?.id)))
}

/// Moves the champion if its position is still that which the page showed.
pub(super) async fn promote(
    State(app): State<App>,
    Place(ship): Place<Name>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let expect = match form.text("revision") {
        None => Expect::Absent,
        Some(_) => Expect::Revision(form.whole("revision")?),
    };
    let reason = form.needed("reason")?;
    aliases::move_to(&app, &ship, CHAMPION, form.whole("version")?, expect, reason).await?;
    Ok(then(&format!("/ships/{}", &*ship)))
}

pub(super) async fn note(
    State(app): State<App>,
    Place(ship): Place<Name>,
    PageForm(form): PageForm,
) -> Result<Response> {
    // Forms send ends of lines as two characters (WHATWG, HTML, 4.10.22); the note has one.
    let text = form.needed("text")?.replace("\r\n", "\n").parse::<Remark>();
    let text = text.map_err(|message| Problem::invalid("text", message))?;
    app.store().ships().note(&ship, &text).await?;
    Ok(then(&format!("/ships/{}#notes", &*ship)))
}

pub(super) async fn tag(
    State(app): State<App>,
    Place(ship): Place<Name>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let word = form.needed("tag")?.parse::<Word>();
    let word = word.map_err(|message| Problem::invalid("tag", message))?;
    app.store().ships().tag(&ship, &word).await?;
    Ok(then(&format!("/ships/{}#actions", &*ship)))
}

pub(super) async fn untag(
    State(app): State<App>,
    Place(ship): Place<Name>,
    PageForm(form): PageForm,
) -> Result<Response> {
    app.store().ships().untag(&ship, form.needed("tag")?).await?;
    Ok(then(&format!("/ships/{}#actions", &*ship)))
}

pub(super) async fn cancel(
    State(app): State<App>,
    Place(id): Place<Id>,
    // The form is extracted for the check of its token.
    PageForm(_): PageForm,
) -> Result<Response> {
    Ok(then(&format!("/jobs/{}", app.store().jobs().request_cancel(&id).await?.id)))
}

pub(super) async fn retry(
    State(app): State<App>,
    Place(id): Place<Id>,
    PageForm(_): PageForm,
) -> Result<Response> {
    let job = app.store().jobs().retry(&id).await?;
    app.wake().notify_one();
    Ok(then(&format!("/jobs/{}", job.id)))
}
