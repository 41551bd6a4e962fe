//! Content of the report of a refinement, collected once.

use serde::Serialize;
use sistership_model_selection::Ladder;
use sistership_priors::source::Similarity;
use sistership_simulation::manoeuvre::FurtherManoeuvres;

use super::coefficients::Coefficients;
use super::input::RefinementInput;
use super::manoeuvres::ManoeuvreComparison;
use super::options::StepOptions;
use super::provenance::Provenance;
use super::sailed::{self, Sailed};
use super::summary::{Headline, HeldOutErrors};
use crate::replayed::{ReplaySummary, ReplayedTrial};

/// Content of a report.
#[derive(Debug, Serialize)]
pub(crate) struct RefinementContent<'a> {
    pub format: &'static str,
    pub headline: Headline<'a>,
    pub errors: HeldOutErrors<'a>,
    pub replays: Vec<ReplaySummary<'a>>,
    pub coefficients: Coefficients<'a>,
    pub options: StepOptions<'a>,
    pub manoeuvres: ManoeuvreComparison<'a>,
    /// Stopping, pull-outs and spirals of the refined model.
    pub further: FurtherManoeuvres,
    pub sailed: Vec<Sailed>,
    pub similarity: Option<&'a Similarity>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ladder: Option<&'a Ladder>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wide: Option<String>,
    pub provenance: Provenance<'a>,
}

impl<'a> RefinementContent<'a> {
    pub(crate) fn of(
        input: &RefinementInput<'a>,
        replayed: &[ReplayedTrial<'a>],
        further: FurtherManoeuvres,
    ) -> Self {
        let errors = HeldOutErrors::of(input);
        Self {
            format: "sistership-report/1",
            headline: Headline::of(input, &errors),
            errors,
            replays: replayed.iter().map(|replayed| replayed.shown.clone()).collect(),
            coefficients: Coefficients::of(input),
            options: StepOptions::of(input),
            manoeuvres: ManoeuvreComparison::of(input),
            further,
            sailed: sailed::figures(input),
            similarity: input.similarity,
            ladder: input.ladder,
            wide: input.refinement.manoeuvres.wide_band(),
            provenance: Provenance::of(input),
        }
    }
}
