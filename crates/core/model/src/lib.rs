//! Vocabulary of the domain: ships, particulars, laws, coefficients, trials, versions.
//!
//! No I/O and no async: text goes in, checked values come out, and every error names file, line and
//! field.

pub mod actuator;
pub mod branch;
pub mod categories;
pub mod coefficient;
pub mod effect;
pub mod environment;
mod error;
pub mod estimated_particulars;
pub mod free_running;
pub mod hybrid;
pub mod law;
pub mod learned;
pub mod manifest;
pub mod model;
pub mod name;
pub mod particulars;
pub mod posterior;
pub mod propulsion;
pub mod quantity;
pub mod sample_hash;
pub mod source;
pub mod trial;
pub mod trial_input;
pub mod triangle;
pub mod uncertainty;
pub mod validity;
pub mod version;
pub mod vessel;
pub mod yaml;
pub mod zoo;

pub use effect::Effect;
pub use error::FileError;
pub use law::Law;
pub use model::Model;
pub use trial::Trial;
pub use vessel::Vessel;
pub use zoo::Zoo;
