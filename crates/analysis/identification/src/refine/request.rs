//! The request of a refinement.

use sistership_model::law::Law;
use sistership_model::trial::Trial;
use sistership_model::{Model, Vessel};

use super::population::PopulationShip;
use super::settings::RefinementSettings;

/// A request: the ship, the source model and the law, and the trials against which it is refined.
#[derive(Debug, Clone, Copy)]
pub struct RefinementSpec<'a> {
    /// The ship.
    pub target: &'a Vessel,
    /// The source model, as published or as refined earlier.
    pub source: &'a Model,
    /// The source's law if it is not the law that is fitted: its accelerations then become the
    /// prior.
    pub source_law: Option<&'a Law>,
    /// The law that is fitted.
    pub law: &'a Law,
    /// Trials of the ship.
    pub trials: &'a [&'a Trial],
    /// Other ships with their models, for a prior from a population.
    pub population: &'a [PopulationShip],
    /// Settings.
    pub settings: &'a RefinementSettings,
}
