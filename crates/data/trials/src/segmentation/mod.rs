//! The stretches of a long log in which rudder or propeller move beyond course keeping.
//!
//! A [`Finder`] takes the rows of a log one at a time and keeps means of short intervals only, so
//! that a month needs no more memory than a day. It knows channels and a ship's length, and no
//! model. [`Found`] has the stretches with what they excite and why they were taken, and the spans
//! of steady course keeping between them.

mod active;
mod blocks;
mod cells;
mod excitation;
mod finder;
mod kind;
mod level;
mod sample;
mod spans;
mod stretch;
mod thresholds;

pub use excitation::Excitation;
pub use finder::{Finder, Found, NotSearched};
pub use kind::Kind;
pub use sample::Sample;
pub use spans::Span;
pub use stretch::Stretch;
