//! Identification of the columns of a recording: which quantity, in which unit, with which sign.
//!
//! Three sources are combined as log odds: headers (a vocabulary in nine languages,
//! `models/vocabulary`), values (range, period, monotony), and relations between columns (heading
//! and yaw rate, positions and velocities, yaw rate and rudder). [`identify_columns`] returns the
//! assignment that is likeliest by all three, the probability of each column, and the alternative
//! where two hypotheses are nearly as likely.

mod annealing;
mod cooccurrence;
mod data;
mod faults;
mod header;
mod hypothesis;
mod identify;
mod outcome;
mod own_evidence;
mod physics;
mod relation;
mod role;
mod rudder;
mod search;
mod signals;
mod starts;
mod summary;
mod thrusters;
mod time;
mod track;
mod vocabulary;
mod words;

pub use data::{ColumnData, RecordingSample};
pub use faults::{FilteredChannel, SampleFault, backward_times, repeated_rows, sample_faults};
pub use identify::{GivenColumn, identify_columns};
pub use outcome::{AlternativeReading, Identification, IdentifiedColumn, ThrusterPair};
pub use role::{QuantityKind, Role, Side, Unit};
