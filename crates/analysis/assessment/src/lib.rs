//! Assessment of a model: uncertainty bands of its standard manoeuvres, its response on a straight
//! course, and validation against
//! published and recorded trials.

pub mod course;
pub mod uncertainty;
pub mod validation;
