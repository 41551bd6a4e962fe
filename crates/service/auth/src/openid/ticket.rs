//! Ticket that a browser keeps from the redirect to the provider until its return: one secret, from
//! which state, nonce and verifier are derived, and the target afterwards, sealed so that its age
//! cannot be forged.

use crate::{constant_time_eq, hash_text, random_secret, sign_message, to_hex};
use base64::Engine as _;
use base64::prelude::BASE64_URL_SAFE_NO_PAD;
use serde::{Deserialize, Serialize};

/// Maximum duration of a sign-in, s.
pub const LIFETIME_S: i64 = 600;

/// Purpose of a sign-in.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SignInPurpose {
    /// Begin a session.
    SignIn,
    /// Link the identity to this user.
    Link(String),
}

/// A sign-in in progress.
#[derive(Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct SignInTicket {
    secret: String,
    /// Start, seconds of the Unix epoch.
    since_s: i64,
    /// Purpose.
    pub purpose: SignInPurpose,
    /// Target of the browser afterwards.
    pub next: String,
}

impl SignInTicket {
    /// Creates a ticket; none if the system gives no random numbers.
    pub fn new(purpose: SignInPurpose, next: &str, since_s: i64) -> Option<Self> {
        Some(Self { secret: random_secret().ok()?, since_s, purpose, next: next.to_owned() })
    }

    /// Returns the `state`, which the provider sends back unchanged: only the answer to this
    /// browser has it.
    pub fn state(&self) -> String {
        sign_message(&self.secret, b"state")
    }

    /// Returns the `nonce`, which shows that the ID token was made for this sign-in.
    pub fn nonce(&self) -> String {
        sign_message(&self.secret, b"nonce")
    }

    /// Returns the PKCE verifier (RFC 7636, 4.1), needed in addition to the code: 64 of the allowed
    /// characters.
    pub fn verifier(&self) -> String {
        sign_message(&self.secret, b"verifier")
    }

    /// Returns the PKCE challenge of [`Self::verifier`] (RFC 7636, 4.2).
    pub fn challenge(&self) -> String {
        BASE64_URL_SAFE_NO_PAD.encode(hash_text(&self.verifier()))
    }

    /// Returns the hash by which a second use is recognised.
    pub fn sha256(&self) -> String {
        to_hex(&hash_text(&self.secret))
    }

    /// Returns the expiry, seconds of the Unix epoch.
    pub fn until_s(&self) -> i64 {
        self.since_s + LIFETIME_S
    }

    /// Returns the ticket as text with a seal, for the browser; none if it cannot be written.
    pub fn to_sealed(&self, key: &str) -> Option<String> {
        let body = BASE64_URL_SAFE_NO_PAD.encode(serde_json::to_vec(self).ok()?);
        let seal = sign_message(key, body.as_bytes());
        Some(format!("{body}.{seal}"))
    }

    /// Reads a sealed ticket; none if the seal is wrong, or it has expired.
    pub fn from_sealed(text: &str, key: &str, now_s: i64) -> Option<Self> {
        let (body, seal) = text.split_once('.')?;
        // The seal is checked before the content is parsed.
        if !constant_time_eq(seal.as_bytes(), sign_message(key, body.as_bytes()).as_bytes()) {
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
        let ticket = SignInTicket::new(SignInPurpose::Link("ann".into()), "/ships", 1000).unwrap();
        let sealed = ticket.to_sealed("key").unwrap();
        assert!(SignInTicket::from_sealed(&sealed, "key", 1000) == Some(ticket.clone()));
        assert!(SignInTicket::from_sealed(&sealed, "key", 1599) == Some(ticket.clone()));
        for (key, now_s) in [("key", 1600), ("key", 999), ("other", 1000), ("", 1000)] {
            assert!(SignInTicket::from_sealed(&sealed, key, now_s).is_none(), "{key} {now_s}");
        }
        let later = SignInTicket { since_s: 2000, ..ticket.clone() };
        let forged = later.to_sealed("key").unwrap().split_once('.').unwrap().0.to_owned();
        let seal = sealed.split_once('.').unwrap().1;
        assert!(SignInTicket::from_sealed(&format!("{forged}.{seal}"), "key", 2000).is_none());
        for wrong in ["", ".", "a.b", &sealed[1..]] {
            assert!(SignInTicket::from_sealed(wrong, "key", 1000).is_none(), "{wrong}");
        }
    }

    #[test]
    fn nothing_that_is_told_tells_anything_else() {
        let ticket = SignInTicket::new(SignInPurpose::SignIn, "/", 0).unwrap();
        let told = [ticket.state(), ticket.nonce(), ticket.challenge(), ticket.sha256()];
        for (index, text) in told.iter().enumerate() {
            assert!(!told[..index].contains(text) && *text != ticket.verifier());
        }
        assert!((43..=128).contains(&ticket.verifier().len()));
    }
}
