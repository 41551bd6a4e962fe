//! General part of the OpenAPI document.

use utoipa::OpenApi as _;
use utoipa::openapi::security::{HttpAuthScheme, HttpBuilder, SecurityRequirement, SecurityScheme};
use utoipa::openapi::{Components, OpenApi};

use crate::problem::{Fault, Problem};

#[derive(utoipa::OpenApi)]
#[openapi(
    info(
        title = "Sistership",
        description = "A model zoo and refinement server for ship manoeuvring models. Every error \
                       is a problem (RFC 9457); times are microseconds since 1970; other figures \
                       carry their unit in their name.",
        license(name = "MIT OR Apache-2.0"),
        version = "1"
    ),
    components(schemas(Problem, Fault)),
    tags(
        (name = "ships", description = "Ships, and the champion of each."),
        (name = "trials", description = "Free-running trials of ships."),
        (name = "refinements", description = "Refinement of a model against trials, as a job."),
        (name = "diagnoses", description = "Diagnosis of missing effects, as a job."),
        (name = "jobs", description = "Jobs: long computations."),
        (name = "models", description = "Versions of models, insert-only, and the aliases that \
            move between them."),
        (name = "predictions", description = "Simulations with a version."),
        (name = "branches", description = "Learned corrections of models, and their weights."),
        (name = "reports", description = "Reports of refinements, diagnoses and trainings."),
        (name = "laws", description = "Laws of motion."),
        (name = "effects", description = "Libraries of effects, by the hashes in recipes."),
        (name = "access", description = "Users, keys, roles and the audit."),
        (name = "webhooks", description = "Webhooks for events."),
        (name = "health", description = "Health of the server.")
    )
)]
struct ApiDescription;

/// Returns the part of the document that does not depend on the endpoints.
pub(super) fn general_document() -> OpenApi {
    let mut about = ApiDescription::openapi();
    about.info.version = env!("CARGO_PKG_VERSION").to_owned();
    let key = HttpBuilder::new()
        .scheme(HttpAuthScheme::Bearer)
        .description(Some("The server's API key, or a service key; where the server asks for one"))
        .build();
    about
        .components
        .get_or_insert_with(Components::new)
        .add_security_scheme("api_key", SecurityScheme::Http(key));
    about.security = Some(vec![
        SecurityRequirement::default(),
        SecurityRequirement::new("api_key", Vec::<String>::new()),
    ]);
    about
}
