//! Segmentation of a long log: the segments in which rudder or propeller move beyond course
//! keeping.
//!
//! A [`SegmentFinder`] takes the rows of a log one at a time and stores means of short intervals
//! only, so that a month needs no more memory than a day. It uses the channels and the length of
//! the ship, and no model. [`SegmentationResult`] contains the segments with their excitation and
//! the reason of their selection, and the spans of steady course keeping between them.

mod active;
mod blocks;
mod cells;
mod excitation;
mod finder;
mod kind;
mod level;
mod sample;
mod segment;
mod spans;
mod thresholds;

pub use excitation::Excitation;
pub use finder::{SegmentFinder, SegmentationError, SegmentationResult};
pub use kind::SegmentKind;
pub use sample::LogSample;
pub use segment::ManoeuvreSegment;
pub use spans::TimeSpan;
