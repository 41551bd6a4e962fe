//! Model selection: the search for the best model that a ship's trials allow, over sources, laws
//! and estimators.
//!
//! Every candidate (a source, or none, and the law to be fitted) is evaluated by one error on the
//! same held-out manoeuvres. Candidates pass the stages by successive halving. Of candidates that
//! are statistically tied, the one is preferred that depends least on single trials elsewhere; it
//! is refined by an explicit request with its source, law and method. If that gives no model that
//! completes the required manoeuvres, the next one is chosen.

mod candidate;
mod choice;
mod correction;
mod correction_choice;
mod evaluation;
mod extremes;
mod foundation;
mod population;
mod preference;
mod scatter;
mod search;
mod selection;
mod selection_report;
mod simulation_check;
mod start;
mod thresholds;

pub use candidate::{AdditionalPriors, CandidatePrior, SelectionCandidate, list_candidates};
pub use choice::{choose_candidate, standard_error};
pub use evaluation::CandidateSearch;
pub use population::similar_population;
pub use preference::Preference;
pub use search::{calibration_samples, search_candidates};
pub use selection::SelectedCandidate;
pub use selection_report::{ReportLine, SelectionReport, SelectionStage};
pub use start::{StartRequest, StartSelection, best_start};
