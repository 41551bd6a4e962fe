//! `ETag`, `If-Match` and `If-None-Match`: a change is refused if the caller has not seen the
//! present state.

use axum::extract::FromRequestParts;
use axum::http::request::Parts;
use axum::http::{HeaderMap, HeaderName, StatusCode, header};
use sistership_store::ExpectedRevision;

use crate::field::EntityTags;
use crate::problem::{Fault, Problem, Result};

/// The conditions of a request.
#[derive(Debug, Default)]
pub struct RequestConditions {
    if_match: Option<TagList>,
    if_none_match: Option<TagList>,
}

#[derive(Debug, PartialEq, Eq)]
enum TagList {
    Any,
    These(Vec<String>),
}

/// Returns the entity tag of a revision.
pub fn entity_tag(revision: impl std::fmt::Display) -> String {
    format!("\"{revision}\"")
}

impl<S: Send + Sync> FromRequestParts<S> for RequestConditions {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self> {
        let read = |name: HeaderName| TagList::read(&parts.headers, &name);
        Ok(Self { if_match: read(header::IF_MATCH)?, if_none_match: read(header::IF_NONE_MATCH)? })
    }
}

impl TagList {
    fn read(headers: &HeaderMap, name: &HeaderName) -> Result<Option<Self>> {
        let Some(value) = headers.get(name) else { return Ok(None) };
        let text = value.to_str().map_err(|_| malformed_header(name, "must be text".to_owned()))?;
        let tags: EntityTags = text.parse().map_err(|message| malformed_header(name, message))?;
        // `*` stands for any existing representation.
        if tags.trim() == "*" {
            return Ok(Some(Self::Any));
        }
        Ok(Some(Self::These(tags.split(',').map(|tag| tag.trim().to_owned()).collect())))
    }

    /// Returns true if the tags include this one. A weak tag does not permit a change.
    fn contains_tag(&self, tag: &str) -> bool {
        matches!(self, Self::These(tags) if tags.iter().any(|known| known == tag))
            || *self == Self::Any
    }
}

impl TagList {
    /// Returns true if the tags include this revision, with or without the additional part of a
    /// tag.
    fn contains_revision(&self, revision: i64) -> bool {
        // A tag may continue after the revision with a part for data shown with the item:
        // `"3.xyz"`.
        let (alone, with_more) = (entity_tag(revision), format!("\"{revision}."));
        let named = |known: &String| *known == alone || known.starts_with(&with_more);
        matches!(self, Self::These(tags) if tags.iter().any(named)) || *self == Self::Any
    }
}

impl RequestConditions {
    /// Returns the revision on which a change must be based; `what` is at `current`.
    ///
    /// # Errors
    /// Returns an error if the request names no revision, or another one.
    pub fn required_revision(&self, what: &str, current: i64) -> Result<i64> {
        let Some(tags) = &self.if_match else {
            return Err(condition_required(&format!(
                "If-Match with the ETag of {what} from your last request"
            )));
        };
        if tags.contains_revision(current) {
            Ok(current)
        } else {
            Err(stale_revision(what, Some(current)))
        }
    }

    /// Returns the revision as [`Conditions::revision`] does, but a request without the header may
    /// change any.
    ///
    /// # Errors
    /// Returns an error if the request names another revision.
    pub fn optional_revision(&self, what: &str, current: i64) -> Result<Option<i64>> {
        self.if_match.as_ref().map(|_| self.required_revision(what, current)).transpose()
    }

    /// Returns the expectation of a change that may also create the item.
    ///
    /// # Errors
    /// Returns an error if there is no condition, or one that does not hold.
    pub fn expected_revision(&self, what: &str, current: Option<i64>) -> Result<ExpectedRevision> {
        // `If-Match` moves an existing item, `If-None-Match: *` creates one; one of both is
        // required.
        match (&self.if_match, &self.if_none_match, current) {
            (Some(_), _, Some(current)) => {
                self.required_revision(what, current).map(ExpectedRevision::Revision)
            }
            (Some(_), _, None) => Err(stale_revision(what, None)),
            (None, Some(TagList::Any), None) => Ok(ExpectedRevision::Absent),
            (None, Some(TagList::Any), current) => Err(stale_revision(what, current)),
            (None, Some(TagList::These(_)), _) => {
                Err(Problem::bad_request("If-None-Match: only `*` is supported here"))
            }
            (None, None, _) => Err(condition_required(
                "If-Match with its ETag to move it, or If-None-Match: * to create it",
            )),
        }
    }

    /// Returns true if the caller already has this representation.
    pub fn matches_current(&self, tag: &str) -> bool {
        self.if_none_match.as_ref().is_some_and(|tags| tags.contains_tag(tag))
    }
}

fn malformed_header(name: &HeaderName, message: String) -> Problem {
    let name = if *name == header::IF_MATCH { "If-Match" } else { "If-None-Match" };
    Problem::bad_request(format!("{name}: {message}")).with_fault(Fault::at_field(name, message))
}

fn condition_required(what: &str) -> Problem {
    Problem::new(
        StatusCode::PRECONDITION_REQUIRED,
        format!("send {what}, so that changes by others are not overwritten"),
    )
}

fn stale_revision(what: &str, current: Option<i64>) -> Problem {
    let now = current.map_or_else(
        || "does not exist".to_owned(),
        |revision| format!("is now at {}", entity_tag(revision)),
    );
    Problem::new(
        StatusCode::PRECONDITION_FAILED,
        format!("{what} {now}; read it again and repeat the change if it still applies"),
    )
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn given(name: HeaderName, value: &str) -> RequestConditions {
        let headers = HeaderMap::from_iter([(name, value.parse().unwrap())]);
        let read = |name| TagList::read(&headers, &name).unwrap();
        RequestConditions {
            if_match: read(header::IF_MATCH),
            if_none_match: read(header::IF_NONE_MATCH),
        }
    }

    #[test]
    fn a_change_needs_the_present_tag() {
        assert_eq!(given(header::IF_MATCH, "\"3\"").required_revision("ship", 3).unwrap(), 3);
        assert_eq!(
            given(header::IF_MATCH, "\"1\", \"3\"").required_revision("ship", 3).unwrap(),
            3
        );
        assert_eq!(given(header::IF_MATCH, "*").required_revision("ship", 3).unwrap(), 3);
        assert_eq!(given(header::IF_MATCH, "\"3.a\"").required_revision("ship", 3).unwrap(), 3);
        assert_eq!(
            given(header::IF_MATCH, "\"31\"").required_revision("ship", 3).unwrap_err().status,
            412
        );
        assert_eq!(
            given(header::IF_MATCH, "\"2\"").required_revision("ship", 3).unwrap_err().status,
            412
        );
        assert_eq!(
            given(header::IF_MATCH, "W/\"3\"").required_revision("ship", 3).unwrap_err().status,
            412
        );
        assert_eq!(
            RequestConditions::default().required_revision("ship", 3).unwrap_err().status,
            428
        );
    }

    #[test]
    fn creation_needs_absence() {
        assert_eq!(
            given(header::IF_NONE_MATCH, "*").expected_revision("alias", None).unwrap(),
            ExpectedRevision::Absent
        );
        assert_eq!(
            given(header::IF_NONE_MATCH, "*")
                .expected_revision("alias", Some(1))
                .unwrap_err()
                .status,
            412
        );
        assert_eq!(
            given(header::IF_MATCH, "\"1\"").expected_revision("alias", None).unwrap_err().status,
            412
        );
        assert_eq!(
            RequestConditions::default().expected_revision("alias", None).unwrap_err().status,
            428
        );
        assert!(
            TagList::read(
                &HeaderMap::from_iter([(header::IF_MATCH, "3".parse().unwrap())]),
                &header::IF_MATCH
            )
            .is_err()
        );
    }
}
