//! Exchange of a ship as one file: its documents, its versions with their inputs, trials and
//! reports, which another archive imports with all hashes and the whole lineage.

mod content;
mod error;
mod file;
mod gather;
mod history;
mod signature;
mod take;
#[cfg(test)]
mod tests;

pub use content::{Bundle, BundleContent};
pub use error::BundleError;
pub use gather::collect_bundle;
pub use signature::{SigningKey, VerifyingKey, check_signer};
pub use take::{BundleImport, import_bundle};
