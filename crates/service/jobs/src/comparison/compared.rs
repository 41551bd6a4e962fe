//! A model to be compared.

use sistership_model::{Law, Model};

/// A model to be compared.
#[derive(Debug, Clone, Copy)]
pub struct Compared<'a> {
    /// What it is called in the answer.
    pub name: &'a str,
    /// The model.
    pub model: &'a Model,
    /// Its law.
    pub law: &'a Law,
}
