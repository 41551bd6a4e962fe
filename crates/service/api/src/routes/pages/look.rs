//! Pages without actions.

use axum::extract::State;
use axum::response::Response;
use sistership_auth::Role;
use sistership_jobs::budget;
use sistership_jobs::memory::trial_bytes;
use sistership_pages as pages;
use sistership_pages::Fields;

use super::answer::{answer, begun};
use crate::app::App;
use crate::problem::Result;
use crate::rights::visible;
use crate::web::form::shell;
use crate::web::{Id, Name, Number, Params, Place, Word};

type Asked = Params<Vec<(String, String)>>;

pub(super) async fn fleet(State(app): State<App>, Params(query): Asked) -> Result<Response> {
    let (known, query) = (app.catalogue().vectors(), Fields::from(query));
    Ok(answer(pages::fleet::page(app.archive(), known, shell(&app), &query).await?))
}

pub(super) async fn ship(State(app): State<App>, Place(ship): Place<Name>) -> Result<Response> {
    let gathered = pages::ship::gather(app.archive(), shell(&app), &ship).await?;
    let beginning = pages::beginning(shell(&app), &ship, "/")?;
    // The similar ships take a ranking of the zoo: the page begins before they are known.
    let page = async move {
        let zoo = app.zoo_shown(gathered.vessel()).await?;
        let similar = gathered.similar(app.archive(), zoo).await?;
        let similar = visible(app.store(), Role::Reader, similar, |ranked| &ranked.ship).await?;
        Ok(app.compute(move || gathered.html(similar)).await??)
    };
    Ok(begun(beginning, page))
}

pub(super) async fn version(
    State(app): State<App>,
    Place((ship, number)): Place<(Name, Number)>,
) -> Result<Response> {
    let gathered = pages::version::gather(app.archive(), shell(&app), &ship, number.get()).await?;
    let (known, title) = (app.manoeuvres(), format!("{}/{}", &*ship, number.get()));
    let beginning = pages::beginning(shell(&app), &title, "/")?;
    let page = async move { Ok(app.compute(move || gathered.html(&known)).await??) };
    Ok(begun(beginning, page))
}

pub(super) async fn trial(State(app): State<App>, Place(id): Place<Id>) -> Result<Response> {
    budget::take(trial_bytes(app.store().trials().get(&id).await?.sample_rows)).await?;
    let gathered = pages::trial::gather(app.archive(), shell(&app), &id).await?;
    Ok(answer(app.compute(move || gathered.html()).await??))
}

pub(super) async fn compare(State(app): State<App>, Params(query): Asked) -> Result<Response> {
    let query = Fields::from(query);
    let gathered = pages::compare::gather(app.archive(), shell(&app), &query).await?;
    let beginning = pages::beginning(shell(&app), "Compare", "/compare")?;
    Ok(begun(beginning, async move { Ok(app.compute(move || gathered.html()).await??) }))
}

pub(super) async fn playground(State(app): State<App>, Params(query): Asked) -> Result<Response> {
    let query = Fields::from(query);
    let gathered = pages::playground::gather(app.archive(), shell(&app), query).await?;
    let most = app.limits().prediction_samples;
    let beginning = pages::beginning(shell(&app), "Playground", "/playground")?;
    Ok(begun(beginning, async move { Ok(app.compute(move || gathered.html(most)).await??) }))
}

pub(super) async fn families(State(app): State<App>, Params(query): Asked) -> Result<Response> {
    Ok(answer(pages::families::list(app.archive(), shell(&app), &Fields::from(query)).await?))
}

pub(super) async fn family(State(app): State<App>, Place(name): Place<Word>) -> Result<Response> {
    Ok(answer(pages::families::one(app.archive(), shell(&app), &name).await?))
}

pub(super) async fn zoo(State(app): State<App>) -> Result<Response> {
    Ok(answer(pages::zoo::index(&*app.laws().await?, shell(&app))?))
}

pub(super) async fn law(State(app): State<App>, Place(name): Place<Name>) -> Result<Response> {
    Ok(answer(pages::zoo::law(app.archive(), shell(&app), &name).await?))
}

pub(super) async fn effect(State(app): State<App>, Place(name): Place<Name>) -> Result<Response> {
    Ok(answer(pages::zoo::effect(shell(&app), &name)?))
}

pub(super) async fn jobs(State(app): State<App>, Params(query): Asked) -> Result<Response> {
    Ok(answer(pages::jobs::list(app.archive(), shell(&app), &Fields::from(query)).await?))
}

pub(super) async fn job(State(app): State<App>, Place(id): Place<Id>) -> Result<Response> {
    Ok(answer(pages::jobs::one(app.archive(), shell(&app), &id).await?))
}
