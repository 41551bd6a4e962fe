//! Conversion of the errors of other crates to problems.

use axum::extract::multipart::MultipartError;
use axum::extract::path::ErrorKind;
use axum::extract::rejection::{BytesRejection, PathRejection, QueryRejection};
use axum::http::StatusCode;
use sistership_identification::refine::RefineError;
use sistership_model::FileError;
use sistership_model::trial::Finding;
use sistership_pages::PageError;
use sistership_store::StoreError;
use sistership_trials::Refusal;

use super::{Fault, Problem};
use sistership_jobs::budget::MemoryShortage;
use sistership_jobs::error::DeriveError;
use sistership_jobs::fleet::OrderError;
use sistership_jobs::predictions::PredictionError;

impl From<StoreError> for Problem {
    fn from(error: StoreError) -> Self {
        let text = error.to_string();
        match error {
            // First, as several kinds of errors may be due to a full disk.
            full if full.is_out_of_space() => Self::no_room(text),
            StoreError::NotFound { .. } => Self::not_found(text),
            StoreError::Conflict { .. } => Self::new(StatusCode::CONFLICT, text),
            StoreError::Forbidden { .. } => Self::new(StatusCode::FORBIDDEN, text),
            StoreError::QuotaExceeded { .. } => Self::new(StatusCode::TOO_MANY_REQUESTS, text),
            StoreError::PreconditionFailed { .. } => Self::new(
                StatusCode::PRECONDITION_FAILED,
                format!("{text}; read it again and repeat the change if it still applies"),
            ),
            StoreError::Invalid { field, message } => Self::invalid(field, message),
            // The reason is logged only: it may contain statements or addresses.
            StoreError::Database(_) => {
                tracing::error!(reason = %text, "the database failed");
                Self::new(
                    StatusCode::SERVICE_UNAVAILABLE,
                    "the database did not complete the request; try again in a moment",
                )
            }
            StoreError::Objects(error) if error.is_passing() => {
                tracing::error!(reason = %text, "the object store failed");
                Self::new(
                    StatusCode::SERVICE_UNAVAILABLE,
                    "the object store did not complete the request; try again in a moment",
                )
            }
            StoreError::Objects(_) | StoreError::File { .. } => Self::internal(text),
        }
    }
}

impl From<FileError> for Problem {
    fn from(error: FileError) -> Self {
        let fault = |error: &FileError| Fault {
            field: (!error.field.is_empty()).then(|| error.field.clone()),
            row: error.line,
            column: None,
            message: error.message.clone(),
        };
        let errors = std::iter::once(&error).chain(&error.further).map(fault).collect();
        Self { errors, ..Self::new(StatusCode::UNPROCESSABLE_ENTITY, error.to_string()) }
    }
}

impl From<Vec<Refusal>> for Problem {
    /// Reports refused trials, each fault with its file, row and column.
    fn from(refusals: Vec<Refusal>) -> Self {
        let names: Vec<&str> = refusals.iter().map(|refusal| refusal.file.as_str()).collect();
        let detail = format!(
            "nothing was stored because of {}: see `errors`, correct the files and upload all of \
             them again",
            names.join(", ")
        );
        let errors = refusals.iter().flat_map(|refusal| {
            refusal.findings.iter().map(|finding| finding_fault(&refusal.file, finding))
        });
        Self { errors: errors.collect(), ..Self::new(StatusCode::UNPROCESSABLE_ENTITY, detail) }
    }
}

fn finding_fault(file: &str, finding: &Finding) -> Fault {
    Fault {
        field: Some(file.to_owned()),
        row: finding.row,
        column: finding.column.clone(),
        message: finding.message.clone(),
    }
}

impl From<RefineError> for Problem {
    fn from(error: RefineError) -> Self {
        match error {
            RefineError::Setting { field, message } => {
                Self::invalid(&format!("settings.{field}"), message)
            }
            other => Self::new(StatusCode::UNPROCESSABLE_ENTITY, other.to_string()),
        }
    }
}

impl From<DeriveError> for Problem {
    fn from(error: DeriveError) -> Self {
        match error {
            DeriveError::Store(error) => error.into(),
            DeriveError::Refine(error) => error.into(),
            DeriveError::Lost(message) => Self::new(StatusCode::CONFLICT, message),
            other => Self::internal(other),
        }
    }
}

impl From<PageError> for Problem {
    fn from(error: PageError) -> Self {
        match error {
            PageError::Derive(error) => error.into(),
            PageError::Invalid { field, message } => Self::invalid(&field, message),
            PageError::Render(_) => Self::internal(error),
        }
    }
}

impl From<PredictionError> for Problem {
    fn from(error: PredictionError) -> Self {
        match error {
            PredictionError::Field { field, message } => Self::invalid(&field, message),
            PredictionError::Memory(shortage) => shortage.into(),
            PredictionError::NoSession(_) => Self::not_found(error.to_string()),
            PredictionError::ManySessions { .. } => {
                Self::new(StatusCode::TOO_MANY_REQUESTS, error.to_string())
            }
            PredictionError::SessionBusy => Self::new(StatusCode::CONFLICT, error.to_string()),
            PredictionError::Answer(error) => Self::internal(error),
        }
    }
}

impl From<MemoryShortage> for Problem {
    fn from(shortage: MemoryShortage) -> Self {
        match &shortage {
            MemoryShortage::Never { .. } => {
                Self::new(StatusCode::PAYLOAD_TOO_LARGE, format!("{shortage}; send less at a time"))
            }
            MemoryShortage::Busy { .. } => Self::new(
                StatusCode::TOO_MANY_REQUESTS,
                format!("{shortage}; try again in some seconds, or with less"),
            ),
        }
    }
}

impl From<OrderError> for Problem {
    fn from(error: OrderError) -> Self {
        match error {
            OrderError::Setting { field, message } => Self::invalid(&field, message),
            OrderError::Store(error) => error.into(),
            OrderError::Json(_) => Self::internal(error),
        }
    }
}

impl From<QueryRejection> for Problem {
    fn from(rejection: QueryRejection) -> Self {
        // The prefix of the library is removed; the rest names the parameter.
        let text = rejection.body_text();
        let message = text.strip_prefix("Failed to deserialize query string: ").unwrap_or(&text);
        Self::bad_request(format!("query: {message}"))
            .with_fault(Fault::at_field(parameter_name(message), message))
    }
}

/// Returns the parameter that a message is about: `limit: invalid digit`, or "unknown field `limt`,
/// expected ...".
fn parameter_name(message: &str) -> &str {
    let quoted = message.split('`').nth(1);
    let before = message.split_once(": ").map(|(name, _)| name).filter(|name| !name.contains(' '));
    before.or(quoted).unwrap_or("query")
}

impl From<PathRejection> for Problem {
    fn from(rejection: PathRejection) -> Self {
        // A path that does not match the types of a route names nothing: 404, not 400.
        let PathRejection::FailedToDeserializePathParams(failed) = &rejection else {
            return Self::not_found(format!("this path does not exist: {}", rejection.body_text()));
        };
        match failed.kind() {
            ErrorKind::DeserializeError { key, value, message } => {
                Self::not_found(format!("{key}: there is no `{value}`: it {message}"))
                    .with_fault(Fault::at_field(key, message))
            }
            other => Self::not_found(format!("this path does not exist: {other}")),
        }
    }
}

impl From<MultipartError> for Problem {
    fn from(error: MultipartError) -> Self {
        match error.status() {
            StatusCode::PAYLOAD_TOO_LARGE => Self::new(
                StatusCode::PAYLOAD_TOO_LARGE,
                "the upload is larger than this server accepts; send several uploads",
            ),
            _ => Self::bad_request(format!("the form cannot be read: {}", error.body_text())),
        }
    }
}

impl From<BytesRejection> for Problem {
    fn from(rejection: BytesRejection) -> Self {
        match rejection.status() {
            StatusCode::PAYLOAD_TOO_LARGE => Self::new(
                StatusCode::PAYLOAD_TOO_LARGE,
                "the body is larger than this endpoint accepts; send trials to /v1/trials",
            ),
            status => Self::new(status, rejection.body_text()),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn refused_trials_keep_row_and_column() {
        let finding =
            Finding { row: Some(7), column: Some("u".into()), message: "not a number".into() };
        let problem =
            Problem::from(vec![Refusal { file: "a.csv".into(), findings: vec![finding] }]);
        assert_eq!(
            (problem.status, problem.errors[0].row, problem.errors[0].field.as_deref()),
            (422, Some(7), Some("a.csv"))
        );
    }

    #[test]
    fn the_wrong_parameter_is_named() {
        assert_eq!(parameter_name("limit: invalid digit found in string"), "limit");
        assert_eq!(
            parameter_name("unknown field `limt`, expected one of `limit`, `after`"),
            "limt"
        );
        assert_eq!(parameter_name("missing field `ship`"), "ship");
        assert_eq!(parameter_name("something else"), "query");
    }

    #[test]
    fn what_fits_later_is_told_from_what_never_fits() {
        let setting = "--request-memory-mb";
        assert_eq!(
            Problem::from(MemoryShortage::Never { needed: 2, bytes: 1, setting }).status,
            413
        );
        assert_eq!(
            Problem::from(MemoryShortage::Busy { needed: 2, free: 1, bytes: 3, setting }).status,
            429
        );
    }

    #[test]
    fn a_full_disk_is_no_failure_of_the_server() {
        let problem = Problem::from(StoreError::out_of_space());
        assert_eq!((problem.status, problem.kind), (507, "urn:sistership:problem:no-room"));
        assert!(problem.detail.contains("no free space"), "{}", problem.detail);
    }

    /// Failures of each part, and the problems that they become.
    #[tokio::test]
    async fn a_part_that_fails_is_a_503_that_says_when_to_come_again() {
        let late = tokio::time::timeout(std::time::Duration::ZERO, std::future::pending::<()>());
        let late = sistership_store::ObjectsError::from(late.await.unwrap_err());
        let damaged =
            sistership_store::ObjectsError::Damaged { key: "a".into(), actual: "b".into() };
        for (error, status) in [(StoreError::from(late), 503), (StoreError::from(damaged), 500)] {
            let response = axum::response::IntoResponse::into_response(Problem::from(error));
            assert_eq!(response.status(), status);
            assert_eq!(response.headers().contains_key("retry-after"), status == 503);
        }
    }

    #[test]
    fn what_the_database_says_stays_inside() {
        let file = FileError {
            file: "body".into(),
            line: Some(3),
            field: "name".into(),
            message: "is taken".into(),
            further: Vec::new(),
        };
        assert_eq!(Problem::from(file).errors[0].row, Some(3));
        let stale =
            StoreError::PreconditionFailed { kind: "ship", id: "a".into(), current: Some(2) };
        assert_eq!(Problem::from(stale).status, 412);
    }
}
