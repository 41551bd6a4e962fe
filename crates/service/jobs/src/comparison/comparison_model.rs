//! Model of a comparison.

use sistership_model::{Law, Model};

/// Model to be compared, with its law.
#[derive(Debug, Clone, Copy)]
pub struct ComparisonModel<'a> {
    /// Name in the answer.
    pub name: &'a str,
    /// The model.
    pub model: &'a Model,
    /// Its law.
    pub law: &'a Law,
}
