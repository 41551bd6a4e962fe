//! Eligible source models of a refinement: the same answer for pages, for `similar` over HTTP and
//! on the command line, and for the selection of a source. A ship provides its champion if that is
//! not the published model, because a refined sister ship is the best source; else its published
//! model.

use std::collections::BTreeMap;
use std::sync::Arc;

use sistership_model::trial::Trial;
use sistership_model::{Model, Vessel, Zoo};
use sistership_priors::similarity::{Definition, RankedSource};
use sistership_priors::source::{Similarity, similar, similar_with};
use sistership_store::Version;

use crate::archive::{Archive, document};
use crate::error::DeriveError;
use crate::recipe::Recipe;

type Result<T> = std::result::Result<T, DeriveError>;

/// Number of champions whose documents are read at once.
const AT_ONCE: usize = 25;

/// Champions that ships of a store provide as source models in place of their published ones.
#[derive(Debug, Clone, Default)]
pub struct SourceModels {
    /// Eligible champions, by ship.
    pub champions: BTreeMap<String, Model>,
    /// Version numbers of these champions, by ship.
    numbers: BTreeMap<String, i64>,
    /// Reason for which the champion of a ship is not eligible, by ship.
    unusable: BTreeMap<String, String>,
}

impl SourceModels {
    /// Reads the champions of every ship of a zoo.
    ///
    /// # Errors
    /// Returns an error if the store does not answer.
    pub async fn read(archive: &Archive, zoo: &Zoo) -> Result<Self> {
        let ships: Vec<String> = zoo.vessels().map(|vessel| vessel.name().to_owned()).collect();
        Self::of_ships(archive, zoo, &ships).await
    }

    /// Reads the champions of some ships.
    ///
    /// # Errors
    /// Returns an error if the store does not answer.
    pub async fn of_ships(archive: &Archive, zoo: &Zoo, ships: &[String]) -> Result<Self> {
        let mut models = Self::default();
        for some in ships.chunks(AT_ONCE) {
            for version in archive.store.champions(some).await? {
                models.add(zoo, &version);
            }
        }
        Ok(models)
    }

    fn add(&mut self, zoo: &Zoo, version: &Version) {
        let ship = version.head.model.clone();
        match source_model(zoo, version) {
            Ok(Some(model)) => {
                self.numbers.insert(ship.clone(), version.head.number);
                self.champions.insert(ship, model);
            }
            Ok(None) => {}
            Err(reason) => {
                self.unusable.insert(ship, reason);
            }
        }
    }

    /// Ranks the ships of a zoo as sources for a target.
    pub fn rank(
        &self,
        zoo: &Zoo,
        target: &Vessel,
        definition: Option<Definition>,
        trials: &[&Trial],
    ) -> Similarity {
        self.explained(similar_with(zoo, target, definition, trials, &self.champions))
    }

    /// Adds to a ranking the reason for which a champion is not eligible.
    pub fn explained(&self, mut similarity: Similarity) -> Similarity {
        for ranked in similarity.ranking.iter_mut().filter(|ranked| ranked.model.is_none()) {
            let reason = self.unusable.get(&ranked.ship);
            // The last reason is the one for the missing model; the champion's reason is more
            // specific.
            if let Some((said, reason)) = ranked.reasons.last_mut().zip(reason) {
                said.clone_from(reason);
            }
        }
        similarity
    }

    /// Returns the version that a ship provides as a source; `None` for its published model.
    ///
    /// # Errors
    /// Returns an error if the store does not answer.
    pub async fn version(&self, archive: &Archive, ship: &str) -> Result<Option<Version>> {
        match self.numbers.get(ship) {
            Some(number) => Ok(Some(archive.store.versions().get(ship, *number).await?)),
            None => Ok(None),
        }
    }
}

/// Returns the ships of a store that are most similar to a target, at most `count`, with the
/// eligibility of each as its source before trials are considered.
///
/// # Errors
/// Returns an error if the store does not answer.
pub async fn most_similar_ships(
    archive: &Archive,
    zoo: Arc<Zoo>,
    target: Vessel,
    count: usize,
) -> Result<Vec<RankedSource>> {
    // Two passes: similarity selects the ships, then only their champions are read.
    let (near, named) = (Arc::clone(&zoo), target.clone());
    let ships = blocking(move || {
        let ranking = similar(&near, &named, None, &[]).ranking.into_iter();
        ranking.take(count).map(|ranked| ranked.ship).collect::<Vec<_>>()
    });
    let models = SourceModels::of_ships(archive, &zoo, &ships.await?).await?;
    blocking(move || {
        let mut ranking = models.rank(&zoo, &target, None, &[]).ranking;
        ranking.truncate(count);
        ranking
    })
    .await
}

async fn blocking<T: Send + 'static>(work: impl FnOnce() -> T + Send + 'static) -> Result<T> {
    Ok(tokio::task::spawn_blocking(work).await?)
}

/// Returns the model that a champion provides as a source; `None` for the published model, which
/// the zoo has already.
///
/// # Errors
/// Returns the reason for which it is not eligible. A damaged champion must not prevent the use of
/// the others.
fn source_model(zoo: &Zoo, version: &Version) -> std::result::Result<Option<Model>, String> {
    let number = version.head.number;
    let document = document(version)
        .map_err(|error| format!("its champion, version {number}, cannot be read: {error}"))?;
    if matches!(document.recipe, Recipe::Plain(sistership_model::version::Recipe::Published { .. }))
    {
        return Ok(None);
    }
    // The learned correction is specific to the ship's own trials and is removed.
    let model = document.model.foundation();
    if let Some(effect) = model.effects.first() {
        // An effect was identified for one ship in its own trials and does not transfer.
        return Err(format!(
            "its champion, version {number}, carries the effect {}, which is its own",
            effect.name
        ));
    }
    match zoo.law(&model.law) {
        Some(_) => Ok(Some(model)),
        None => Err(format!(
            "its champion, version {number}, has the law {}, which is missing",
            model.law
        )),
    }
}
