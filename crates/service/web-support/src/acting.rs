//! The authenticated principal of the present request.

use std::future::Future;
use std::sync::Arc;

use sistership_auth::Rights;
use sistership_store::Actor;

use crate::trace_context::current_trace_parent;

tokio::task_local! {
    static ACTING: RequestActor;
}

/// Method of authentication.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum AuthenticationKind {
    /// Access from this machine, on a server without authentication.
    Local,
    /// The server's API key.
    ServerKey,
    /// A service key.
    Key,
    /// A session of a signed-in user.
    Session {
        /// Token that the session's forms must send.
        form_token: String,
        /// Hash of the session's secret.
        sha256: String,
    },
}

/// An authenticated user or key with its rights.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Principal {
    /// Name, as in the audit.
    pub name: String,
    /// Rights.
    pub rights: Rights,
    /// Method of authentication.
    pub kind: AuthenticationKind,
}

/// Principal and origin of a request.
#[derive(Debug, Clone)]
pub struct RequestActor {
    /// Principal.
    pub principal: Arc<Principal>,
    /// Origin, as in the audit.
    pub origin: String,
}

impl Principal {
    /// Creates a principal with all rights.
    pub fn with_all_rights(name: &str, kind: AuthenticationKind) -> Self {
        Self { name: name.to_owned(), rights: Rights::full_access(), kind }
    }
}

impl RequestActor {
    /// Runs a future in the name of this principal, which is also the author of changes in the
    /// store.
    pub async fn run_scoped<T>(self, work: impl Future<Output = T>) -> T {
        let actor = Actor::new(self.principal.name.clone(), self.origin.clone())
            .with_trace_parent(current_trace_parent());
        ACTING.scope(self, actor.run_scoped(work)).await
    }
}

/// Returns the principal of the present task; none outside of a request.
pub fn current_actor() -> Option<RequestActor> {
    ACTING.try_with(Clone::clone).ok()
}

/// Wraps work for a spawned task, so that it continues in the name of the present principal.
pub fn carry_actor<T>(work: impl Future<Output = T>) -> impl Future<Output = T> {
    // Read here, in the calling task: inside the spawned one it would be absent.
    let acting = current_actor();
    async move {
        match acting {
            Some(acting) => acting.run_scoped(work).await,
            None => work.await,
        }
    }
}
