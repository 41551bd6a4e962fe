//! A ship as one file: its documents, versions with what they were derived from, trials and
//! reports, which another archive takes with every hash and all lineage.

mod content;
mod error;
mod file;
mod gather;
mod history;
mod signature;
mod take;
#[cfg(test)]
mod tests;

pub use content::{Bundle, Content};
pub use error::BundleError;
pub use gather::gather;
pub use signature::{SigningKey, VerifyingKey, trusted};
pub use take::{Taken, take};
