//! Forms of pages: what they send, and the token by which they show that this server wrote them.

use axum::Form;
use axum::extract::{FromRequest, Request};
use axum::http::StatusCode;
use sistership_pages::{Fields, Shell, TOKEN};

use crate::app::App;
use crate::problem::{Problem, Result};

/// What a page's form has sent, once its token has been found right.
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

/// Whether the token is the one that pages of this server send.
pub(crate) fn checked(app: &App, token: Option<&str>) -> Result<()> {
    match token.is_some_and(|token| app.form_token().is(token)) {
        true => Ok(()),
        false => Err(Problem::new(
            StatusCode::FORBIDDEN,
            "the form is not one of this server, or is older than its last start; load the page \
             again and send it from there",
        )),
    }
}

/// What is around a page whose forms may be sent.
pub(crate) fn shell(app: &App) -> Shell {
    Shell::new(app.form_token().text())
}
