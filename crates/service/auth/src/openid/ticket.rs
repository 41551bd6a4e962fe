//! What a browser keeps between leaving for the provider and coming back: one secret, from which
//! all that must not be guessed follows, with where to go then, and sealed so that its age is true.

use crate::{hex, same, secret, sha256, sign};
use base64::Engine as _;
use base64::prelude::BASE64_URL_SAFE_NO_PAD;
use serde::{Deserialize, Serialize};

/// For how long a sign-in may be under way, seconds.
pub const LIFETIME_S: i64 = 600;

/// What a sign-in is for.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Purpose {
    /// To begin a session.
    SignIn,
    /// To be known as this user from now on.
    Link(String),
}

/// A sign-in that is under way.
#[derive(Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Ticket {
    secret: String,
    /// Since when, seconds of the Unix epoch.
    since_s: i64,
    /// What for.
    pub purpose: Purpose,
    /// Where to go then.
    pub next: String,
}

impl Ticket {
    /// A new one; none where the system gives no random numbers.
    pub fn new(purpose: Purpose, next: &str, since_s: i64) -> Option<Self> {
        Some(Self { secret: secret().ok()?, since_s, purpose, next: next.to_owned() })
    }

    /// What the provider sends back as it is: only this browser's answer has it.
    pub fn state(&self) -> String {
        sign(&self.secret, b"state")
    }

    /// What the ID token must hold: it was made for this sign-in.
    pub fn nonce(&self) -> String {
        sign(&self.secret, b"nonce")
    }

    /// Who has the code must have this, too (RFC 7636, 4.1): 64 of the letters that it allows.
    pub fn verifier(&self) -> String {
        sign(&self.secret, b"verifier")
    }

    /// What the provider is told of [`Self::verifier`] beforehand (RFC 7636, 4.2).
    pub fn challenge(&self) -> String {
        BASE64_URL_SAFE_NO_PAD.encode(sha256(&self.verifier()))
    }

    /// By what it is known that it has been used.
    pub fn sha256(&self) -> String {
        hex(&sha256(&self.secret))
    }

    /// When it is over, seconds of the Unix epoch.
    pub fn until_s(&self) -> i64 {
        self.since_s + LIFETIME_S
    }

    /// As the browser keeps it.
    pub fn sealed(&self, key: &str) -> Option<String> {
        let body = BASE64_URL_SAFE_NO_PAD.encode(serde_json::to_vec(self).ok()?);
        let seal = sign(key, body.as_bytes());
        Some(format!("{body}.{seal}"))
    }

    /// From what a browser has kept; none where the seal is wrong, or it is over.
    pub fn opened(text: &str, key: &str, now_s: i64) -> Option<Self> {
        let (body, seal) = text.split_once('.')?;
        if !same(seal.as_bytes(), sign(key, body.as_bytes()).as_bytes()) {
            return None;
        }
        let ticket: Self =
            serde_json::from_slice(&BASE64_URL_SAFE_NO_PAD.decode(body).ok()?).ok()?;
        (ticket.since_s <= now_s && now_s < ticket.until_s()).then_some(ticket)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_ticket_is_good_for_its_time_under_its_seal() {
        let ticket = Ticket::new(Purpose::Link("ann".into()), "/ships", 1000).unwrap();
        let sealed = ticket.sealed("key").unwrap();
        assert!(Ticket::opened(&sealed, "key", 1000) == Some(ticket.clone()));
        assert!(Ticket::opened(&sealed, "key", 1599) == Some(ticket.clone()));
        for (key, now_s) in [("key", 1600), ("key", 999), ("other", 1000), ("", 1000)] {
            assert!(Ticket::opened(&sealed, key, now_s).is_none(), "{key} {now_s}");
        }
        let later = Ticket { since_s: 2000, ..ticket.clone() };
        let forged = later.sealed("key").unwrap().split_once('.').unwrap().0.to_owned();
        let seal = sealed.split_once('.').unwrap().1;
        assert!(Ticket::opened(&format!("{forged}.{seal}"), "key", 2000).is_none());
        for wrong in ["", ".", "a.b", &sealed[1..]] {
            assert!(Ticket::opened(wrong, "key", 1000).is_none(), "{wrong}");
        }
    }

    #[test]
    fn nothing_that_is_told_tells_anything_else() {
        let ticket = Ticket::new(Purpose::SignIn, "/", 0).unwrap();
        let told = [ticket.state(), ticket.nonce(), ticket.challenge(), ticket.sha256()];
        for (index, text) in told.iter().enumerate() {
            assert!(!told[..index].contains(text) && *text != ticket.verifier());
        }
        assert!((43..=128).contains(&ticket.verifier().len()));
    }
}
