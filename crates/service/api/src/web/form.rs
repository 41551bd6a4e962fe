//! Forms of pages: their fields, and the token which proves that this server wrote them.

use axum::Form;
use axum::extract::{FromRequest, Request};
use axum::http::StatusCode;
use sistership_auth::constant_time_eq;
use sistership_pages::{FormFields, PageShell, PageUser, TOKEN_FIELD};

use crate::app::App;
use crate::problem::{Problem, Result};
use crate::rights::{AuthenticationKind, current_actor};

/// Fields of a page's form whose token is valid.
pub(crate) struct PageForm(pub FormFields);

impl FromRequest<App> for PageForm {
    type Rejection = Problem;

    async fn from_request(request: Request, app: &App) -> Result<Self> {
        let form = Form::<Vec<(String, String)>>::from_request(request, app).await;
        let Form(pairs) = form.map_err(|error| Problem::new(error.status(), error.body_text()))?;
        let fields = FormFields::from(pairs);
        check_token(app, fields.get_text(TOKEN_FIELD))?;
        Ok(Self(fields))
    }
}

/// Token of the current forms: that of the session, otherwise that of the server.
fn current_token(app: &App) -> String {
    match current_actor().map(|acting| acting.principal.kind.clone()) {
        Some(AuthenticationKind::Session { form_token, .. }) => form_token,
        _ => app.form_token().as_str().to_owned(),
    }
}

/// Checks that the token is the one that the pages of this server carry.
///
/// # Errors
/// Returns 403 if it is another one or missing.
pub(crate) fn check_token(app: &App, presented: Option<&str>) -> Result<()> {
    let known = current_token(app);
    // Compared in constant time, so that the token cannot be guessed byte by byte.
    match presented
        .is_some_and(|presented| constant_time_eq(presented.as_bytes(), known.as_bytes()))
    {
        true => Ok(()),
        false => Err(Problem::new(
            StatusCode::FORBIDDEN,
            "the form has expired (the server was restarted or you have signed in since); load \
             the page again and send the form again",
        )),
    }
}

/// Frame of a page whose forms may be sent, with the user who is signed in.
pub(crate) fn page_shell(app: &App) -> PageShell {
    let acting = current_actor();
    let signed_in = acting.map(|acting| PageUser {
        name: acting.principal.name.clone(),
        is_admin: acting.principal.rights.on_server(sistership_auth::Role::Admin),
        by_session: matches!(acting.principal.kind, AuthenticationKind::Session { .. }),
    });
    PageShell::new(current_token(app)).with_user(signed_in)
}
