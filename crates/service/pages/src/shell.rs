//! Frame of every page around its content: navigation, style, script, and the policy that allows
//! nothing else.

use std::sync::LazyLock;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use sha2::{Digest as _, Sha256};
use sistership_report::{CHART_SCRIPT, CHART_STYLE};

use crate::language::{Message, say};

/// Style sheet of every page.
pub(crate) const STYLE: &str = include_str!("../templates/style.css");
/// Script of every page; each page is complete without it.
pub(crate) const SCRIPT: &str = include_str!("../templates/script.js");

/// Name of the form field with the token.
pub const TOKEN_FIELD: &str = "form_token";

/// Entries of the navigation: path, and key of the name.
const PLACES: [(&str, &str); 8] = [
    ("/", "place-fleet"),
    ("/compare", "place-compare"),
    ("/playground", "place-playground"),
    ("/families", "place-families"),
    ("/zoo", "place-zoo"),
    ("/jobs", "place-jobs"),
    ("/users", "place-users"),
    ("/audit", "place-audit"),
];
/// Entries for admins.
const ADMIN_PLACES: [&str; 2] = ["/users", "/audit"];

/// Frame around the content of a page.
#[derive(Debug, Clone, Default)]
pub struct PageShell {
    /// Entry of the navigation; empty if the page belongs to none.
    pub(crate) place: &'static str,
    /// Token of the forms, which no other web site knows.
    pub(crate) token: String,
    /// User of the page, if one is identified.
    pub(crate) signed_in: Option<PageUser>,
}

/// User of a page.
#[derive(Debug, Clone)]
pub struct PageUser {
    /// Name in the audit.
    pub name: String,
    /// True if the user manages rights and reads the audit.
    pub is_admin: bool,
    /// True if the user can sign out.
    pub by_session: bool,
}

impl PageShell {
    /// Returns the frame of pages whose forms carry this token.
    pub fn new(token: impl Into<String>) -> Self {
        Self { place: "", token: token.into(), signed_in: None }
    }

    /// Returns the frame with a user.
    #[must_use]
    pub fn with_user(self, signed_in: Option<PageUser>) -> Self {
        Self { signed_in, ..self }
    }

    /// Returns true if the user has signed in.
    pub(crate) fn by_session(&self) -> bool {
        self.signed_in.as_ref().is_some_and(|who| who.by_session)
    }

    /// Entries of the navigation that the user may open.
    pub(crate) fn places(&self) -> Vec<(&'static str, Message)> {
        // Without an identified user, on a loopback interface, all entries are shown.
        let admin = self.signed_in.as_ref().is_none_or(|who| who.is_admin);
        let own = PLACES.into_iter().filter(|(place, _)| admin || !ADMIN_PLACES.contains(place));
        own.map(|(place, name)| (place, say(name))).collect()
    }

    /// Returns true if the page belongs to this entry.
    pub(crate) fn is_at(&self, place: &str) -> bool {
        self.place == place
    }

    /// Returns the frame of a page that belongs to an entry of the navigation.
    pub(crate) fn at_place(self, place: &'static str) -> Self {
        Self { place, ..self }
    }
}

/// Content Security Policy of pages: their own styles and scripts by their hashes (Content Security
/// Policy Level 3, W3C), requests and forms to this server, its images and those made by the page itself
/// for download, and nothing else.
pub fn security_policy() -> &'static str {
    static POLICY: LazyLock<String> = LazyLock::new(|| {
        format!(
            "default-src 'none'; style-src {}; script-src {}; img-src 'self' blob:; \
             connect-src 'self'; form-action 'self'; base-uri 'none'; frame-ancestors 'none'",
            allowed_hashes(&[STYLE, CHART_STYLE]),
            allowed_hashes(&[SCRIPT, CHART_SCRIPT])
        )
    });
    &POLICY
}

/// Content Security Policy of a report: its own styles and images, and the script of charts.
pub fn report_policy() -> &'static str {
    static POLICY: LazyLock<String> = LazyLock::new(|| {
        format!(
            "default-src 'none'; style-src 'unsafe-inline'; script-src {}; img-src data: blob:; \
             form-action 'none'; frame-ancestors 'none'",
            allowed_hashes(&[CHART_SCRIPT])
        )
    });
    &POLICY
}

fn allowed_hashes(texts: &[&str]) -> String {
    let hash = |text: &&str| BASE64_STANDARD.encode(Sha256::digest(text.as_bytes()));
    let sources: Vec<String> =
        texts.iter().map(|text| format!("'sha256-{}'", hash(text))).collect();
    sources.join(" ")
}
