//! Models written down for other tools: one trait, one file a format.
//!
//! What is written is the tape that our own simulation evaluates, so that every law of the zoo,
//! with the effects that a model carries, can be exported, and says the same elsewhere.

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
pub use format::Format;
pub use formats::{FORMATS, by_name};
pub use outside::Outside;
pub use plan::{Coefficient, Plan};
pub use subject::Subject;
