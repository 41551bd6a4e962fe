//! Request for the refinement of a family.

use serde::Deserialize;
use sistership_fleet::bulk::BulkSettings;
use sistership_model::version::SourceVersion;
use sistership_store::{FamilyRefinement, Store, StoreError};
use utoipa::ToSchema;

use super::choices::{PriorChoice, Rule, Start};
use super::members::member_names;
use super::order::{BULK_JOB_KIND, BulkChunk, BulkOrder};
use crate::recipe::PriorName;
use crate::schema::schema_reference;

/// Largest and default number of ships in a chunk: few enough that little work is lost when a
/// worker stops.
const MAX_CHUNK_SHIPS: usize = 500;
const DEFAULT_CHUNK_SHIPS: usize = 50;

/// Error of a request for the refinement of a family.
#[derive(Debug, thiserror::Error)]
pub enum OrderError {
    /// A setting is out of range, or refers to something that does not exist.
    #[error("{field}: {message}")]
    Setting {
        /// The setting.
        field: String,
        /// Message that says what is allowed.
        message: String,
    },
    /// A row is missing, or the store does not answer.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The order cannot be written.
    #[error("a document cannot be written: {0}")]
    Json(#[from] serde_json::Error),
}

type Result<T> = std::result::Result<T, OrderError>;

fn invalid_setting(field: &str, message: impl Into<String>) -> OrderError {
    OrderError::Setting { field: field.to_owned(), message: message.into() }
}

/// Refinement of all members of a family.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, ToSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BulkRefinementRequest {
    /// The model from which each member starts.
    pub start: Start,
    /// The prior of the coefficients.
    pub prior: PriorChoice,
    /// The rule by which a refined model becomes champion.
    pub rule: Rule,
    /// Number of ships in a job, 1 to 500; default 50.
    #[schema(minimum = 1, maximum = 500)]
    pub chunk_ships: Option<usize>,
    /// Settings; each has a default, and all are recorded with the versions.
    #[schema(schema_with = schema_reference::<BulkSettings>)]
    pub settings: BulkSettings,
}

/// Queues the refinement of a family in chunks of ships.
///
/// # Errors
/// Returns an error that names what is missing, or the setting that is out of range.
pub async fn order_refinement(
    store: &Store,
    family: &str,
    asked: &BulkRefinementRequest,
) -> Result<FamilyRefinement> {
    asked.settings.check().map_err(|error| invalid_setting("settings", error.to_string()))?;
    // A negative share is valid: it demands an improvement.
    if asked.rule.no_worse_than.is_some_and(|share| !share.is_finite()) {
        return Err(invalid_setting("rule.no_worse_than", "must be a finite number"));
    }
    let size = asked.chunk_ships.unwrap_or(DEFAULT_CHUNK_SHIPS);
    if !(1..=MAX_CHUNK_SHIPS).contains(&size) {
        return Err(invalid_setting("chunk_ships", format!("must be from 1 to {MAX_CHUNK_SHIPS}")));
    }
    let order = resolve_order(store, family, asked).await?;
    let ships = member_names(store, family).await?;
    if ships.is_empty() {
        return Err(invalid_setting(
            "family",
            format!("`{family}` has no members; add some with POST /v1/families/{family}/members"),
        ));
    }
    // The members are fixed here: a ship that joins later is not part of this refinement.
    let chunks: Vec<Vec<String>> = ships.chunks(size).map(<[String]>::to_vec).collect();
    let request = serde_json::to_string(&order)?;
    let chunk = |bulk: &str, ships: &[String]| {
        serde_json::to_string(&BulkChunk { bulk: bulk.to_owned(), ships: ships.to_vec() })
            .unwrap_or_default()
    };
    Ok(store.bulks().create(family, &request, BULK_JOB_KIND, &chunks, chunk).await?)
}

async fn resolve_order(
    store: &Store,
    name: &str,
    asked: &BulkRefinementRequest,
) -> Result<BulkOrder> {
    let family = store.families().get(name).await?;
    let foundation = store.versions().by_id(&family.foundation).await?.head;
    let law = store.laws().get(&foundation.law).await?;
    let prior = match asked.prior {
        PriorChoice::Foundation => None,
        PriorChoice::Family => Some(latest_prior(store, name).await?),
    };
    Ok(BulkOrder {
        family: family.name,
        foundation: SourceVersion {
            ship: foundation.model,
            number: foundation.number,
            sha256: foundation.sha256,
        },
        law_sha256: law.sha256,
        start: asked.start,
        prior,
        settings: asked.settings,
        rule: asked.rule,
    })
}

async fn latest_prior(store: &Store, family: &str) -> Result<PriorName> {
    match store.families().get_prior(family, None).await {
        Ok(prior) => {
            Ok(PriorName { family: prior.family, revision: prior.revision, sha256: prior.sha256 })
        }
        // The family exists, as it was read above; only its prior is missing.
        Err(StoreError::NotFound { .. }) => {
            let how = format!(
                "POST /v1/families/{family}/prior estimates it; the prior `foundation` \
                         needs none"
            );
            Err(invalid_setting("prior", format!("the family `{family}` has no prior yet; {how}")))
        }
        Err(error) => Err(error.into()),
    }
}
