//! Assessment of a model: uncertainty bands of its standard manoeuvres, and validation against
//! published and recorded trials.

pub mod uncertainty;
pub mod validation;
