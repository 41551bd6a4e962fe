//! Pages without actions.

use axum::extract::State;
use axum::response::Response;
use sistership_auth::Role;
use sistership_jobs::budget;
use sistership_jobs::memory::trial_bytes;
use sistership_pages as pages;
use sistership_pages::version::turn::TurnInputs;
use sistership_pages::{FormFields, say};

use super::answer::{page_response, picture_response, stream_page};
use crate::app::App;
use crate::problem::Result;
use crate::rights::filter_visible;
use crate::web::form::page_shell;
use crate::web::{Id, Name, Number, PathParams, QueryParams, Word};

type PageQuery = QueryParams<Vec<(String, String)>>;

pub(super) async fn fleet_page(
    State(app): State<App>,
    QueryParams(query): PageQuery,
) -> Result<Response> {
    let (known, query) = (app.catalogue().known_vectors(), FormFields::from(query));
    Ok(page_response(
        pages::fleet::fleet_page(app.archive(), known, page_shell(&app), &query).await?,
    ))
}

pub(super) async fn ship_page(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
) -> Result<Response> {
    let gathered = pages::ship::gather_inputs(app.archive(), page_shell(&app), &ship).await?;
    let beginning = pages::page_beginning(page_shell(&app), &ship, "/")?;
    // The similar ships take a ranking of the zoo: the page begins before they are known.
    let page = async move {
        let zoo = app.zoo_shown(gathered.vessel()).await?;
        let similar = gathered.similar_ships(app.archive(), zoo).await?;
        let similar =
            filter_visible(app.store(), Role::Reader, similar, |ranked| &ranked.ship).await?;
        Ok(app.run_blocking(move || gathered.render_html(similar)).await??)
    };
    Ok(stream_page(beginning, page))
}

pub(super) async fn version_page(
    State(app): State<App>,
    PathParams((ship, number)): PathParams<(Name, Number)>,
) -> Result<Response> {
    let gathered =
        pages::version::gather_inputs(app.archive(), page_shell(&app), &ship, number.get()).await?;
    let (known, title) = (app.known_manoeuvres(), format!("{}/{}", &*ship, number.get()));
    let beginning = pages::page_beginning(page_shell(&app), &title, "/")?;
    let page = async move { Ok(app.run_blocking(move || gathered.render_html(&known)).await??) };
    Ok(stream_page(beginning, page))
}

/// Picture of the turning circle of a version, which never changes.
pub(super) async fn version_turn(
    State(app): State<App>,
    PathParams((ship, number)): PathParams<(Name, Number)>,
) -> Result<Response> {
    turn_picture(&app, &ship, Some(number.get()), "private, max-age=604800, immutable").await
}

/// The same of the champion, which may move.
pub(super) async fn champion_turn(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
) -> Result<Response> {
    turn_picture(&app, &ship, None, "private, max-age=300").await
}

async fn turn_picture(
    app: &App,
    ship: &str,
    number: Option<i64>,
    cached: &'static str,
) -> Result<Response> {
    let known = app.turn_pictures();
    let gathered = pages::version::turn::gather_turn(app.archive(), &known, ship, number).await?;
    let picture = match gathered {
        TurnInputs::Known(picture) => picture,
        open => app.run_blocking(move || open.render_svg(&known)).await?,
    };
    Ok(picture_response(&picture, cached))
}

pub(super) async fn trial_page(
    State(app): State<App>,
    PathParams(id): PathParams<Id>,
) -> Result<Response> {
    budget::reserve_for_request(trial_bytes(app.store().trials().get(&id).await?.sample_rows))
        .await?;
    let gathered = pages::trial::gather_inputs(app.archive(), page_shell(&app), &id).await?;
    Ok(page_response(app.run_blocking(move || gathered.render_html()).await??))
}

pub(super) async fn compare_page(
    State(app): State<App>,
    QueryParams(query): PageQuery,
) -> Result<Response> {
    let query = FormFields::from(query);
    let gathered = pages::compare::gather_inputs(app.archive(), page_shell(&app), &query).await?;
    let beginning =
        pages::page_beginning(page_shell(&app), &say("place-compare").to_string(), "/compare")?;
    Ok(stream_page(beginning, async move {
        Ok(app.run_blocking(move || gathered.render_html()).await??)
    }))
}

pub(super) async fn playground_page(
    State(app): State<App>,
    QueryParams(query): PageQuery,
) -> Result<Response> {
    let query = FormFields::from(query);
    let gathered = pages::playground::gather_inputs(app.archive(), page_shell(&app), query).await?;
    let most = app.limits().prediction_samples;
    let beginning = pages::page_beginning(
        page_shell(&app),
        &say("place-playground").to_string(),
        "/playground",
    )?;
    Ok(stream_page(beginning, async move {
        Ok(app.run_blocking(move || gathered.render_html(most)).await??)
    }))
}

pub(super) async fn families_page(
    State(app): State<App>,
    QueryParams(query): PageQuery,
) -> Result<Response> {
    Ok(page_response(
        pages::families::families_page(app.archive(), page_shell(&app), &FormFields::from(query))
            .await?,
    ))
}

pub(super) async fn family_page(
    State(app): State<App>,
    PathParams(name): PathParams<Word>,
) -> Result<Response> {
    Ok(page_response(pages::families::family_page(app.archive(), page_shell(&app), &name).await?))
}

pub(super) async fn zoo_page(State(app): State<App>) -> Result<Response> {
    Ok(page_response(pages::zoo::zoo_page(&*app.stored_laws().await?, page_shell(&app))?))
}

pub(super) async fn law_page(
    State(app): State<App>,
    PathParams(name): PathParams<Name>,
) -> Result<Response> {
    Ok(page_response(pages::zoo::law_page(app.archive(), page_shell(&app), &name).await?))
}

pub(super) async fn effect_page(
    State(app): State<App>,
    PathParams(name): PathParams<Name>,
) -> Result<Response> {
    Ok(page_response(pages::zoo::effect_page(page_shell(&app), &name)?))
}

pub(super) async fn jobs_page(
    State(app): State<App>,
    QueryParams(query): PageQuery,
) -> Result<Response> {
    Ok(page_response(
        pages::jobs::jobs_page(app.archive(), page_shell(&app), &FormFields::from(query)).await?,
    ))
}

pub(super) async fn job_page(
    State(app): State<App>,
    PathParams(id): PathParams<Id>,
) -> Result<Response> {
    Ok(page_response(pages::jobs::job_page(app.archive(), page_shell(&app), &id).await?))
}
