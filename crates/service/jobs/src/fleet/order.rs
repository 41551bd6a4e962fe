//! What a bulk refinement is to do, with everything looked up: its row and its recipes keep it.

use serde::{Deserialize, Serialize};
use sistership_fleet::bulk::{AxisPrior, BulkSettings, Prior};
use sistership_fleet::family::FamilyPriorError;
use sistership_model::version::{RecipeTrial, SourceVersion, code_revision};
use sistership_model::{Law, Model};
use std::collections::BTreeMap;

use super::choices::{Rule, Start};
use crate::error::DeriveError;
use crate::inputs::Inputs;
use crate::recipe::{FamilyKind, FamilyRecipe, PriorName};

/// The kind of the jobs that refine a chunk of ships.
pub const BULK: &str = "bulk-refinement";

/// A bulk refinement to be done.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Order {
    /// The family.
    pub family: String,
    /// What the members' models are founded on.
    pub foundation: SourceVersion,
    /// The law's file.
    pub law_sha256: String,
    /// Where each member starts.
    pub start: Start,
    /// The family's prior; where absent, the foundation holds the coefficients.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prior: Option<PriorName>,
    /// Settings.
    pub settings: BulkSettings,
    /// What makes a champion.
    pub rule: Rule,
}

/// What a job of the kind [`BULK`] is asked to do.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Chunk {
    /// The bulk refinement.
    pub bulk: String,
    /// Its ships.
    pub ships: Vec<String>,
}

/// An order with the documents that it names.
#[derive(Debug)]
pub struct Loaded {
    /// The order.
    pub order: Order,
    /// The foundation's model.
    pub foundation: Model,
    /// The law of what is fitted.
    pub law: Law,
    held: Held,
}

/// What holds the coefficients.
#[derive(Debug)]
enum Held {
    Foundation(BTreeMap<String, f64>),
    Family { axes: Vec<AxisPrior>, design_effect: f64 },
}

impl Order {
    /// The recipe of a member.
    pub fn recipe(
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

impl Loaded {
    /// Reads what an order names.
    ///
    /// # Errors
    /// What is missing or damaged.
    pub async fn of(inputs: &Inputs<'_>, order: Order) -> Result<Self, DeriveError> {
        let foundation = inputs.source(&order.foundation).await?;
        let law = inputs.law(&foundation.law, &order.law_sha256).await?;
        let held = match &order.prior {
            Some(name) => family(inputs, name).await?,
            None => Held::Foundation(
                foundation.coefficients.iter().map(|(name, q)| (name.clone(), q.value)).collect(),
            ),
        };
        Ok(Self { order, foundation, law, held })
    }

    /// What holds the coefficients.
    pub fn prior(&self) -> Prior<'_> {
        match &self.held {
            Held::Foundation(values) => Prior::Source(values),
            Held::Family { axes, design_effect } => {
                Prior::Family { axes, design_effect: *design_effect }
            }
        }
    }

    /// What held the coefficients, in words.
    pub fn held_by(&self) -> String {
        match &self.order.prior {
            Some(name) => format!(
                "{}, held by the family {} at revision {}",
                self.foundation.name, name.family, name.revision
            ),
            None => self.foundation.name.clone(),
        }
    }
}

async fn family(inputs: &Inputs<'_>, name: &PriorName) -> Result<Held, DeriveError> {
    let prior = inputs.prior(name).await?;
    let lost = |what: FamilyPriorError| {
        DeriveError::Lost(format!(
            "the prior of the family `{}` at revision {} {what}",
            name.family, name.revision
        ))
    };
    Ok(Held::Family { axes: prior.axes().map_err(lost)?, design_effect: prior.design_effect })
}
