//! Which ships may be the source of a refinement: one answer for pages, for `similar` over HTTP and
//! on the command line, and for the selection of a source. A ship gives its champion where that is
//! more than its published model, for a refined sister is the best source there is; else its
//! published model.

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

/// Champions whose documents are read at once.
const AT_ONCE: usize = 25;

/// The models by which the ships of a store may be sources beside their published ones.
#[derive(Debug, Clone, Default)]
pub struct SourceModels {
    /// Champions that may serve, by ship.
    pub champions: BTreeMap<String, Model>,
    /// The numbers of their versions.
    numbers: BTreeMap<String, i64>,
    /// Why the champion of a ship may not serve.
    unusable: BTreeMap<String, String>,
}

impl SourceModels {
    /// Those of every ship of a zoo.
    ///
    /// # Errors
    /// The store does not answer.
    pub async fn read(archive: &Archive, zoo: &Zoo) -> Result<Self> {
        let ships: Vec<String> = zoo.vessels().map(|vessel| vessel.name().to_owned()).collect();
        Self::of_ships(archive, zoo, &ships).await
    }

    /// Those of some ships.
    ///
    /// # Errors
    /// The store does not answer.
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

    /// A ranking by these champions that says why a champion may not serve.
    pub fn explained(&self, mut similarity: Similarity) -> Similarity {
        for ranked in similarity.ranking.iter_mut().filter(|ranked| ranked.model.is_none()) {
            let reason = self.unusable.get(&ranked.ship);
            if let Some((said, reason)) = ranked.reasons.last_mut().zip(reason) {
                said.clone_from(reason);
            }
        }
        similarity
    }

    /// The version that a ship gives as a source; none where that is its published model.
    ///
    /// # Errors
    /// The store does not answer.
    pub async fn version(&self, archive: &Archive, ship: &str) -> Result<Option<Version>> {
        match self.numbers.get(ship) {
            Some(number) => Ok(Some(archive.store.versions().get(ship, *number).await?)),
            None => Ok(None),
        }
    }
}

/// The ships of a store that are most similar to a target, at most `count`, and whether each may be
/// its source, before trials are looked at.
///
/// # Errors
/// The store does not answer.
pub async fn most_similar_ships(
    archive: &Archive,
    zoo: Arc<Zoo>,
    target: Vessel,
    count: usize,
) -> Result<Vec<RankedSource>> {
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

/// The model that a champion gives as a source; none where it is the published model, which the
/// zoo has already.
///
/// # Errors
/// Says why it may not serve. A damaged one must not keep the others from being used.
fn source_model(zoo: &Zoo, version: &Version) -> std::result::Result<Option<Model>, String> {
    let number = version.head.number;
    let document = document(version)
        .map_err(|error| format!("its champion, version {number}, cannot be read: {error}"))?;
    if matches!(document.recipe, Recipe::Plain(sistership_model::version::Recipe::Published { .. }))
    {
        return Ok(None);
    }
    // What was learned beside its law is of its own trials.
    let model = document.model.foundation();
    if let Some(effect) = model.effects.first() {
        // What was found on a day in one place is not another ship's.
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
