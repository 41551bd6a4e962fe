//! Constants by which a diagnosis decides, each with its symbol, meaning, unit and source.
//!
//! `L/U` is the time in which the ship covers its length at the approach speed of its trials. A
//! source that begins with "chosen" has no measurement of the results at half and at double the
//! value: only the mathematical reason is given. "The benchmark" is that of
//! `docs/evidence/diagnosis.md` (`cargo run --release -p sistership-tests --example
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
    DEPENDENCE, DependenceThresholds, ORIGIN, OriginThresholds, PATTERNS, PatternThresholds,
    REMAINDER, RemainderThresholds,
};
use search::{REFIT, RefitThresholds, SEARCH, SearchThresholds};
use trials::{NEXT_TRIAL, NextTrialThresholds, SERIES, SeriesThresholds, TRIALS, TrialThresholds};

pub(crate) use trials::PlannedHelm;

/// All thresholds, by the decision that they belong to.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DiagnosisThresholds {
    /// Calibration on a model's own trials.
    pub calibration: CalibrationThresholds,
    /// The random accelerations that no coefficient explains.
    pub discrepancy: DiscrepancyThresholds,
    /// Search among hypotheses.
    pub search: SearchThresholds,
    /// Accuracy of effects and of their laws.
    pub effect: EffectThresholds,
    /// Constancy of an effect in time.
    pub constancy: ConstancyThresholds,
    /// Distinction of two effects.
    pub confounding: ConfoundingThresholds,
    /// Detection limits.
    pub limits: LimitThresholds,
    /// Detection of an unexplained remainder.
    pub remainder: RemainderThresholds,
    /// Patterns of the remainder.
    pub patterns: PatternThresholds,
    /// Changes within a trial.
    pub changes: ChangeThresholds,
    /// Origin of a remainder.
    pub origin: OriginThresholds,
    /// Dependence of a remainder on variables.
    pub dependence: DependenceThresholds,
    /// Final fit of coefficients and effects.
    pub refit: RefitThresholds,
    /// Reading and simulation of trials.
    pub trials: TrialThresholds,
    /// Proposed trial.
    pub next_trial: NextTrialThresholds,
    /// Series for plots.
    pub series: SeriesThresholds,
}

/// Values in use.
pub(crate) const THRESHOLDS: DiagnosisThresholds = DiagnosisThresholds {
    calibration: CALIBRATION,
    discrepancy: DISCREPANCY,
    search: SEARCH,
    effect: EFFECT,
    constancy: CONSTANCY,
    confounding: CONFOUNDING,
    limits: LIMITS,
    remainder: REMAINDER,
    patterns: PATTERNS,
    changes: CHANGES,
    origin: ORIGIN,
    dependence: DEPENDENCE,
    refit: REFIT,
    trials: TRIALS,
    next_trial: NEXT_TRIAL,
    series: SERIES,
};
