//! Progress of a job as server-sent events.

use std::convert::Infallible;
use std::time::Duration;

use axum::extract::State;
use axum::response::sse::{Event, KeepAlive, Sse};
use futures::Stream;
use sistership_store::{Job, JobState};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::jobs::JobView;
use crate::app::App;
use crate::problem::Result;
use crate::web::{Id, PathParams};

/// Interval at which the job is read: another process may work on it.
const POLL_INTERVAL: Duration = Duration::from_millis(200);

pub(super) fn event_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(events))
}

/// Follow a job until its end
///
/// Each event is called `job` and holds the job as JSON; one is sent at once and one with each
/// change. The stream ends with the job, or when the server stops.
#[utoipa::path(
    get, path = "/v1/jobs/{id}/events", tag = "jobs", params(("id" = inline(Id), Path)),
    responses((status = 200, body = JobView, content_type = "text/event-stream"))
)]
async fn events(
    State(app): State<App>,
    PathParams(id): PathParams<Id>,
) -> Result<Sse<impl Stream<Item = Result<Event, Infallible>>>> {
    let job = app.store().jobs().get(&id).await?;
    Ok(Sse::new(follow_job(app, job)).keep_alive(KeepAlive::default()))
}

fn follow_job(app: App, first: Job) -> impl Stream<Item = Result<Event, Infallible>> {
    let id = first.id.clone();
    async_stream::stream! {
        let (mut stopping, mut seen, mut job) = (app.stop_signal(), None, first);
        loop {
            // The first state is always sent, as nothing precedes it.
            if seen.replace(change_mark(&job)) != Some(change_mark(&job)) {
                yield Ok(job_event(job.clone()));
            }
            if job.state.is_final() {
                break;
            }
            tokio::select! {
                () = stopping.wait() => break,
                () = tokio::time::sleep(POLL_INTERVAL) => {}
            }
            match app.store().jobs().get(&id).await {
                Ok(now) => job = now,
                Err(error) => tracing::warn!(%error, "a job could not be read"),
            }
        }
    }
}

/// Returns the parts of a job whose change is sent to the listener.
fn change_mark(job: &Job) -> (JobState, u64, String, bool, i64) {
    (job.state, job.progress.to_bits(), job.message.clone(), job.cancel_requested, job.attempt)
}

fn job_event(job: Job) -> Event {
    let event = Event::default().event("job");
    event
        .json_data(JobView::from_job(job))
        .unwrap_or_else(|_| Event::default().comment("the job cannot be read"))
}
