//! Asking for the refinement of a family.

use serde::{Deserialize, Serialize};
use sistership_fleet::bulk::BulkSettings;
use sistership_model::version::SourceVersion;
use sistership_store::{Bulk, MAX_LIMIT, Page, Store, StoreError};
use utoipa::ToSchema;

use super::order::{BULK, Chunk, Order, PriorName};
use crate::problem::{Problem, Result};
use crate::web::field::described;

/// Most ships in a chunk, and how many there are where nobody says: few enough that a worker which dies loses little.
const MOST: usize = 500;
const CHUNK: usize = 50;

/// A refinement of all members of a family.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, ToSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Asked {
    /// Where each member starts.
    pub start: Start,
    /// What holds the coefficients.
    pub prior: PriorChoice,
    /// What makes a champion.
    pub rule: Rule,
    /// Ships that a worker takes at a time, 1 to 500; 50 where absent.
    #[schema(minimum = 1, maximum = 500)]
    pub chunk_ships: Option<usize>,
    /// Settings; each has a default, and all are kept with the versions.
    #[schema(schema_with = described::<BulkSettings>)]
    pub settings: BulkSettings,
}

/// Where a member starts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Start {
    /// At her champion; at the family's foundation where she has none.
    #[default]
    Champion,
    /// At the family's foundation, carried over to her particulars.
    Foundation,
}

/// What holds the coefficients.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum PriorChoice {
    /// What the family has taught last.
    #[default]
    Family,
    /// The foundation's coefficients.
    Foundation,
}

/// What makes a champion.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Rule {
    /// A refined model becomes champion where no axis' error, on trials left out, exceeds the one before by more than this share.
    /// Where absent, a person's word only.
    pub no_worse_than: Option<f64>,
}

/// Queues the refinement of a family, as the command line does.
///
/// # Errors
/// As [`queue`], in words.
pub async fn order_refinement(store: &Store, family: &str, asked: &Asked) -> std::result::Result<Bulk, String> {
    queue(store, family, asked).await.map_err(|problem| problem.detail)
}

/// Queues the refinement of a family in chunks.
///
/// # Errors
/// Names what is not there, or the setting that is out of range.
pub(crate) async fn queue(store: &Store, family: &str, asked: &Asked) -> Result<Bulk> {
    asked.settings.check().map_err(|error| Problem::invalid("settings", error.to_string()))?;
    if asked.rule.no_worse_than.is_some_and(|share| !share.is_finite()) {
        return Err(Problem::invalid("rule.no_worse_than", "must be a finite number"));
    }
    let size = asked.chunk_ships.unwrap_or(CHUNK);
    if !(1..=MOST).contains(&size) {
        return Err(Problem::invalid("chunk_ships", format!("must be from 1 to {MOST}")));
    }
    let order = order(store, family, asked).await?;
    let ships = members(store, family).await?;
    if ships.is_empty() {
        return Err(Problem::invalid(
            "family",
            format!("`{family}` has no members; add some with POST /v1/families/{family}/members"),
        ));
    }
    let chunks: Vec<Vec<String>> = ships.chunks(size).map(<[String]>::to_vec).collect();
    let request = serde_json::to_string(&order).map_err(Problem::internal)?;
    let chunk = |bulk: &str, ships: &[String]| {
        serde_json::to_string(&Chunk { bulk: bulk.to_owned(), ships: ships.to_vec() }).unwrap_or_default()
    };
    Ok(store.bulks().create(family, &request, BULK, &chunks, chunk).await?)
}

async fn order(store: &Store, name: &str, asked: &Asked) -> Result<Order> {
    let family = store.families().get(name).await?;
    let foundation = store.versions().by_id(&family.foundation).await?.head;
    let law = store.laws().get(&foundation.law).await?;
    let prior = match asked.prior {
        PriorChoice::Foundation => None,
        PriorChoice::Family => Some(last_prior(store, name).await?),
    };
    Ok(Order {
        family: family.name,
        foundation: SourceVersion { ship: foundation.model, number: foundation.number, sha256: foundation.sha256 },
        law_sha256: law.sha256,
        start: asked.start,
        prior,
        settings: asked.settings,
        rule: asked.rule,
    })
}

async fn last_prior(store: &Store, family: &str) -> Result<PriorName> {
    match store.families().prior(family, None).await {
        Ok(prior) => Ok(PriorName { family: prior.family, revision: prior.revision, sha256: prior.sha256 }),
        Err(StoreError::NotFound { .. }) => {
            let how = format!("POST /v1/families/{family}/prior learns it; `foundation` needs none");
            Err(Problem::invalid("prior", format!("the family `{family}` has taught nothing yet; {how}")))
        }
        Err(error) => Err(error.into()),
    }
}

/// Every member by name.
pub(super) async fn members(store: &Store, family: &str) -> std::result::Result<Vec<String>, StoreError> {
    let (mut all, mut page) = (Vec::new(), Page::first(MAX_LIMIT));
    loop {
        let list = store.families().members(family, &page).await?;
        all.extend(list.items.into_iter().map(|member| member.ship));
        let Some(next) = list.next else { return Ok(all) };
        page = Page::after(next, MAX_LIMIT);
    }
}
