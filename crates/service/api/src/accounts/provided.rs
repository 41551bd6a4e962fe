//! Sign-in at an OpenID provider: mapping of its identities to users.

use http::{HeaderMap, StatusCode};
use std::time::Instant;

use sistership_auth::openid::{Answer, Begun, Failure, Finished, Provider, Purpose};
use sistership_auth::{Attempt, Grant, Rights, hex, secret, sha256};
use sistership_store::{Actor, SignIn, User};
use sistership_web_support::problem::{Problem, Result};

use crate::accounts::credentials::Accounts;
use crate::accounts::grants::{rights, rows};
use crate::accounts::users::SESSION;

/// Author in the audit of accounts and roles that a provider gives, and of refused sign-ins.
const PROVIDER: &str = "openid";
/// One second, µs.
const SECOND: i64 = 1_000_000;

/// Result of a sign-in at a provider.
#[derive(Clone, PartialEq, Eq)]
pub enum Outcome {
    /// A session began.
    SignedIn {
        /// Secret of the session's cookie.
        secret: String,
        /// Page to go to.
        next: String,
    },
    /// The identity is now linked with the user who is signed in.
    Linked,
}

/// A user's name, or the reason for which the identity is not admitted.
type Admitted = std::result::Result<String, String>;

impl Accounts<'_> {
    fn provider(&self) -> Result<&Provider> {
        let none = || Problem::not_found("people sign in here by name and password only");
        self.credentials.provider().ok_or_else(none)
    }

    /// Begins a sign-in at the provider.
    ///
    /// # Errors
    /// Returns an error if there is no provider, or if it cannot be reached.
    pub async fn begin_at_provider(&self, purpose: Purpose, next: &str) -> Result<Begun> {
        let provider = self.provider()?;
        let begun = provider.begin(purpose, next, self.store.now_us() / SECOND).await;
        begun.map_err(|failure| told(provider, &failure, "nobody"))
    }

    /// Completes a sign-in at the provider; `ticket` is the browser's cookie, `query` that of the
    /// provider's redirect.
    ///
    /// # Errors
    /// Returns an error with the reason, for the person who tried, if the identity cannot be
    /// verified or is not admitted.
    pub async fn finish_at_provider(
        &self,
        ticket: Option<&str>,
        query: &str,
        headers: &HeaderMap,
        from: &str,
    ) -> Result<Outcome> {
        let provider = self.provider()?;
        let now_s = self.store.now_us() / SECOND;
        let done = provider.finish(ticket, &Answer::read(query), now_s).await;
        let done = done.map_err(|failure| told(provider, &failure, from))?;
        match &done.purpose {
            Purpose::Link(user) => self.link(user, &done, headers, from).await,
            Purpose::SignIn => self.admit(provider, &done, from).await,
        }
    }

    async fn link(
        &self,
        user: &str,
        done: &Finished,
        headers: &HeaderMap,
        from: &str,
    ) -> Result<Outcome> {
        // The browser that comes back must have the session of the same user: a link made by
        // somebody else must not add an identity to the account.
        let session = self.session(headers).await?.filter(|principal| principal.name == user);
        if session.is_none() {
            let why = format!("sign in as {user} again, and link from the page of your account");
            return Err(Problem::new(StatusCode::UNAUTHORIZED, why));
        }
        let actor = Actor::new(user, from);
        actor.acting(self.store.identities().add(user, sign_in(done))).await?;
        Ok(Outcome::Linked)
    }

    async fn admit(&self, provider: &Provider, done: &Finished, from: &str) -> Result<Outcome> {
        let whom = format!("identity {} {}", done.identity.issuer, done.identity.subject);
        let attempts = &self.credentials.attempts;
        // Refusals are counted for each identity, and only they: other outcomes take the attempt
        // back.
        let attempt = Attempt { name: &whom, from: PROVIDER };
        attempts.begin(attempt, Instant::now()).map_err(|wait| {
            let why = format!("you were refused often; try again in {} s", wait.as_secs().max(1));
            Problem::new(StatusCode::TOO_MANY_REQUESTS, why)
        })?;
        let by_provider = Actor::new(PROVIDER, from);
        let admitted = by_provider.clone().acting(self.user_of(provider, done)).await;
        if !matches!(admitted, Ok(Err(_))) {
            attempts.withdraw(attempt, Instant::now());
        }
        match admitted? {
            Ok(user) => {
                let secret = secret().map_err(Problem::internal)?;
                let ends = i64::try_from(SESSION.as_micros()).unwrap_or(i64::MAX);
                let until = self.store.now_us().saturating_add(ends);
                let (identities, hash) = (self.store.identities(), hex(&sha256(&secret)));
                let begun = identities.begin_session(&hash, &user, until, sign_in(done));
                Actor::new(user.as_str(), from).acting(begun).await?;
                Ok(Outcome::SignedIn { secret, next: done.next.clone() })
            }
            Err(why) => {
                by_provider.acting(self.store.identities().refuse(sign_in(done), &why)).await?;
                Err(Problem::new(StatusCode::FORBIDDEN, why))
            }
        }
    }

    /// Returns the user of an identity; creates one, with the configured roles, if the settings
    /// allow it.
    async fn user_of(&self, provider: &Provider, done: &Finished) -> Result<Admitted> {
        let (identity, admission) = (&done.identity, provider.settings().admission());
        let roles = admission.roles(&identity.claims);
        let found = self.store.identities().find(&identity.issuer, &identity.subject).await?;
        // An unknown identity is created or refused, by the settings.
        let Some(found) = found else { return self.created(provider, done, &roles).await };
        let user = self.store.users().get(&found.user_name).await?;
        if !user.is_enabled() {
            return Ok(Err("your account here is disabled; ask an admin".to_owned()));
        }
        // Roles that come from groups are set anew at each sign-in.
        if admission.by_groups() {
            let principal = User::principal(&user.name);
            if rights(self.store, &principal).await? != Rights::new(roles.clone()) {
                self.set_roles(&principal, &roles).await?;
            }
            if roles.is_empty() {
                return Ok(Err(without_group(provider)));
            }
        }
        Ok(Ok(user.name))
    }

    async fn created(
        &self,
        provider: &Provider,
        done: &Finished,
        roles: &[Grant],
    ) -> Result<Admitted> {
        let (identity, settings) = (&done.identity, provider.settings());
        let title = settings.title();
        if !settings.admission().auto_create {
            return Ok(Err(format!(
                "{title} knows you, but no account here is yours yet: sign in with your password \
                 and link your account on its page, or ask an admin to link it"
            )));
        }
        if roles.is_empty() {
            return Ok(Err(without_group(provider)));
        }
        let name = match settings.admission().name(&identity.claims) {
            Ok(name) => name,
            Err(failure) => return Ok(Err(failure.to_string())),
        };
        if self.store.users().find(&name).await?.is_some() {
            return Ok(Err(format!(
                "there is an account `{name}` already that is not linked with {title}: if it is \
                 yours, sign in with its password and link it on its page, or ask an admin to link \
                 it"
            )));
        }
        let called = identity.title().unwrap_or(&name);
        let identities = self.store.identities();
        identities.create(&name, called, &rows(roles), sign_in(done)).await?;
        Ok(Ok(name))
    }
}

fn without_group(provider: &Provider) -> String {
    format!(
        "none of your groups at {} may do anything here; ask an admin",
        provider.settings().title()
    )
}

/// A sign-in in the form of the store.
fn sign_in(done: &Finished) -> SignIn<'_> {
    let expires_us = done.until_s.saturating_mul(SECOND);
    let (issuer, subject) = (done.identity.issuer.as_str(), done.identity.subject.as_str());
    SignIn { issuer, subject, sha256: &done.sha256, expires_us }
}

/// Answer for a failure. It is logged as well, since it belongs to no user and so to no audit.
fn told(provider: &Provider, failure: &Failure, from: &str) -> Problem {
    tracing::warn!(issuer = provider.settings().issuer(), from, %failure, "nobody signed in");
    let status = match failure {
        Failure::Unreachable(_) | Failure::Provider(_) => StatusCode::SERVICE_UNAVAILABLE,
        Failure::Denied | Failure::Refused(_) => StatusCode::FORBIDDEN,
        Failure::Expired | Failure::Untrusted(_) | Failure::Lacking(_) => StatusCode::UNAUTHORIZED,
    };
    Problem::new(status, failure.to_string())
}
