//! Every constant by which a diagnosis decides, with its symbol, meaning, unit and source.
//!
//! `L/U` is the time in which the ship sails its length at the approach speed of its trials. A
//! source that begins with "chosen" has no measurement of how results move at half and at double
//! the value: the reason that can be given is the one of the mathematics. "The benchmark" is that
//! of `docs/evidence/diagnosis.md` (`cargo run --release -p sistership-tests --example
//! hidden_effects`).

mod calibration;
mod changes;
mod effects;
mod limits;
mod remainder;
mod search;
mod trials;

use calibration::{CALIBRATION, CalibrationThresholds, DISCREPANCY, DiscrepancyThresholds};
use changes::{CHANGES, ChangeThresholds};
use effects::{
    CONFOUNDING, CONSTANCY, ConfoundingThresholds, ConstancyThresholds, EFFECT, EffectThresholds,
};
use limits::{LIMITS, LimitThresholds};
use remainder::{
    DEPENDENCE, DependenceThresholds, ORIGIN, OriginThresholds, REMAINDER, RemainderThresholds,
};
use search::{REFIT, RefitThresholds, SEARCH, SearchThresholds};
use trials::{NEXT_TRIAL, NextTrialThresholds, SERIES, SeriesThresholds, TRIALS, TrialThresholds};

pub(crate) use trials::PlannedHelm;

/// All of them, by what they decide.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Thresholds {
    /// Calibration on a model's own trials.
    pub calibration: CalibrationThresholds,
    /// The random accelerations that no coefficient explains.
    pub discrepancy: DiscrepancyThresholds,
    /// How hypotheses are searched.
    pub search: SearchThresholds,
    /// How far effects and their laws are trusted.
    pub effect: EffectThresholds,
    /// Whether an effect is the same at all times.
    pub constancy: ConstancyThresholds,
    /// When two effects count as different.
    pub confounding: ConfoundingThresholds,
    /// How small an effect would have been shown.
    pub limits: LimitThresholds,
    /// When something remains unexplained.
    pub remainder: RemainderThresholds,
    /// What changes within a trial.
    pub changes: ChangeThresholds,
    /// Where it comes from.
    pub origin: OriginThresholds,
    /// On what it depends.
    pub dependence: DependenceThresholds,
    /// The fit of the model that is given.
    pub refit: RefitThresholds,
    /// How trials are read and replayed.
    pub trials: TrialThresholds,
    /// The trial that is proposed.
    pub next_trial: NextTrialThresholds,
    /// Series for plots.
    pub series: SeriesThresholds,
}

/// The values.
pub(crate) const THRESHOLDS: Thresholds = Thresholds {
    calibration: CALIBRATION,
    discrepancy: DISCREPANCY,
    search: SEARCH,
    effect: EFFECT,
    constancy: CONSTANCY,
    confounding: CONFOUNDING,
    limits: LIMITS,
    remainder: REMAINDER,
    changes: CHANGES,
    origin: ORIGIN,
    dependence: DEPENDENCE,
    refit: REFIT,
    trials: TRIALS,
    next_trial: NEXT_TRIAL,
    series: SERIES,
};
