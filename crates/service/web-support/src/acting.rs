//! Whoever the present request is carried out for.

use std::future::Future;
use std::sync::Arc;

use sistership_auth::Rights;
use sistership_store::Actor;

tokio::task_local! {
    static ACTING: Acting;
}

/// How somebody has shown who they are.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Kind {
    /// By being on this machine, on a server that asks nobody.
    Local,
    /// By the server's one API key.
    ServerKey,
    /// By a service key.
    Key,
    /// By signing in; with the token that forms of this session send, and the session's hash.
    Session {
        /// What the session's forms send.
        form_token: String,
        /// The hash of the session's secret.
        sha256: String,
    },
}

/// Somebody with their rights.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Principal {
    /// As the audit names them.
    pub name: String,
    /// What they may do.
    pub rights: Rights,
    /// How they have shown who they are.
    pub kind: Kind,
}

/// Somebody who asks, from somewhere.
#[derive(Debug, Clone)]
pub struct Acting {
    /// Who.
    pub principal: Arc<Principal>,
    /// From where, as the audit has it.
    pub origin: String,
}

impl Principal {
    /// Somebody who may do everything.
    pub fn owner(name: &str, kind: Kind) -> Self {
        Self { name: name.to_owned(), rights: Rights::all(), kind }
    }
}

impl Acting {
    /// Carries something out for this one: what the store keeps bears the name.
    pub async fn scope<T>(self, work: impl Future<Output = T>) -> T {
        let actor = Actor::new(self.principal.name.clone(), self.origin.clone());
        ACTING.scope(self, actor.acting(work)).await
    }
}

/// Whoever the present task works for; nobody outside of a request.
pub fn current() -> Option<Acting> {
    ACTING.try_with(Clone::clone).ok()
}

/// Work for a task of its own, that goes on in the same name.
pub fn carried<T>(work: impl Future<Output = T>) -> impl Future<Output = T> {
    let acting = current();
    async move {
        match acting {
            Some(acting) => acting.scope(work).await,
            None => work.await,
        }
    }
}
