//! What people state about ships, trials and versions in forms: particulars, conditions of trials,
//! and signatures under the acceptance summary.

use axum::extract::State;
use axum::response::Response;
use serde_json::json;
use sistership_pages::{FormFields, conditions, page_beginning, particulars, say, version};

use super::super::ship_changes::store_particulars;
use super::super::signatures::{self, SignatureRequest};
use super::answer::{page_response, redirect_to, stream_page};
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::form::{PageForm, page_shell};
use crate::web::{Name, Number, PathParams, QueryParams};

pub(super) async fn particulars_form(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
) -> Result<Response> {
    let ship = app.store().ships().get(&ship).await?;
    Ok(page_response(particulars::particulars_page(page_shell(&app), &ship)?))
}

/// Changes the particulars if the ship is as the page showed it.
pub(super) async fn change_particulars(
    State(app): State<App>,
    PathParams(name): PathParams<Name>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let ship = app.store().ships().get(&name).await?;
    let document = particulars::changed_document(&ship, &form)?;
    store_particulars(&app, document, form.whole_number("revision")?).await?;
    Ok(redirect_to(&format!("/ships/{}#particulars", &*name)))
}

pub(super) async fn conditions_form(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
    QueryParams(query): QueryParams<Vec<(String, String)>>,
) -> Result<Response> {
    let (shell, query) = (page_shell(&app), FormFields::from(query));
    let page = conditions::conditions_page(app.archive(), shell, &ship, &query).await?;
    Ok(page_response(page))
}

/// States the conditions of the chosen trials, and leads back to the summary that asked for them.
pub(super) async fn state_conditions(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let trials: Vec<String> = form.get_texts("trial").map(str::to_owned).collect();
    if trials.is_empty() {
        return Err(Problem::invalid("trial", say("conditions-choose-trials")));
    }
    let stated = conditions::read_conditions(&form)?;
    app.store().trials().state_conditions(&ship, &trials, &stated).await?;
    let ship = &*ship;
    Ok(redirect_to(&match form.get_text("version") {
        Some(_) => {
            format!("/ships/{ship}/versions/{}/acceptance", form.whole_number("version")?)
        }
        None => format!("/ships/{ship}#trials"),
    }))
}

pub(super) async fn summary_page(
    State(app): State<App>,
    PathParams((ship, number)): PathParams<(Name, Number)>,
) -> Result<Response> {
    let gathered =
        version::acceptance::gather_summary(app.archive(), page_shell(&app), &ship, number.get())
            .await?;
    let (known, title) = (app.known_manoeuvres(), format!("{}/{}", &*ship, number.get()));
    let beginning = page_beginning(page_shell(&app), &title, "/")?;
    let page = async move { Ok(app.run_blocking(move || gathered.render_html(&known)).await??) };
    Ok(stream_page(beginning, page))
}

/// Signs the summary of a version.
pub(super) async fn sign_version(
    State(app): State<App>,
    PathParams((ship, number)): PathParams<(Name, Number)>,
    PageForm(form): PageForm,
) -> Result<Response> {
    let asked =
        json!({ "role": form.required_text("role")?, "person": form.required_text("person")? });
    let asked: SignatureRequest =
        serde_json::from_value(asked).map_err(|why| Problem::invalid("form", why.to_string()))?;
    signatures::sign_version(&app, &ship, number.get(), &asked).await?;
    Ok(redirect_to(&format!("/ships/{}/versions/{}/acceptance", &*ship, number.get())))
}
