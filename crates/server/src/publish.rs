//! The models that a ship's own document publishes, as versions of her line.

use sistership_model::version::sha256;
use sistership_model::{Vessel, Zoo};
use sistership_store::{Alias, AliasMove, Expect, NewVersion, Store, StoreError};

use crate::archive::document;
use crate::derive::published_document;
use crate::problem::{Problem, Result};
use crate::version::VersionDocument;

/// The alias that the product is asked for.
pub(crate) const CHAMPION: &str = "champion";
/// The alias of the last refinement that is not the champion.
pub(crate) const CANDIDATE: &str = "candidate";
/// The alias of the last version. Everyone who makes a version moves it, so that the number that a version is going to
/// have is known beforehand.
pub(crate) const LATEST: &str = "latest";
/// How a published version is made.
const METHOD: &str = "published-source";
const PUBLISHED: &str = "published-";
const REASON: &str = "published with the ship's document";
/// How often another process may get in between.
const TRIES: usize = 5;

/// The alias of a published model, by which `ship/model` is found among the versions.
pub(crate) fn alias_of(model: &str) -> String {
    format!("{PUBLISHED}{model}")
}

/// Makes a version of each published model that is new or has changed; the first becomes champion where there is none.
pub(crate) async fn publish(store: &Store, zoo: &Zoo, vessel: &Vessel, ship_document: &str) -> Result<()> {
    for file in &vessel.file.models {
        let no_law = || Problem::internal(format!("there is no law `{}`", file.law));
        let law = zoo.law(&file.law).ok_or_else(no_law)?;
        let text = zoo.law_text(&file.law).unwrap_or_default();
        let published = published_document(vessel, &file.name, law, &sha256(ship_document.as_bytes()), &sha256(text.as_bytes()))?;
        let new = NewVersion {
            model: vessel.name().to_owned(),
            parent: None,
            law: file.law.clone(),
            method: METHOD.to_owned(),
            document: published.canonical().map_err(Problem::internal)?,
        };
        put(store, &new, &file.name, &published).await?;
    }
    Ok(())
}

async fn put(store: &Store, new: &NewVersion, name: &str, published: &VersionDocument) -> Result<()> {
    for _ in 0..TRIES {
        let current = alias(store, &new.model, &alias_of(name)).await?;
        if let Some(current) = &current
            && same(store, current, published).await?
        {
            return Ok(());
        }
        match store.versions().create(new, &moves(store, &new.model, name, current).await?).await {
            // Another process was first; see what it has done.
            Err(StoreError::PreconditionFailed { .. }) => {}
            other => return Ok(other.map(drop)?),
        }
    }
    Err(Problem::internal(format!("the published models of `{}` kept changing", new.model)))
}

async fn moves(store: &Store, model: &str, name: &str, current: Option<Alias>) -> Result<Vec<AliasMove>> {
    let standing = Standing::of(store, model).await?;
    let mut moves = vec![step(&alias_of(name), expected(current.as_ref()), REASON), standing.follow(REASON)];
    if !standing.champion {
        moves.push(step(CHAMPION, Expect::Absent, REASON));
    }
    Ok(moves)
}

/// Whether the version that stands for a published model has the same model by the same law.
async fn same(store: &Store, current: &Alias, published: &VersionDocument) -> Result<bool> {
    let there = document(&store.versions().get(&current.model, current.version_number).await?)?;
    Ok(there.model == published.model && there.recipe.law_sha256() == published.recipe.law_sha256())
}

/// A move of an alias by the server itself.
pub(crate) fn step(alias: &str, expect: Expect, reason: &str) -> AliasMove {
    AliasMove { alias: alias.to_owned(), expect, reason: reason.to_owned(), actor: "sistership".to_owned() }
}

fn expected(current: Option<&Alias>) -> Expect {
    current.map_or(Expect::Absent, |alias| Expect::Revision(alias.revision))
}

/// Whether an alias is the server's own business.
pub(crate) fn is_reserved(alias: &str) -> bool {
    alias == LATEST || alias.starts_with(PUBLISHED)
}

/// Where a line of versions stands before the next one.
pub(crate) struct Standing {
    /// Whether it has a champion.
    pub champion: bool,
    /// The number that the next version gets, as long as [`Standing::follow`] can be made.
    pub next: i64,
    latest: Option<Alias>,
}

impl Standing {
    pub(crate) async fn of(store: &Store, model: &str) -> Result<Self> {
        let latest = alias(store, model, LATEST).await?;
        let champion = alias(store, model, CHAMPION).await?.is_some();
        Ok(Self { champion, next: latest.as_ref().map_or(1, |alias| alias.version_number + 1), latest })
    }

    /// The move that goes with every new version; it fails where another version was first.
    pub(crate) fn follow(&self, reason: &str) -> AliasMove {
        step(LATEST, expected(self.latest.as_ref()), reason)
    }
}

/// Where an alias stands, if it exists.
pub(crate) async fn alias(store: &Store, model: &str, alias: &str) -> Result<Option<Alias>> {
    match store.aliases().get(model, alias).await {
        Ok(alias) => Ok(Some(alias)),
        Err(StoreError::NotFound { .. }) => Ok(None),
        Err(error) => Err(error.into()),
    }
}
