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
        (name = "ships", description = "Ships, and the model that each is asked for."),
        (name = "trials", description = "Free-running trials of ships."),
        (name = "refinements", description = "Refining a model against trials, as a job."),
        (name = "diagnoses", description = "Finding what a model lacks, as a job."),
        (name = "jobs", description = "Long work."),
        (name = "models", description = "Versions of models, insert-only, and the aliases that \
            move between them."),
        (name = "predictions", description = "Simulations with a version."),
        (name = "branches", description = "What is learned beside a law of motion, and its \
            weights."),
        (name = "reports", description = "What a refinement, a diagnosis or a training reported."),
        (name = "laws", description = "Laws of motion."),
        (name = "effects", description = "Libraries of effects, as recipes name them."),
        (name = "access", description = "Who may do what, and who has done what."),
        (name = "webhooks", description = "Who is told of what happens."),
        (name = "health", description = "Whether the server lives and can work.")
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
