//! Forms of pages: their fields, and the token which proves that this server wrote them.

use axum::Form;
use axum::extract::{FromRequest, Request};
use axum::http::StatusCode;
use sistership_auth::same;
use sistership_pages::{Fields, Shell, SignedIn, TOKEN};

use crate::app::App;
use crate::problem::{Problem, Result};
use crate::rights::{Kind, current};

/// Fields of a page's form whose token is valid.
pub(crate) struct PageForm(pub Fields);

impl FromRequest<App> for PageForm {
    type Rejection = Problem;

    async fn from_request(request: Request, app: &App) -> Result<Self> {
        let form = Form::<Vec<(String, String)>>::from_request(request, app).await;
        let Form(pairs) = form.map_err(|error| Problem::new(error.status(), error.body_text()))?;
        let fields = Fields::from(pairs);
        checked(app, fields.text(TOKEN))?;
        Ok(Self(fields))
    }
}

/// Token of the current forms: that of the session, otherwise that of the server.
fn token(app: &App) -> String {
    match current().map(|acting| acting.principal.kind.clone()) {
        Some(Kind::Session { form_token, .. }) => form_token,
        _ => app.form_token().text().to_owned(),
    }
}

/// Checks that the token is the one that the pages of this server carry.
///
/// # Errors
/// Returns 403 if it is another one or missing.
pub(crate) fn checked(app: &App, presented: Option<&str>) -> Result<()> {
    let known = token(app);
    // Compared in constant time, so that the token cannot be guessed byte by byte.
    match presented.is_some_and(|presented| same(presented.as_bytes(), known.as_bytes())) {
        true => Ok(()),
        false => Err(Problem::new(
            StatusCode::FORBIDDEN,
            "the form is not one of this server, or is older than its last start or your sign-in; \
             load the page again and send it from there",
        )),
    }
}

/// Frame of a page whose forms may be sent, with the user who is signed in.
pub(crate) fn shell(app: &App) -> Shell {
    let acting = current();
    let signed_in = acting.map(|acting| SignedIn {
        name: acting.principal.name.clone(),
        is_admin: acting.principal.rights.on_server(sistership_auth::Role::Admin),
        by_session: matches!(acting.principal.kind, Kind::Session { .. }),
    });
    Shell::new(token(app)).with(signed_in)
}
