//! Publication of the models of a ship's own document as versions.

use sistership_model::version::sha256_hex;
use sistership_model::{Vessel, Zoo};
use sistership_store::{Alias, AliasMove, ExpectedRevision, NewVersion, Store, StoreError};

use crate::aliases::{
    CHAMPION, VersionHistory, expect_unchanged, find_alias, published_alias, server_move,
};
use crate::archive::version_document;
use crate::derive::published_document;
use crate::error::DeriveError;
use crate::version::VersionDocument;

type Result<T> = std::result::Result<T, DeriveError>;

/// Method name of a published version.
const METHOD: &str = "published-source";
const REASON: &str = "published with the ship's document";
/// Number of attempts when other processes write at the same time.
const MAX_ATTEMPTS: usize = 5;

/// Creates a version of each published model that is new or has changed; the first becomes champion
/// if there is none.
pub async fn publish_models(
    store: &Store,
    zoo: &Zoo,
    vessel: &Vessel,
    ship_document: &str,
) -> Result<()> {
    for file in &vessel.file.models {
        let no_law = || DeriveError::Unexpected(format!("there is no law `{}`", file.law));
        let law = zoo.law(&file.law).ok_or_else(no_law)?;
        let text = zoo.law_text(&file.law).unwrap_or_default();
        let published = published_document(
            vessel,
            &file.name,
            law,
            &sha256_hex(ship_document.as_bytes()),
            &sha256_hex(text.as_bytes()),
        )?;
        let new = NewVersion {
            model: vessel.name().to_owned(),
            parent: None,
            law: file.law.clone(),
            method: METHOD.to_owned(),
            document: published.to_canonical_json()?,
            weights: None,
        };
        create_version(store, &new, &file.name, &published).await?;
    }
    Ok(())
}

async fn create_version(
    store: &Store,
    new: &NewVersion,
    name: &str,
    published: &VersionDocument,
) -> Result<()> {
    // Optimistic concurrency: the version is created only if its aliases have not moved since they
    // were read.
    for _ in 0..MAX_ATTEMPTS {
        let current = find_alias(store, &new.model, &published_alias(name)).await?;
        if let Some(current) = &current
            && is_same_model(store, current, published).await?
        {
            return Ok(());
        }
        match store
            .versions()
            .create(new, &alias_moves(store, &new.model, name, current).await?)
            .await
        {
            // Another process was first: read the aliases again.
            Err(StoreError::PreconditionFailed { .. }) => {}
            other => return Ok(other.map(drop)?),
        }
    }
    Err(DeriveError::Unexpected(format!(
        "the published models of `{}` were changed at the same \
                                         time; try again",
        new.model
    )))
}

async fn alias_moves(
    store: &Store,
    model: &str,
    name: &str,
    current: Option<Alias>,
) -> Result<Vec<AliasMove>> {
    let standing = VersionHistory::read_current(store, model).await?;
    let mut moves = vec![
        server_move(&published_alias(name), expect_unchanged(current.as_ref()), REASON),
        standing.move_latest(REASON),
    ];
    // The first published model of a ship without champion becomes the version in use.
    if !standing.champion {
        moves.push(server_move(CHAMPION, ExpectedRevision::Absent, REASON));
    }
    Ok(moves)
}

/// Returns true if the version of a published model has the same model and the same law.
async fn is_same_model(
    store: &Store,
    current: &Alias,
    published: &VersionDocument,
) -> Result<bool> {
    let there =
        version_document(&store.versions().get(&current.model, current.version_number).await?)?;
    Ok(there.model == published.model && there.recipe.law_sha256() == published.recipe.law_sha256())
}
