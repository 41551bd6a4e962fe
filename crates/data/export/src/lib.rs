//! Export of models for other tools: one trait, and one file for each format.
//!
//! The exported operations are the tape that the simulation evaluates, so that every law of the
//! zoo, with the effects of a model, can be exported, and gives the same results in other tools.

mod c;
mod correction;
mod error;
mod expression;
mod fmu;
mod format;
mod formats;
mod header;
mod identifier;
mod matlab;
mod modelica;
mod outside;
mod plan;
mod python;
mod range;
mod rates;
mod subject;
mod wrapped;

pub use error::ExportError;
pub use format::ModelFormat;
pub use formats::{FORMATS, by_name};
pub use outside::ExternalInput;
pub use plan::{ExportCoefficient, ExportPlan};
pub use subject::ExportSubject;
