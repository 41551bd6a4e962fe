//! Aliases of a ship's versions, and how they move with a new version.

use sistership_store::{Alias, AliasMove, ExpectedRevision, Store, StoreError};

type Result<T> = std::result::Result<T, StoreError>;

/// Alias of the version in use.
pub const CHAMPION: &str = "champion";
/// Alias of the last refinement that is not the champion.
pub const CANDIDATE: &str = "candidate";
/// Alias of the last version. Every operation that creates a version moves it, so that the number
/// of the version is known beforehand.
pub const LATEST: &str = "latest";
const PUBLISHED: &str = "published-";

/// Returns the alias of a published model, by which `ship/model` is found among the versions.
pub fn published_alias(model: &str) -> String {
    format!("{PUBLISHED}{model}")
}

/// Creates a move of an alias in the name of the server.
pub fn server_move(alias: &str, expect: ExpectedRevision, reason: &str) -> AliasMove {
    AliasMove {
        alias: alias.to_owned(),
        expect,
        reason: reason.to_owned(),
        actor: "sistership".to_owned(),
    }
}

/// Returns the precondition that an alias is unchanged when it is moved.
pub fn expect_unchanged(current: Option<&Alias>) -> ExpectedRevision {
    current.map_or(ExpectedRevision::Absent, |alias| ExpectedRevision::Revision(alias.revision))
}

/// Returns true if only the server may move the alias.
pub fn is_reserved(alias: &str) -> bool {
    alias == LATEST || alias.starts_with(PUBLISHED)
}

/// State of a ship's versions before a new one is created.
pub struct VersionHistory {
    /// True if there is a champion.
    pub champion: bool,
    /// True if a version may become champion only by a person other than its author (four-eyes
    /// rule).
    pub second_person: bool,
    /// Number of the next version, valid if its move of `latest` succeeds.
    pub next: i64,
    latest: Option<Alias>,
}

impl VersionHistory {
    /// Reads the state of a ship's versions.
    ///
    /// # Errors
    /// Returns an error if the store does not answer.
    pub async fn read_current(store: &Store, model: &str) -> Result<Self> {
        // No transaction is needed: a version created meanwhile makes the move of `latest` fail.
        let latest = find_alias(store, model, LATEST).await?;
        let champion = find_alias(store, model, CHAMPION).await?.is_some();
        Ok(Self {
            champion,
            second_person: store.settings().requires_second_person().await?,
            next: latest.as_ref().map_or(1, |alias| alias.version_number + 1),
            latest,
        })
    }

    /// Returns the move that belongs to every new version; it fails if another version was created
    /// first.
    pub fn move_latest(&self, reason: &str) -> AliasMove {
        server_move(LATEST, expect_unchanged(self.latest.as_ref()), reason)
    }
}

/// Returns an alias, or `None` if it does not exist.
pub async fn find_alias(store: &Store, model: &str, alias: &str) -> Result<Option<Alias>> {
    match store.aliases().get(model, alias).await {
        Ok(alias) => Ok(Some(alias)),
        Err(StoreError::NotFound { .. }) => Ok(None),
        Err(error) => Err(error),
    }
}
