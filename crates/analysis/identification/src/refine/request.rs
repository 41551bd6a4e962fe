//! What a refinement is asked.

use sistership_model::law::Law;
use sistership_model::trial::Trial;
use sistership_model::{Model, Vessel};

use super::population::Member;
use super::settings::Settings;

/// What is to be refined, and against what.
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// The ship.
    pub target: &'a Vessel,
    /// The source model, as published or as refined earlier.
    pub source: &'a Model,
    /// The source's law where it is another than what is fitted: what it says becomes the prior.
    pub source_law: Option<&'a Law>,
    /// The law of what is fitted.
    pub law: &'a Law,
    /// Its trials.
    pub trials: &'a [&'a Trial],
    /// Other ships with their models, where the prior is what they say.
    pub population: &'a [Member],
    /// Settings.
    pub settings: &'a Settings,
}
