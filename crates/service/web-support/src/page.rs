//! Pages of lists.

use base64::Engine as _;
use base64::prelude::BASE64_URL_SAFE_NO_PAD;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sistership_store::{ListPage, PageRequest};
use utoipa::{IntoParams, ToSchema};

use crate::field::{Cursor, Limit};
use crate::problem::{Fault, Problem, Result};

/// Query of a list without filters.
#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
pub struct PageQuery {
    /// Maximum number of items to return.
    #[param(inline)]
    limit: Option<Limit>,
    /// `next` of the page before.
    #[param(inline)]
    after: Option<Cursor>,
}

impl PageQuery {
    /// Returns the requested page.
    ///
    /// # Errors
    /// Returns an error if `after` is not a cursor of this list.
    pub fn requested_page<K: DeserializeOwned>(&self) -> Result<PageRequest<K>> {
        parse_page(self.limit, self.after.as_ref())
    }
}

/// One page of a list.
#[derive(Debug, Serialize, ToSchema)]
pub struct Listing<T> {
    /// The items, in the list's order.
    pub items: Vec<T>,
    /// Value of `after` for the next page, to be passed unchanged; null on the last page. It refers
    /// to the last item of this page: the next page starts after that item, even if items are added
    /// meanwhile.
    pub next: Option<String>,
}

impl<T> Listing<T> {
    /// Creates a page from rows, each converted by `view`.
    pub fn from_list<R, K: Serialize>(list: ListPage<R, K>, view: impl FnMut(R) -> T) -> Self {
        Self {
            items: list.items.into_iter().map(view).collect(),
            next: list.next.as_ref().and_then(encode_cursor),
        }
    }
}

/// Encodes a key as an opaque cursor.
pub fn encode_cursor<K: Serialize>(key: &K) -> Option<String> {
    Some(BASE64_URL_SAFE_NO_PAD.encode(serde_json::to_vec(key).ok()?))
}

/// Returns the page that a query requests.
///
/// # Errors
/// Returns an error if `after` is not a cursor of this list.
pub fn parse_page<K: DeserializeOwned>(
    limit: Option<Limit>,
    after: Option<&Cursor>,
) -> Result<PageRequest<K>> {
    let key = |text: &str| serde_json::from_slice(&BASE64_URL_SAFE_NO_PAD.decode(text).ok()?).ok();
    let wrong = || {
        let message = "is not the value `next` of a page of this list; omit it for the first page";
        Problem::bad_request(format!("after: {message}"))
            .with_fault(Fault::at_field("after", message))
    };
    let after = after.map(|text| key(text).ok_or_else(wrong)).transpose()?;
    Ok(PageRequest { after, limit: limit.unwrap_or_default().get() })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_cursor_is_taken_back_and_nothing_else_is() {
        let key = (Some(0.1 + 0.2), "a/b".to_owned());
        let text = encode_cursor(&key).unwrap();
        assert!(
            text.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'-' || byte == b'_')
        );
        assert_eq!(
            parse_page(None, Some(&text.parse().unwrap())).unwrap(),
            PageRequest { after: Some(key), limit: 100 }
        );
        for wrong in ["7", "mariner", &encode_cursor(&7).unwrap()] {
            let problem = parse_page::<String>(None, Some(&wrong.parse().unwrap())).unwrap_err();
            assert_eq!(
                (problem.status, problem.errors[0].field.as_deref()),
                (400, Some("after")),
                "{wrong}"
            );
        }
    }
}
