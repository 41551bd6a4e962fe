//! Export of models for other tools: one trait, and one file for each format.
//!
//! The exported operations are the tape that the simulation evaluates, so that every law of the
//! zoo, with the effects of a model, can be exported, and gives the same results in other tools.

mod c;
mod coefficients;
mod correction;
mod error;
mod export_plan;
mod expression;
mod external_input;
mod fmu;
mod format;
mod formats;
mod header;
mod identifier;
mod line_wrapping;
mod matlab;
mod modelica;
mod python;
mod quoting;
mod range;
mod rates;
mod ssp;
mod states;
mod subject;

pub use coefficients::ExportCoefficient;
pub use error::ExportError;
pub use export_plan::ExportPlan;
pub use external_input::ExternalInput;
pub use format::ModelFormat;
pub use formats::{FORMATS, by_name};
pub use subject::ExportSubject;
