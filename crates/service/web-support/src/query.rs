//! Refusal of unknown query parameters: a misspelt one would silently have no effect.

use std::collections::HashMap;
use std::sync::Arc;

use axum::extract::{MatchedPath, Query, Request, State};
use axum::http::Method;
use axum::middleware::Next;
use axum::response::Response;
use utoipa::openapi::path::{Operation, Parameter, ParameterIn};
use utoipa::openapi::{OpenApi, RefOr};

use crate::problem::{Fault, Problem, Result};

/// Query parameters of each operation of the OpenAPI document, by path and method.
#[derive(Debug)]
pub struct KnownParameters(HashMap<(String, Method), Vec<String>>);

impl KnownParameters {
    /// Collects the parameters of a document.
    pub fn from_document(document: &OpenApi) -> Self {
        let mut known = HashMap::new();
        for (path, item) in document.paths.paths.iter().filter(|(path, _)| path.starts_with("/v1"))
        {
            let all = [
                (Method::GET, &item.get),
                (Method::PUT, &item.put),
                (Method::POST, &item.post),
                (Method::DELETE, &item.delete),
            ];
            let there = all
                .into_iter()
                .filter_map(|(method, operation)| Some((method, operation.as_ref()?)));
            known.extend(
                there.map(|(method, operation)| ((path.clone(), method), query_names(operation))),
            );
        }
        Self(known)
    }

    fn check_query(&self, path: &str, method: &Method, query: &str) -> Result<()> {
        // HEAD is answered by the operation of GET and has its parameters.
        let method = if method == Method::HEAD { Method::GET } else { method.clone() };
        // Paths that are not in the document, such as pages, are not checked.
        let (Some(known), false) = (self.0.get(&(path.to_owned(), method)), query.is_empty())
        else {
            return Ok(());
        };
        let pairs: Vec<(String, String)> = query_pairs(query)?;
        let unknown = pairs.into_iter().map(|(name, _)| name).find(|name| !known.contains(name));
        unknown.map_or(Ok(()), |name| Err(unknown_parameter(&name, known)))
    }
}

/// Returns the parameters of an operation.
pub fn operation_parameters(operation: &Operation) -> impl Iterator<Item = &Parameter> {
    operation.parameters.iter().flatten().filter_map(|known| match known {
        RefOr::T(parameter) => Some(parameter),
        RefOr::Ref(_) => None,
    })
}

fn query_names(operation: &Operation) -> Vec<String> {
    let all = operation_parameters(operation);
    all.filter(|known| known.parameter_in == ParameterIn::Query)
        .map(|known| known.name.clone())
        .collect()
}

fn query_pairs(query: &str) -> Result<Vec<(String, String)>> {
    let uri = axum::http::Uri::builder().path_and_query(format!("/?{query}")).build();
    let uri = uri.map_err(|error| Problem::bad_request(format!("query: {error}")))?;
    Ok(Query::try_from_uri(&uri).map(|Query(pairs)| pairs)?)
}

fn unknown_parameter(name: &str, known: &[String]) -> Problem {
    let message = match known {
        [] => "is not a parameter; this path has none".to_owned(),
        known => format!("is not a parameter; choose one of {}", known.join(", ")),
    };
    Problem::bad_request(format!("{name}: {message}")).with_fault(Fault::at_field(name, message))
}

/// Middleware that refuses requests with unknown query parameters.
pub async fn refuse_unknown(
    State(known): State<Arc<KnownParameters>>,
    path: MatchedPath,
    request: Request,
    next: Next,
) -> Result<Response> {
    known.check_query(
        path.as_str(),
        request.method(),
        request.uri().query().unwrap_or_default(),
    )?;
    Ok(next.run(request).await)
}
