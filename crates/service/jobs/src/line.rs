//! Where a ship's line of versions stands: its aliases, and how they move with a new version.

use sistership_store::{Alias, AliasMove, Expect, Store, StoreError};

type Result<T> = std::result::Result<T, StoreError>;

/// The alias that the product is asked for.
pub const CHAMPION: &str = "champion";
/// The alias of the last refinement that is not the champion.
pub const CANDIDATE: &str = "candidate";
/// The alias of the last version. Everyone who makes a version moves it, so that the number that a
/// version is going to have is known beforehand.
pub const LATEST: &str = "latest";
const PUBLISHED: &str = "published-";

/// The alias of a published model, by which `ship/model` is found among the versions.
pub fn alias_of(model: &str) -> String {
    format!("{PUBLISHED}{model}")
}

/// A move of an alias by the server itself.
pub fn step(alias: &str, expect: Expect, reason: &str) -> AliasMove {
    AliasMove {
        alias: alias.to_owned(),
        expect,
        reason: reason.to_owned(),
        actor: "sistership".to_owned(),
    }
}

/// What an alias must still be while it is moved.
pub fn expected(current: Option<&Alias>) -> Expect {
    current.map_or(Expect::Absent, |alias| Expect::Revision(alias.revision))
}

/// Whether an alias is the server's own business.
pub fn is_reserved(alias: &str) -> bool {
    alias == LATEST || alias.starts_with(PUBLISHED)
}

/// Where a line of versions stands before the next one.
pub struct Standing {
    /// Whether it has a champion.
    pub champion: bool,
    /// Whether a version becomes champion only by the word of somebody else than who made it.
    pub second_person: bool,
    /// The number that the next version gets, as long as [`Standing::follow`] can be made.
    pub next: i64,
    latest: Option<Alias>,
}

impl Standing {
    /// Reads where it stands.
    ///
    /// # Errors
    /// The store does not answer.
    pub async fn of(store: &Store, model: &str) -> Result<Self> {
        let latest = alias(store, model, LATEST).await?;
        let champion = alias(store, model, CHAMPION).await?.is_some();
        Ok(Self {
            champion,
            second_person: store.settings().second_person().await?,
            next: latest.as_ref().map_or(1, |alias| alias.version_number + 1),
            latest,
        })
    }

    /// The move that goes with every new version; it fails where another version was first.
    pub fn follow(&self, reason: &str) -> AliasMove {
        step(LATEST, expected(self.latest.as_ref()), reason)
    }
}

/// Where an alias stands, if it exists.
pub async fn alias(store: &Store, model: &str, alias: &str) -> Result<Option<Alias>> {
    match store.aliases().get(model, alias).await {
        Ok(alias) => Ok(Some(alias)),
        Err(StoreError::NotFound { .. }) => Ok(None),
        Err(error) => Err(error),
    }
}
