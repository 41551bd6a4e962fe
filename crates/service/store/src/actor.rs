//! The author of changes: the person, key or program for which the present task works.

use std::future::Future;

tokio::task_local! {
    static ACTING: Actor;
}

/// Author of changes that the program makes by itself, outside of a request.
const PROGRAM: &str = "sistership";
/// Author of changes made by commands that work directly on the archive's files.
const COMMAND_LINE: &str = "command-line";

/// Author of a change to the store.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Actor {
    /// Name of a user, `key:PREFIX` of a service key, or a reserved name of the program.
    pub name: String,
    /// Origin of the request: a network address, a job or a process.
    pub origin: String,
    /// W3C trace context of the request or job, if traces are exported: that of the jobs it queues.
    pub trace_parent: Option<String>,
}

impl Actor {
    /// Creates an author with a name and the origin of the request.
    pub fn new(name: impl Into<String>, origin: impl Into<String>) -> Self {
        Self { name: name.into(), origin: origin.into(), trace_parent: None }
    }

    /// Sets the trace context.
    #[must_use]
    pub fn with_trace_parent(self, trace_parent: Option<String>) -> Self {
        Self { trace_parent, ..self }
    }

    /// Returns the author of commands on the archive's own files.
    pub fn command_line() -> Self {
        Self::new(COMMAND_LINE, format!("process {}", std::process::id()))
    }

    /// Returns the author of the present task; the program itself outside of [`Actor::acting`].
    pub fn current() -> Self {
        let program = || Self::new(PROGRAM, format!("process {}", std::process::id()));
        ACTING.try_with(Clone::clone).unwrap_or_else(|_| program())
    }

    /// Runs a future in the name of this author. A task-local does not follow `tokio::spawn`: tasks
    /// that the work spawns must be wrapped again.
    pub async fn run_scoped<T>(self, work: impl Future<Output = T>) -> T {
        ACTING.scope(self, work).await
    }

    /// Returns true if the author is neither a person nor a key: the program, or a command with
    /// direct access to the archive's files, which has every right.
    pub(crate) fn is_program(&self) -> bool {
        self.name == PROGRAM || self.name == COMMAND_LINE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn a_task_works_for_whoever_is_named() {
        assert!(Actor::current().is_program());
        let ann = Actor::new("ann", "::1");
        let seen = ann.clone().run_scoped(async { Actor::current() }).await;
        assert_eq!(seen, ann);
        let inner = Actor::command_line().run_scoped(async { Actor::current() });
        assert!(ann.run_scoped(inner).await.is_program());
    }
}
