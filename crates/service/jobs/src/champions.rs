//! Eligible source models of a refinement: the same answer for pages, for `similar` over HTTP and
//! on the command line, and for the selection of a source. A ship provides its champion if that is
//! not the published model, because a refined sister ship is the best source; else its published
//! model.

use std::collections::BTreeMap;
use std::sync::Arc;

use sistership_model::trial::Trial;
use sistership_model::{Model, Vessel, Zoo};
use sistership_priors::similarity::{RankedSource, VectorDefinition};
use sistership_priors::source::{SimilarityRanking, rank_similar, rank_similar_with};
use sistership_store::Version;

use crate::archive::{Archive, version_document};
use crate::error::DeriveError;
use crate::recipe::DerivationRecipe;

type Result<T> = std::result::Result<T, DeriveError>;

/// Number of champions whose documents are read at once.
const READ_BATCH: usize = 25;

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
    pub async fn for_zoo(archive: &Archive, zoo: &Zoo) -> Result<Self> {
        let ships: Vec<String> = zoo.vessels().map(|vessel| vessel.name().to_owned()).collect();
        Self::for_ships(archive, zoo, &ships).await
    }

    /// Reads the champions of some ships.
    ///
    /// # Errors
    /// Returns an error if the store does not answer.
    pub async fn for_ships(archive: &Archive, zoo: &Zoo, ships: &[String]) -> Result<Self> {
        let mut models = Self::default();
        for some in ships.chunks(READ_BATCH) {
            for version in archive.store.list_champions(some).await? {
                models.add_champion(zoo, &version);
            }
        }
        Ok(models)
    }

    fn add_champion(&mut self, zoo: &Zoo, version: &Version) {
        let ship = version.head.model.clone();
        match champion_as_source(zoo, version) {
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
    pub fn rank_sources(
        &self,
        zoo: &Zoo,
        target: &Vessel,
        definition: Option<VectorDefinition>,
        trials: &[&Trial],
    ) -> SimilarityRanking {
        self.explain_ineligible(rank_similar_with(zoo, target, definition, trials, &self.champions))
    }

    /// Adds to a ranking the reason for which a champion is not eligible.
    pub fn explain_ineligible(&self, mut similarity: SimilarityRanking) -> SimilarityRanking {
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
    pub async fn source_version(&self, archive: &Archive, ship: &str) -> Result<Option<Version>> {
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
    let ships = run_blocking(move || {
        let ranking = rank_similar(&near, &named, None, &[]).ranking.into_iter();
        ranking.take(count).map(|ranked| ranked.ship).collect::<Vec<_>>()
    });
    let models = SourceModels::for_ships(archive, &zoo, &ships.await?).await?;
    run_blocking(move || {
        let mut ranking = models.rank_sources(&zoo, &target, None, &[]).ranking;
        ranking.truncate(count);
        ranking
    })
    .await
}

async fn run_blocking<T: Send + 'static>(work: impl FnOnce() -> T + Send + 'static) -> Result<T> {
    Ok(tokio::task::spawn_blocking(work).await?)
}

/// Returns the model that a champion provides as a source; `None` for the published model, which
/// the zoo has already.
///
/// # Errors
/// Returns the reason for which it is not eligible. A damaged champion must not prevent the use of
/// the others.
fn champion_as_source(zoo: &Zoo, version: &Version) -> std::result::Result<Option<Model>, String> {
    let number = version.head.number;
    let document = version_document(version)
        .map_err(|error| format!("its champion, version {number}, cannot be read: {error}"))?;
    if matches!(
        document.recipe,
        DerivationRecipe::Plain(sistership_model::version::VersionRecipe::Published { .. })
    ) {
        return Ok(None);
    }
    // The learned correction is specific to the ship's own trials and is removed.
    let model = document.model.without_correction();
    if let Some(effect) = model.effects.first() {
        // An effect was identified for one ship in its own trials and does not transfer.
        return Err(format!(
            "its champion, version {number}, has the effect {}, which cannot be transferred",
            effect.name
        ));
    }
    match zoo.law(&model.law) {
        Some(_) => Ok(Some(model)),
        None => Err(format!(
            "its champion, version {number}, has the law {}, which is not in the store",
            model.law
        )),
    }
}
