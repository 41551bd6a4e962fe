//! Order of a bulk refinement with all references resolved, kept in its row and its recipes.

use serde::{Deserialize, Serialize};
use sistership_fleet::bulk::{AxisPrior, BulkPrior, BulkSettings};
use sistership_fleet::family::FamilyPriorError;
use sistership_model::version::{RecipeTrial, SourceVersion, code_revision};
use sistership_model::{Law, Model};
use std::collections::BTreeMap;

use super::choices::{Rule, Start};
use crate::error::DeriveError;
use crate::inputs::DerivationInputs;
use crate::recipe::{FamilyKind, FamilyRecipe, PriorName};

/// Kind of the jobs that refine a chunk of ships.
pub const BULK_JOB_KIND: &str = "bulk-refinement";

/// Order of a bulk refinement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BulkOrder {
    /// The family.
    pub family: String,
    /// The version that the members' models are founded on.
    pub foundation: SourceVersion,
    /// SHA-256 of the law's file.
    pub law_sha256: String,
    /// Starting model of each member.
    pub start: Start,
    /// The family's prior; by default the coefficients of the foundation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prior: Option<PriorName>,
    /// Settings.
    pub settings: BulkSettings,
    /// Rule by which a refined model becomes champion.
    pub rule: Rule,
}

/// Request of a job that refines a chunk of ships.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BulkChunk {
    /// The bulk refinement.
    pub bulk: String,
    /// Its ships.
    pub ships: Vec<String>,
}

/// Order with the documents that it names.
#[derive(Debug)]
pub struct LoadedOrder {
    /// The order.
    pub order: BulkOrder,
    /// The foundation's model.
    pub foundation: Model,
    /// The law that is fitted.
    pub law: Law,
    held: CoefficientPrior,
}

/// Prior of the coefficients.
#[derive(Debug)]
enum CoefficientPrior {
    Foundation(BTreeMap<String, f64>),
    Family { axes: Vec<AxisPrior>, design_effect: f64 },
}

impl BulkOrder {
    /// Returns the recipe of a member.
    pub fn member_recipe(
        &self,
        start: SourceVersion,
        ship_sha256: Option<String>,
        trials: Vec<RecipeTrial>,
    ) -> FamilyRecipe {
        FamilyRecipe {
            kind: FamilyKind::Family,
            start,
            ship_sha256,
            foundation: self.foundation.clone(),
            prior: self.prior.clone(),
            law_sha256: self.law_sha256.clone(),
            trials,
            settings: self.settings,
            code_revision: code_revision().to_owned(),
        }
    }
}

impl LoadedOrder {
    /// Reads the documents that an order names.
    ///
    /// # Errors
    /// Returns an error if a document is missing or damaged.
    pub async fn load(
        inputs: &DerivationInputs<'_>,
        order: BulkOrder,
    ) -> Result<Self, DeriveError> {
        // Through the recording inputs, so that the recipe of a member can be checked against them.
        let foundation = inputs.read_source(&order.foundation).await?;
        let law = inputs.read_law(&foundation.law, &order.law_sha256).await?;
        let held = match &order.prior {
            Some(name) => load_family_prior(inputs, name).await?,
            None => CoefficientPrior::Foundation(
                foundation.coefficients.iter().map(|(name, q)| (name.clone(), q.value)).collect(),
            ),
        };
        Ok(Self { order, foundation, law, held })
    }

    /// Returns the prior of the coefficients.
    pub fn prior(&self) -> BulkPrior<'_> {
        match &self.held {
            CoefficientPrior::Foundation(values) => BulkPrior::Source(values),
            // The design effect accounts for the correlation of samples within a trial.
            CoefficientPrior::Family { axes, design_effect } => {
                BulkPrior::Family { axes, design_effect: *design_effect }
            }
        }
    }

    /// Describes the prior of the coefficients.
    pub fn describe_prior(&self) -> String {
        match &self.order.prior {
            Some(name) => format!(
                "{}, prior from the family {} at revision {}",
                self.foundation.name, name.family, name.revision
            ),
            None => self.foundation.name.clone(),
        }
    }
}

async fn load_family_prior(
    inputs: &DerivationInputs<'_>,
    name: &PriorName,
) -> Result<CoefficientPrior, DeriveError> {
    let prior = inputs.read_prior(name).await?;
    // The hash was checked already: a prior that cannot be used was stored so.
    let lost = |what: FamilyPriorError| {
        DeriveError::Lost(format!(
            "the prior of the family `{}` at revision {} {what}",
            name.family, name.revision
        ))
    };
    Ok(CoefficientPrior::Family {
        axes: prior.axis_priors().map_err(lost)?,
        design_effect: prior.design_effect,
    })
}
