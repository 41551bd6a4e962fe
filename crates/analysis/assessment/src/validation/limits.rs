//! Limits of the errors of a validated model, and ranges in which the figures of a ship are
//! expected.
//!
//! No standard has such limits: Berg (2015), State of the art document on validation of simulation
//! models for ship manoeuvring (MARINTEK memo D0, SIMVAL), states in its abstract that no method of
//! validating a shiphandling model has been described yet. These limits are therefore chosen, above
//! the scatter of trials and the errors of careful predictions:
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

/// Allowed difference of a turning figure from the trial, as a share of the trial's.
pub const TURN_SHARE: f64 = 0.10;

/// Allowed difference of an overshoot, as a share of the trial's.
pub const OVERSHOOT_SHARE: f64 = 0.20;

/// Smallest allowed difference of an overshoot, deg.
pub const OVERSHOOT_DEG: f64 = 2.0;

/// Plausible change of speed on a straight course at the model's revolutions, as a share.
pub const SPEED_KEPT_SHARE: f64 = 0.10;

/// Plausible change of heading on a straight course, deg in ten ship lengths.
pub const HEADING_KEPT_DEG: f64 = 10.0;

/// Plausible difference of the diameters of turns to port and starboard, as a share.
pub const SIDES_SHARE: f64 = 0.20;

/// Usual tactical diameters at 35 deg, ship lengths.
pub const TACTICAL_DIAMETERS: std::ops::RangeInclusive<f64> = 0.8..=8.0;

/// Usual first overshoots of a 10/10 zigzag, deg.
pub const FIRST_OVERSHOOTS_DEG: std::ops::RangeInclusive<f64> = 0.0..=40.0;
