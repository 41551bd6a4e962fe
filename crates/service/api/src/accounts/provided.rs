//! Sign-in at an OpenID provider: mapping of its identities to users.

use http::{HeaderMap, StatusCode};
use std::time::Instant;

use sistership_auth::openid::{
    CallbackQuery, OpenIdProvider, SignInFailure, SignInPurpose, SignInResult, SignInStart,
};
use sistership_auth::{Grant, Rights, SignInAttempt, hash_text, random_secret, to_hex};
use sistership_store::{Actor, SignIn, User};
use sistership_web_support::problem::{Problem, Result};

use crate::accounts::credentials::Accounts;
use crate::accounts::grants::{grant_rows, principal_rights};
use crate::accounts::users::SESSION_LIFETIME;

/// Author in the audit of accounts and roles that a provider gives, and of refused sign-ins.
const PROVIDER_ACTOR: &str = "openid";
/// One second, µs.
const SECOND_US: i64 = 1_000_000;

/// Result of a sign-in at a provider.
#[derive(Clone, PartialEq, Eq)]
pub enum SignInOutcome {
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
type Admission = std::result::Result<String, String>;

impl Accounts<'_> {
    fn openid_provider(&self) -> Result<&OpenIdProvider> {
        let none = || {
            Problem::not_found(
                "this server has no OpenID provider; sign in with name \
                                          and password",
            )
        };
        self.credentials.provider().ok_or_else(none)
    }

    /// Begins a sign-in at the provider.
    ///
    /// # Errors
    /// Returns an error if there is no provider, or if it cannot be reached.
    pub async fn begin_at_provider(
        &self,
        purpose: SignInPurpose,
        next: &str,
    ) -> Result<SignInStart> {
        let provider = self.openid_provider()?;
        let begun = provider.begin_sign_in(purpose, next, self.store.now_us() / SECOND_US).await;
        begun.map_err(|failure| log_failure(provider, &failure, "nobody"))
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
    ) -> Result<SignInOutcome> {
        let provider = self.openid_provider()?;
        let now_s = self.store.now_us() / SECOND_US;
        let done = provider.finish_sign_in(ticket, &CallbackQuery::read(query), now_s).await;
        let done = done.map_err(|failure| log_failure(provider, &failure, from))?;
        match &done.purpose {
            SignInPurpose::Link(user) => self.link_identity(user, &done, headers, from).await,
            SignInPurpose::SignIn => self.admit_identity(provider, &done, from).await,
        }
    }

    async fn link_identity(
        &self,
        user: &str,
        done: &SignInResult,
        headers: &HeaderMap,
        from: &str,
    ) -> Result<SignInOutcome> {
        // The browser that comes back must have the session of the same user: a link made by
        // somebody else must not add an identity to the account.
        let session = self.by_session(headers).await?.filter(|principal| principal.name == user);
        if session.is_none() {
            let why = format!("sign in as {user} again, and link the account on its page");
            return Err(Problem::new(StatusCode::UNAUTHORIZED, why));
        }
        let actor = Actor::new(user, from);
        actor.run_scoped(self.store.identities().link_identity(user, sign_in_row(done))).await?;
        Ok(SignInOutcome::Linked)
    }

    async fn admit_identity(
        &self,
        provider: &OpenIdProvider,
        done: &SignInResult,
        from: &str,
    ) -> Result<SignInOutcome> {
        let whom = format!("identity {} {}", done.identity.issuer, done.identity.subject);
        let attempts = &self.credentials.attempts;
        // Refusals are counted for each identity, and only they: other outcomes take the attempt
        // back.
        let attempt = SignInAttempt { name: &whom, from: PROVIDER_ACTOR };
        attempts.begin_attempt(attempt, Instant::now()).map_err(|wait| {
            let why =
                format!("too many refused sign-ins; try again in {} s", wait.as_secs().max(1));
            Problem::new(StatusCode::TOO_MANY_REQUESTS, why)
        })?;
        let by_provider = Actor::new(PROVIDER_ACTOR, from);
        let admitted = by_provider.clone().run_scoped(self.user_of(provider, done)).await;
        if !matches!(admitted, Ok(Err(_))) {
            attempts.withdraw_attempt(attempt, Instant::now());
        }
        match admitted? {
            Ok(user) => {
                let secret = random_secret().map_err(Problem::internal)?;
                let ends = i64::try_from(SESSION_LIFETIME.as_micros()).unwrap_or(i64::MAX);
                let until = self.store.now_us().saturating_add(ends);
                let (identities, hash) = (self.store.identities(), to_hex(&hash_text(&secret)));
                let begun = identities.begin_session(&hash, &user, until, sign_in_row(done));
                Actor::new(user.as_str(), from).run_scoped(begun).await?;
                Ok(SignInOutcome::SignedIn { secret, next: done.next.clone() })
            }
            Err(why) => {
                by_provider
                    .run_scoped(self.store.identities().record_refusal(sign_in_row(done), &why))
                    .await?;
                Err(Problem::new(StatusCode::FORBIDDEN, why))
            }
        }
    }

    /// Returns the user of an identity; creates one, with the configured roles, if the settings
    /// allow it.
    async fn user_of(&self, provider: &OpenIdProvider, done: &SignInResult) -> Result<Admission> {
        let (identity, admission) = (&done.identity, provider.settings().admission_rules());
        let roles = admission.granted_roles(&identity.claims);
        let found = self.store.identities().find(&identity.issuer, &identity.subject).await?;
        // An unknown identity is created or refused, by the settings.
        let Some(found) = found else { return self.create_user_of(provider, done, &roles).await };
        let user = self.store.users().get(&found.user_name).await?;
        if !user.is_enabled() {
            return Ok(Err("your account is disabled; ask an admin to enable it".to_owned()));
        }
        // Roles that come from groups are set anew at each sign-in.
        if admission.by_groups() {
            let principal = User::principal_name(&user.name);
            if principal_rights(self.store, &principal).await? != Rights::new(roles.clone()) {
                self.set_roles(&principal, &roles).await?;
            }
            if roles.is_empty() {
                return Ok(Err(no_group_message(provider)));
            }
        }
        Ok(Ok(user.name))
    }

    async fn create_user_of(
        &self,
        provider: &OpenIdProvider,
        done: &SignInResult,
        roles: &[Grant],
    ) -> Result<Admission> {
        let (identity, settings) = (&done.identity, provider.settings());
        let title = settings.title();
        if !settings.admission_rules().auto_create {
            return Ok(Err(format!(
                "you are signed in at {title}, but no account here is linked with it: sign in \
                 with your password and link your account on its page, or ask an admin to link it"
            )));
        }
        if roles.is_empty() {
            return Ok(Err(no_group_message(provider)));
        }
        let name = match settings.admission_rules().account_name(&identity.claims) {
            Ok(name) => name,
            Err(failure) => return Ok(Err(failure.to_string())),
        };
        if self.store.users().find(&name).await?.is_some() {
            return Ok(Err(format!(
                "the account `{name}` exists but is not linked with {title}: if it is yours, sign \
                 in with its password and link it on its page, or ask an admin to link it"
            )));
        }
        let called = identity.display_name().unwrap_or(&name);
        let identities = self.store.identities();
        identities.create_user(&name, called, &grant_rows(roles), sign_in_row(done)).await?;
        Ok(Ok(name))
    }
}

fn no_group_message(provider: &OpenIdProvider) -> String {
    format!(
        "none of your groups at {} has a role here; ask an admin for one",
        provider.settings().title()
    )
}

/// A sign-in in the form of the store.
fn sign_in_row(done: &SignInResult) -> SignIn<'_> {
    let expires_us = done.until_s.saturating_mul(SECOND_US);
    let (issuer, subject) = (done.identity.issuer.as_str(), done.identity.subject.as_str());
    SignIn { issuer, subject, sha256: &done.sha256, expires_us }
}

/// Answer for a failure. It is logged as well, since it belongs to no user and so to no audit.
fn log_failure(provider: &OpenIdProvider, failure: &SignInFailure, from: &str) -> Problem {
    tracing::warn!(issuer = provider.settings().issuer(), from, %failure, "nobody signed in");
    let status = match failure {
        SignInFailure::Unreachable(_) | SignInFailure::Provider(_) => {
            StatusCode::SERVICE_UNAVAILABLE
        }
        SignInFailure::Denied | SignInFailure::Refused(_) => StatusCode::FORBIDDEN,
        SignInFailure::Expired | SignInFailure::Untrusted(_) | SignInFailure::Lacking(_) => {
            StatusCode::UNAUTHORIZED
        }
    };
    Problem::new(status, failure.to_string())
}
