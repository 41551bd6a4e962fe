//! Refined models of similar ships, which may serve as sources: a refined sister is the best there
//! is.

use std::collections::BTreeMap;

use sistership_model::categories::comparable;
use sistership_model::{Model, Vessel, Zoo};
use sistership_priors::source::similar;
use sistership_store::Version;

use crate::archive::{Archive, document};
use crate::error::DeriveError;
use crate::line::{CHAMPION, alias};
use crate::recipe::Recipe;

/// Most ships whose champions are read, the most similar first.
const MOST: usize = 12;

/// Champions of ships like a target that are better than their published models, by ship. One that
/// carries effects is left out: what was found on a day in one place is not another ship's.
///
/// # Errors
/// The store does not answer, or a version does not read.
pub async fn champions(
    archive: &Archive,
    zoo: &Zoo,
    target: &Vessel,
) -> Result<BTreeMap<String, (Model, Version)>, DeriveError> {
    let ranking = similar(zoo, target, None, &[]).ranking;
    let category = |ship: &str| zoo.vessel(ship).map(|vessel| vessel.file.category.clone());
    let alike = ranking.into_iter().filter(|ranked| {
        category(&ranked.ship).is_some_and(|there| comparable(&target.file.category, &there))
    });
    let mut champions = BTreeMap::new();
    for ranked in alike.take(MOST) {
        if let Some(champion) = champion(archive, zoo, &ranked.ship).await? {
            champions.insert(ranked.ship, champion);
        }
    }
    Ok(champions)
}

/// A ship's champion, where it is more than the published model.
async fn champion(
    archive: &Archive,
    zoo: &Zoo,
    ship: &str,
) -> Result<Option<(Model, Version)>, DeriveError> {
    let Some(alias) = alias(&archive.store, ship, CHAMPION).await? else { return Ok(None) };
    let version = archive.store.versions().get(ship, alias.version_number).await?;
    let document = document(&version)?;
    let is_published = matches!(
        document.recipe,
        Recipe::Plain(sistership_model::version::Recipe::Published { .. })
    );
    // What was learned beside its law is of its own trials.
    let model = document.model.foundation();
    let usable = !is_published && model.effects.is_empty() && zoo.law(&model.law).is_some();
    Ok(usable.then_some((model, version)))
}
