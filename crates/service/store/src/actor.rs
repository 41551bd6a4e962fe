//! Who does what is written: whoever the present task works for.

use std::future::Future;

tokio::task_local! {
    static ACTING: Actor;
}

/// The name of the program itself, where nobody has asked it.
const PROGRAM: &str = "sistership";
/// Whoever has the archive's own files: what commands do on them.
const COMMAND_LINE: &str = "command-line";

/// Somebody who changes what is kept.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Actor {
    /// A user's name, `key:PREFIX` of a service key, or one of the names that no user may have.
    pub name: String,
    /// From where: an address, a job, a process.
    pub origin: String,
}

impl Actor {
    /// Somebody of this name who asks from there.
    pub fn new(name: impl Into<String>, origin: impl Into<String>) -> Self {
        Self { name: name.into(), origin: origin.into() }
    }

    /// A command on the archive's own files.
    pub fn command_line() -> Self {
        Self::new(COMMAND_LINE, format!("process {}", std::process::id()))
    }

    /// Whoever the present task works for; the program itself where nobody is named.
    pub fn current() -> Self {
        let program = || Self::new(PROGRAM, format!("process {}", std::process::id()));
        ACTING.try_with(Clone::clone).unwrap_or_else(|_| program())
    }

    /// Does something in this one's name. Tasks that the work spawns must be given it anew.
    pub async fn acting<T>(self, work: impl Future<Output = T>) -> T {
        ACTING.scope(self, work).await
    }

    /// Whether it is no person and no key: the program, or whoever has the archive's own files and
    /// with them every right.
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
        let seen = ann.clone().acting(async { Actor::current() }).await;
        assert_eq!(seen, ann);
        let inner = Actor::command_line().acting(async { Actor::current() });
        assert!(ann.acting(inner).await.is_program());
    }
}
