//! The endpoints, one file for each group, and the document that describes them.

mod about;
mod aliases;
mod audit;
mod binary;
mod branches;
mod bulk_refinements;
mod champion;
mod compare;
mod described;
mod diagnoses;
mod document;
mod drift;
mod effects;
mod endpoints;
mod events;
mod exports;
mod families;
mod health;
mod jobs;
mod keys;
mod laws;
mod metrics;
mod model_ref;
mod named_trials;
mod notes;
mod pages;
mod predictions;
mod queue;
mod refinements;
mod register;
mod reports;
mod samples;
mod session_stream;
mod sessions;
mod ship_changes;
mod ships;
mod signatures;
mod similar;
mod tags;
mod trial_conditions;
mod trials;
mod uploads;
mod users;
mod validation;
mod versions;
mod webhooks;

use std::sync::Arc;

use axum::Router;
use axum::middleware::from_fn_with_state;
use axum::routing::get;
use tower_http::catch_panic::CatchPanicLayer;

pub use document::openapi;

use crate::app::App;
use crate::web::query::{self, KnownParameters};
use crate::web::{envelope, guard};

/// Returns the router of all endpoints and pages.
pub(crate) fn router(app: App) -> Router {
    let (api, described) = endpoints::api_router(app.limits()).split_for_parts();
    // Unknown query parameters are refused by comparison with the document.
    let known = Arc::new(KnownParameters::from_document(&described));
    let api = api.route_layer(from_fn_with_state(known, query::refuse_unknown));
    let text = document::document_text();
    api.route("/openapi.json", get(move || async move { document::serve_document(text) }))
        .merge(pages::page_routes(app.limits()))
        // Layers run from the last to the first: the envelope is outermost, then panics are caught,
        // then access is decided.
        .fallback(envelope::no_route)
        .layer(from_fn_with_state(app.clone(), guard::guard_request))
        .layer(CatchPanicLayer::custom(envelope::panic_response))
        .layer(from_fn_with_state(app.clone(), envelope::wrap_request))
        .with_state(app)
}
