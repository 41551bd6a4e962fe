//! What every page has around its content: navigation, style, script and the policy that allows
//! nothing else.

use std::sync::LazyLock;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use sha2::{Digest as _, Sha256};

/// The style of every page.
pub(crate) const STYLE: &str = include_str!("../templates/style.css");
/// The script of every page; each page is complete without it.
pub(crate) const SCRIPT: &str = include_str!("../templates/script.js");

/// The name of the field in which a form sends its token.
pub const TOKEN: &str = "form_token";

/// The places of the navigation.
const PLACES: [(&str, &str); 8] = [
    ("/", "Fleet"),
    ("/compare", "Compare"),
    ("/playground", "Playground"),
    ("/families", "Families"),
    ("/zoo", "Zoo"),
    ("/jobs", "Jobs"),
    ("/users", "Users"),
    ("/audit", "Audit"),
];
/// Those for admins.
const ADMINS: [&str; 2] = ["/users", "/audit"];

/// What is around the content of a page.
#[derive(Debug, Clone, Default)]
pub struct Shell {
    /// The place in the navigation; empty where it is none of them.
    pub(crate) place: &'static str,
    /// What forms send, so that no other web site can send them.
    pub(crate) token: String,
    /// Who looks at it, where anybody has said.
    pub(crate) signed_in: Option<SignedIn>,
}

/// Who looks at a page.
#[derive(Debug, Clone)]
pub struct SignedIn {
    /// As the audit names them.
    pub name: String,
    /// Whether they give rights, and read the audit.
    pub is_admin: bool,
    /// Whether they can sign out.
    pub by_session: bool,
}

impl Shell {
    /// For pages whose forms send this token.
    pub fn new(token: impl Into<String>) -> Self {
        Self { place: "", token: token.into(), signed_in: None }
    }

    /// The same with who looks at it.
    #[must_use]
    pub fn with(self, signed_in: Option<SignedIn>) -> Self {
        Self { signed_in, ..self }
    }

    /// Whether whoever looks at it has signed in.
    pub(crate) fn by_session(&self) -> bool {
        self.signed_in.as_ref().is_some_and(|who| who.by_session)
    }

    /// The places of the navigation that this one may go to.
    pub(crate) fn places(&self) -> Vec<(&'static str, &'static str)> {
        let admin = self.signed_in.as_ref().is_none_or(|who| who.is_admin);
        PLACES.into_iter().filter(|(place, _)| admin || !ADMINS.contains(place)).collect()
    }

    /// Whether it is at this place.
    pub(crate) fn is_at(&self, place: &str) -> bool {
        self.place == place
    }

    /// At a place of the navigation.
    pub(crate) fn at(self, place: &'static str) -> Self {
        Self { place, ..self }
    }
}

/// What a page may load and do: its own style and script by their hashes (Content Security Policy
/// Level 3, W3C), requests and forms to this server, and nothing else.
pub fn policy() -> &'static str {
    static POLICY: LazyLock<String> = LazyLock::new(|| {
        let hash = |text: &str| BASE64_STANDARD.encode(Sha256::digest(text.as_bytes()));
        format!(
            "default-src 'none'; style-src 'sha256-{}'; script-src 'sha256-{}'; \
             connect-src 'self'; form-action 'self'; base-uri 'none'; frame-ancestors 'none'",
            hash(STYLE),
            hash(SCRIPT)
        )
    });
    &POLICY
}
