//! Reports of a refinement ([`render_refinement`]), a diagnosis ([`render_diagnosis`]), a learned
//! correction ([`render_branch`]) and a validation ([`render_validation`]): one self-contained HTML
//! page to read and print, and the same content as JSON.
//!
//! Both have the same tables and plots. Nothing depends on the clock.

mod branch;
mod contributed_ship;
mod diagnosis;
mod error_row;
mod metrics;
pub mod numbers;
pub mod plots;
mod refinement;
mod rendered;
mod replayed;
mod tables;
mod tile;
mod validation;
mod words;

/// Style sheet of charts, on pages and in reports.
pub const CHART_STYLE: &str = include_str!("../templates/chart.css");
/// Script of charts; each chart is complete without it.
pub const CHART_SCRIPT: &str = include_str!("../templates/chart.js");
/// Style sheet of reports, which other pages share.
pub const STYLE: &str = include_str!("../templates/report_style.css");

pub use branch::{BranchInput, render_branch};
pub use contributed_ship::contributed_ship_page;
pub use diagnosis::{
    DiagnosisInput, change_words, dependence_sentence, distinct_hypotheses, origin_sentence,
    render_diagnosis,
};
pub use refinement::{RefinementInput, imo_verdict, render_refinement};
pub use rendered::{RenderedReport, ReportError, VersionLabel};
pub use validation::render_validation;
pub use words::{axis_words, field_words, variable_words};
