//! Common parts of all operations of the OpenAPI document: the operation id, the possible problems,
//! and a description of each answer.

use axum::http::StatusCode;
use utoipa::openapi::path::{Operation, ParameterIn};
use utoipa::openapi::{
    Components, Content, OpenApi, PathItem, Ref, RefOr, Response, ResponseBuilder,
};

use crate::problem::{MEDIA, Problem};
use crate::query::operation_parameters;

/// Adds the common parts to every operation.
pub fn complete_operations(document: &mut OpenApi) {
    for (path, item) in &mut document.paths.paths {
        for (method, operation) in path_operations(item) {
            operation.operation_id = Some(make_operation_id(method, path));
            add_problems(method, path, operation);
        }
    }
    let components = document.components.get_or_insert_with(Components::new);
    components
        .responses
        .extend(PROBLEMS.map(|status| (problem_name(status), problem_response(status).into())));
}

/// Statuses of problems that operations have in common.
const PROBLEMS: [u16; 17] =
    [400, 401, 403, 404, 406, 408, 409, 412, 413, 415, 422, 428, 429, 500, 503, 504, 507];

fn problem_name(status: u16) -> String {
    format!("Problem{status}")
}

fn problem_response(status: u16) -> Response {
    let status = StatusCode::from_u16(status).unwrap_or_default();
    let content = Content::new(Some(Ref::from_schema_name("Problem")));
    ResponseBuilder::new()
        .description(Problem::new(status, "").title)
        .content(MEDIA, content)
        .build()
}

fn path_operations(item: &mut PathItem) -> impl Iterator<Item = (&'static str, &mut Operation)> {
    let all = [
        ("get", &mut item.get),
        ("put", &mut item.put),
        ("post", &mut item.post),
        ("delete", &mut item.delete),
    ];
    all.into_iter().filter_map(|(method, operation)| Some((method, operation.as_mut()?)))
}

/// Returns the operation id, from which generated clients take names: `get_ships_ship_model`.
fn make_operation_id(method: &str, path: &str) -> String {
    let words = path
        .split('/')
        .filter(|word| !word.is_empty() && *word != "v1")
        .map(|word| word.trim_matches(['{', '}']));
    std::iter::once(method).chain(words).collect::<Vec<_>>().join("_")
}

/// Adds the possible problems; their statuses follow from the inputs of the operation.
fn add_problems(method: &str, path: &str, operation: &mut Operation) {
    let has = |place: ParameterIn, name: &str| {
        let all = operation_parameters(operation);
        all.filter(|known| known.parameter_in == place)
            .any(|known| name.is_empty() || known.name == name)
    };
    let forms = operation.responses.responses.get("200").map_or(0, |response| match response {
        RefOr::T(response) => response.content.len(),
        RefOr::Ref(_) => 0,
    });
    let (body, change, key) =
        (operation.request_body.is_some(), method != "get", path.starts_with("/v1"));
    let if_match = has(ParameterIn::Header, "If-Match");
    // Refusals of access and of reading apply below `/v1` only; 404 needs a path parameter, 406
    // several forms of the answer, 409 and 507 a change, 412 and 428 `If-Match`, 408, 413 and 415 a
    // body.
    let statuses = PROBLEMS.into_iter().filter(|status| match status {
        400 | 401 | 403 | 429 | 504 => key,
        404 => has(ParameterIn::Path, ""),
        406 => forms > 1,
        409 | 507 => change,
        412 | 428 => if_match,
        408 | 413 | 415 => body,
        422 => body || change,
        _ => true,
    });
    let statuses: Vec<u16> = statuses.collect();
    let responses = &mut operation.responses.responses;
    for status in statuses {
        responses
            .entry(status.to_string())
            .or_insert_with(|| RefOr::Ref(Ref::from_response_name(problem_name(status))));
    }
    // Any other status is described as an internal problem.
    responses.insert("default".to_owned(), RefOr::Ref(Ref::from_response_name(problem_name(500))));
    responses.iter_mut().for_each(|(status, response)| describe_response(status, response));
}

/// Fills a missing description of a response, which OpenAPI requires, from its status.
fn describe_response(status: &str, response: &mut RefOr<Response>) {
    let RefOr::T(response) = response else { return };
    if response.description.is_empty() {
        let known = status.parse().ok().and_then(|status: u16| StatusCode::from_u16(status).ok());
        response.description =
            known.and_then(|status| status.canonical_reason()).unwrap_or("The response").to_owned();
    }
}
