//! Ranking by correlation, and the three steps of the eligibility of a source: Kanazawa 2023,
//! section 5.1.2.

use rayon::prelude::*;
use serde::Serialize;
use sistership_model::Vessel;
use sistership_model::categories::category_group;

use super::{CharacteristicVector, VectorDefinition};
use crate::trend::TrendError;

/// A ship of the zoo with its model as a source.
#[derive(Debug, Clone)]
pub struct SourceCandidate<'a> {
    /// Ship.
    pub vessel: &'a Vessel,
    /// Name and law of its model; none for a ship known by particulars only.
    pub model: Option<ModelHead>,
}

/// Name and law of a model, without its values: most candidates are judged before those matter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ModelHead {
    /// `ship/model`.
    pub name: String,
    /// Name of the law.
    pub law: String,
}

/// Requirements on a source.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EligibilityLimits {
    /// `d_v`: largest relative difference of a component of the vector of Eq. 5.18, dimensionless.
    /// Source: chosen; the thesis' own pair differs by 6 % at most, and ships of one category in
    /// the zoo by more.
    pub vector_difference: f64,
    /// `r_0`: least correlation of simulated and measured yaw rate over the target's trials,
    /// dimensionless. Source: chosen; the source then explains a third of the yaw rate's variance.
    pub trend: f64,
}

impl Default for EligibilityLimits {
    fn default() -> Self {
        Self { vector_difference: 0.35, trend: 0.6 }
    }
}

/// Eligibility of a ship as a source, with the reasons.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Eligibility {
    /// True if every step is passed.
    pub eligible: bool,
    /// Outcome of each step, with its figure.
    pub reasons: Vec<String>,
}

/// One line of the ranking.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RankedSource {
    /// Name of the ship.
    pub ship: String,
    /// Name of its model; none for a ship known by particulars only.
    pub model: Option<String>,
    /// Law of that model.
    pub law: Option<String>,
    /// Correlation of the characteristic vectors; none where too few components are known.
    pub correlation: Option<f64>,
    /// True if the ship is eligible as the source.
    pub eligible: bool,
    /// Outcome of each step, with figures.
    pub reasons: Vec<String>,
}

/// Measure of the trend of the target's trials by a ship's model (a correlation): none where there
/// are no trials, or an error where it cannot be determined.
pub type TrendMeasure<'a> = &'a (dyn Fn(&Vessel) -> Result<Option<f64>, TrendError> + Sync);

/// Ranks the candidates by correlation with the target. `trend` measures the trend of the target's
/// trials by a source's model; without trials the third step is not checked, and reported so.
pub fn rank_candidates(
    target: &Vessel,
    candidates: &[SourceCandidate<'_>],
    definition: VectorDefinition,
    limits: &EligibilityLimits,
    trend: TrendMeasure<'_>,
) -> Vec<RankedSource> {
    let here = CharacteristicVector::from_vessel(target, definition);
    let others = |candidate: &&SourceCandidate<'_>| candidate.vessel.name() != target.name();
    let mut ranking: Vec<RankedSource> = candidates
        .par_iter()
        .filter(others)
        .map(|candidate| {
            let correlation =
                here.correlation(&CharacteristicVector::from_vessel(candidate.vessel, definition));
            let Eligibility { eligible, reasons } =
                judge_eligibility(target, candidate, limits, trend);
            RankedSource {
                ship: candidate.vessel.name().to_owned(),
                model: candidate.model.as_ref().map(|model| model.name.clone()),
                law: candidate.model.as_ref().map(|model| model.law.clone()),
                correlation,
                eligible,
                reasons,
            }
        })
        .collect();
    ranking.sort_by(|a, b| {
        // Ships without a correlation come last; equal ones are ordered by name.
        let key = |r: &RankedSource| r.correlation.unwrap_or(-2.0);
        key(b).total_cmp(&key(a)).then_with(|| a.ship.cmp(&b.ship))
    });
    ranking
}

fn judge_eligibility(
    target: &Vessel,
    candidate: &SourceCandidate<'_>,
    limits: &EligibilityLimits,
    trend: TrendMeasure<'_>,
) -> Eligibility {
    let mut steps = vec![
        same_category(target, candidate.vessel),
        similar_vector(target, candidate.vessel, limits),
    ];
    match &candidate.model {
        None => steps.push(StepOutcome::with_failure("no model, only particulars".into())),
        // A simulation costs more than a comparison of numbers: it is run only if the other steps
        // are passed.
        Some(_) if steps.iter().all(|step| step.passed) => {
            steps.push(captures_trend(trend(candidate.vessel), limits));
        }
        Some(_) => {}
    }
    let eligible = steps.iter().all(|step| step.passed);
    Eligibility { eligible, reasons: steps.into_iter().map(|step| step.reason).collect() }
}

/// Outcome of a step, with its reason.
struct StepOutcome {
    passed: bool,
    reason: String,
}

impl StepOutcome {
    fn with_pass(reason: String) -> Self {
        Self { passed: true, reason }
    }

    fn with_failure(reason: String) -> Self {
        Self { passed: false, reason }
    }
}

fn same_category(target: &Vessel, source: &Vessel) -> StepOutcome {
    let (here, there) = (&target.file.category, &source.file.category);
    if here == there {
        return StepOutcome::with_pass(format!("same category: {here}"));
    }
    if let Some(group) = category_group(here).filter(|group| group.categories.contains(there)) {
        return StepOutcome::with_pass(format!(
            "comparable category: {there}, also {}",
            group.name
        ));
    }
    StepOutcome::with_failure(format!("another category: {there}, not {here}"))
}

fn similar_vector(target: &Vessel, source: &Vessel, limits: &EligibilityLimits) -> StepOutcome {
    let definition = VectorDefinition::Kanazawa2023;
    let here = CharacteristicVector::from_vessel(target, definition);
    let there = CharacteristicVector::from_vessel(source, definition);
    let shared = here.values.keys().filter(|name| there.values.contains_key(*name)).count();
    // With fewer than four common components the ships cannot be compared.
    let Some((name, difference)) = here.largest_difference(&there).filter(|_| shared >= 4) else {
        return StepOutcome::with_failure(format!(
            "characteristic vector unknown: only {shared} components in common"
        ));
    };
    let (percent, limit) = (100.0 * difference, 100.0 * limits.vector_difference);
    if difference <= limits.vector_difference {
        StepOutcome::with_pass(format!(
            "similar vector: largest difference {percent:.0} % in {name}"
        ))
    } else {
        StepOutcome::with_failure(format!(
            "vector too different: {percent:.0} % in {name}, allowed {limit:.0} %"
        ))
    }
}

fn captures_trend(
    measured: Result<Option<f64>, TrendError>,
    limits: &EligibilityLimits,
) -> StepOutcome {
    match measured {
        Ok(None) => {
            StepOutcome::with_pass("trend of the trials: not checked, no trials given".into())
        }
        Err(reason) => {
            StepOutcome::with_failure(format!("cannot be compared with the trials: {reason}"))
        }
        Ok(Some(r)) if r >= limits.trend => StepOutcome::with_pass(format!(
            "captures the trend of the trials: correlation of the yaw rates {r:.2}"
        )),
        Ok(Some(r)) => StepOutcome::with_failure(format!(
            "does not capture the trend of the trials: correlation of the yaw rates {r:.2}, \
             needed {:.2}",
            limits.trend
        )),
    }
}
