//! Content of the report of a refinement, collected once.

use serde::Serialize;
use sistership_model_selection::SelectionReport;
use sistership_priors::source::SimilarityRanking;
use sistership_simulation::manoeuvre::FurtherManoeuvres;

use super::coefficients::CoefficientReport;
use super::input::RefinementInput;
use super::manoeuvres::ManoeuvreComparison;
use super::measured_figures::{self, MeasuredFigure};
use super::options::StepOptions;
use super::provenance::ModelProvenance;
use super::summary::{HeldOutErrors, ReportHeadline};
use crate::replayed::{ReplaySummary, ReplayedTrial};

/// Content of a report.
#[derive(Debug, Serialize)]
pub(crate) struct RefinementContent<'a> {
    pub format: &'static str,
    pub headline: ReportHeadline<'a>,
    pub errors: HeldOutErrors<'a>,
    pub replays: Vec<ReplaySummary<'a>>,
    pub coefficients: CoefficientReport<'a>,
    pub options: StepOptions<'a>,
    pub manoeuvres: ManoeuvreComparison<'a>,
    /// Stopping, pull-outs and spirals of the refined model.
    pub further: FurtherManoeuvres,
    pub sailed: Vec<MeasuredFigure>,
    pub similarity: Option<&'a SimilarityRanking>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ladder: Option<&'a SelectionReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wide: Option<String>,
    pub provenance: ModelProvenance<'a>,
}

impl<'a> RefinementContent<'a> {
    pub(crate) fn from_input(
        input: &RefinementInput<'a>,
        replayed: &[ReplayedTrial<'a>],
        further: FurtherManoeuvres,
    ) -> Self {
        let errors = HeldOutErrors::from_input(input);
        Self {
            format: "sistership-report/1",
            headline: ReportHeadline::from_input(input, &errors),
            errors,
            replays: replayed.iter().map(|replayed| replayed.shown.clone()).collect(),
            coefficients: CoefficientReport::from_input(input),
            options: StepOptions::from_input(input),
            manoeuvres: ManoeuvreComparison::from_input(input),
            further,
            sailed: measured_figures::collect_figures(input),
            similarity: input.similarity,
            ladder: input.ladder,
            wide: input.refinement.manoeuvres.wide_band(),
            provenance: ModelProvenance::from_input(input),
        }
    }
}
