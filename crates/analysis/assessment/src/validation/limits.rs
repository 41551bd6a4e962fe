//! Limits by which a model counts as validated, and ranges in which the figures of a ship are
//! expected.
//!
//! No standard has such limits: Berg (2015), State of the art document on validation of simulation
//! models for ship manoeuvring (MARINTEK memo D0, SIMVAL), says in its abstract that nobody has yet
//! described how to validate a shiphandling model. So these are chosen, above what trials differ by
//! themselves and what careful predictions reach:
//!
//! - Port and starboard turns of one model test differ by 3 % in advance and 7 % in tactical
//!   diameter (KVLCC1 in Aksu and Kose 2017, J ETA Maritime Science 5(1), as quoted in
//!   docs/evidence/zoo-sources.md), its first overshoots by 1.6 deg.
//! - Alexandersson, Mao and Ringsberg (2022), Ocean Engineering 266, 112940, call 4 % in advance
//!   and 1 % in tactical diameter acceptable.
//! - Repeated zigzags of one model scatter by 0.1 to 0.3 deg in first overshoot
//!   (github.com/martinlarsalbert/PHD, commit 70d3b3f, docs/notebooks_paper_5).
//!
//! The uncertainty of the trial is added to each.

/// Difference of a turning figure from the trial that is allowed, as a share of the trial's.
pub const TURN_SHARE: f64 = 0.10;

/// Difference of an overshoot that is allowed, as a share of the trial's.
pub const OVERSHOOT_SHARE: f64 = 0.20;

/// Difference of an overshoot that is allowed however small the trial's, deg.
pub const OVERSHOOT_DEG: f64 = 2.0;

/// Change of speed on a straight course at the model's revolutions that is believed, as a share.
pub const SPEED_KEPT_SHARE: f64 = 0.10;

/// Change of heading on a straight course, deg in ten ship lengths.
pub const HEADING_KEPT_DEG: f64 = 10.0;

/// By how much the diameters of turns to port and starboard may differ, as a share.
pub const SIDES_SHARE: f64 = 0.20;

/// Tactical diameters at 35 deg that are seen, ship lengths.
pub const TACTICAL_DIAMETERS: std::ops::RangeInclusive<f64> = 0.8..=8.0;

/// First overshoots of a 10/10 zigzag that are seen, deg.
pub const FIRST_OVERSHOOTS_DEG: std::ops::RangeInclusive<f64> = 0.0..=40.0;
