//! Estimation of a family's mean and covariance.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use rayon::prelude::*;

use super::evidence::{AxisIndex, MemberEvidence};
use super::prior::{FORMAT, FamilyAxis, FamilyPrior};
use super::thresholds::FAMILY;
use crate::statistics::TrialStatistics;
use sistership_identification::refine::RefineError;
use sistership_numerics::RegressionMoments;

/// Error of learning a family.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FamilyError {
    /// There are too few members with trials.
    #[error("{0} members have trials; a family's prior needs at least {least}", least = FAMILY.least_members)]
    Few(usize),
    /// The coefficients of a member differ.
    #[error(
        "`{member}` and `{first}` have different coefficients and cannot share a prior; use \
             one law for the family"
    )]
    Other {
        /// Name of the member.
        member: String,
        /// Name of another member.
        first: String,
    },
    /// The statistics of a member cannot be used.
    #[error("the statistics of `{member}` cannot be used: {reason}")]
    Statistics {
        /// Name of the member.
        member: String,
        /// Reason.
        reason: String,
    },
    /// The estimation broke down numerically.
    #[error("the covariance over the members cannot be estimated: {0}")]
    Numbers(String),
}

/// Member with the statistics of its trials.
#[derive(Debug, Clone, Copy)]
pub struct FamilyMember<'a> {
    /// Name of the member.
    pub name: &'a str,
    /// Statistics of its trials.
    pub trials: &'a [TrialStatistics],
}

/// Estimates the mean and covariance of every axis over the members; those without trials are
/// ignored.
///
/// # Errors
/// Returns a [`FamilyError`] if there are too few members, or if their statistics do not match or
/// cannot be used.
pub fn learn_family(members: &[FamilyMember<'_>]) -> Result<FamilyPrior, FamilyError> {
    let members: Vec<&FamilyMember<'_>> =
        members.iter().filter(|member| !member.trials.is_empty()).collect();
    if members.len() < FAMILY.least_members {
        return Err(FamilyError::Few(members.len()));
    }
    check_coefficients(&members)?;
    let places = axis_indices(&members)?;
    let evidence: Vec<Vec<MemberEvidence>> =
        places.iter().map(|place| members_evidence(place, &members)).collect::<Result<_, _>>()?;
    let design_effect = design_effect(&evidence);
    // Share of the correlations that is kept; smaller with fewer members per coefficient.
    let kept = |p: usize| members.len() as f64 / (members.len() + p + 1) as f64;
    let first = &members[0].trials[0];
    let mut prior = FamilyPrior {
        format: FORMAT.to_owned(),
        members: members.iter().map(|member| member.name.to_owned()).collect(),
        design_effect,
        correlations_kept: kept(places.iter().map(|place| place.units.len()).max().unwrap_or(0)),
        steps: 0,
        axes: Vec::new(),
    };
    for (place, evidence) in places.iter().zip(evidence) {
        let regression = &first.regressions[place.regression];
        let learned = FamilyEstimate::from_evidence(discount_evidence(evidence, design_effect))?;
        prior.steps = prior.steps.max(learned.steps);
        let names = regression.names[place.axis].clone();
        prior.axes.push(learned.family_axis(
            regression.axes[place.axis],
            names,
            &place.units,
            prior.correlations_kept,
        ));
    }
    Ok(prior)
}

/// Checks that all members have the same coefficients.
fn check_coefficients(members: &[&FamilyMember<'_>]) -> Result<(), FamilyError> {
    let names = |member: &FamilyMember<'_>| -> Vec<Vec<Vec<String>>> {
        member.trials[0].regressions.iter().map(|regression| regression.names.clone()).collect()
    };
    let first = names(members[0]);
    match members.iter().find(|member| names(member) != first) {
        Some(other) => Err(FamilyError::Other {
            member: other.name.to_owned(),
            first: members[0].name.to_owned(),
        }),
        None => Ok(()),
    }
}

/// Axes of the family, with units in which a coefficient of 1 explains all of its target, over all
/// members.
///
/// # Errors
/// Returns an error that names a member whose statistics cannot be used.
fn axis_indices(members: &[&FamilyMember<'_>]) -> Result<Vec<AxisIndex>, FamilyError> {
    let regressions = &members[0].trials[0].regressions;
    let axes = regressions
        .iter()
        .enumerate()
        .flat_map(|(r, regression)| (0..regression.axes.len()).map(move |axis| (r, axis)));
    let place = |(regression, axis): (usize, usize)| {
        Ok(AxisIndex { regression, axis, units: coefficient_units(members, regression, axis)? })
    };
    axes.map(place).collect()
}

/// Units of the coefficients of an axis: medians over the members of target deviation divided by
/// regressor deviation, which are robust to a few unusual ships.
fn coefficient_units(
    members: &[&FamilyMember<'_>],
    regression: usize,
    axis: usize,
) -> Result<Vec<f64>, FamilyError> {
    let p = members[0].trials[0].regressions[regression].moments.regressors();
    let of_member = |member: &&FamilyMember<'_>| -> Result<Option<Vec<f64>>, FamilyError> {
        let own = member.trials.iter().map(|trial| &trial.regressions[regression].moments);
        let Some(all) = RegressionMoments::merge_all(own) else { return Ok(None) };
        let all = all.about_origin();
        let unmixing = member.trials[0].regressions[regression].unmixing_matrix();
        let unmixing = unmixing.map_err(|reason| statistics_error(member, &reason))?;
        let q = all.targets();
        let target = (0..q)
            .map(|t| unmixing[(axis, t)].powi(2) * all.target_variance(t))
            .sum::<f64>()
            .sqrt();
        // A lower bound relative to the mean, as rounding leaves a constant with a small deviation.
        let moves =
            |j: usize| all.regressor_variance(j).sqrt().max(1e-12 * all.regressor_mean(j).abs());
        Ok(Some((0..p).map(|j| target / moves(j).max(f64::MIN_POSITIVE)).collect()))
    };
    let all: Vec<Option<Vec<f64>>> = members.iter().map(of_member).collect::<Result<_, _>>()?;
    let unit = |j: usize| positive_median(all.iter().flatten().map(|units| units[j]));
    // A regressor that varies in no member can have any unit.
    Ok((0..p).map(|j| unit(j).unwrap_or(1.0)).collect())
}

fn statistics_error(member: &FamilyMember<'_>, reason: &RefineError) -> FamilyError {
    FamilyError::Statistics { member: member.name.to_owned(), reason: reason.to_string() }
}

/// Upper median of the positive finite values.
fn positive_median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.filter(|value| value.is_finite() && *value > 0.0).collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// Evidence of all members on an axis.
fn members_evidence(
    place: &AxisIndex,
    members: &[&FamilyMember<'_>],
) -> Result<Vec<MemberEvidence>, FamilyError> {
    let of_member = |member: &&FamilyMember<'_>| {
        place.member_evidence(member.trials).map_err(|reason| statistics_error(member, &reason))
    };
    let all: Vec<Option<MemberEvidence>> =
        members.par_iter().map(of_member).collect::<Result<_, _>>()?;
    Ok(all.into_iter().flatten().collect())
}

/// Median design effect over members and axes, at least 1: samples never count for more than
/// independent ones.
fn design_effect(evidence: &[Vec<MemberEvidence>]) -> f64 {
    positive_median(evidence.iter().flatten().filter_map(|evidence| evidence.design_effect))
        .unwrap_or(1.0)
        .max(1.0)
}

/// Evidence with its weight divided by the design effect.
fn discount_evidence(mut evidence: Vec<MemberEvidence>, design_effect: f64) -> Vec<MemberEvidence> {
    for one in &mut evidence {
        one.precision /= design_effect;
        one.information /= design_effect;
    }
    evidence
}

/// Estimate of an axis over a family, in units of the coefficients.
struct FamilyEstimate {
    mean: DVector<f64>,
    covariance: DMatrix<f64>,
    told: DVector<f64>,
    members: f64,
    steps: usize,
}

impl FamilyEstimate {
    /// Iterates expectation and maximisation until the deviations settle.
    fn from_evidence(evidence: Vec<MemberEvidence>) -> Result<Self, FamilyError> {
        let p = evidence.first().map_or(0, |one| one.information.len());
        let mut learned = Self {
            mean: DVector::zeros(p),
            covariance: DMatrix::identity(p, p) * FAMILY.start.powi(2),
            told: DVector::zeros(p),
            members: evidence.len() as f64,
            steps: 0,
        };
        for step in 1..=FAMILY.steps {
            let before = learned.covariance.diagonal();
            learned.iterate_em(&evidence)?;
            learned.steps = step;
            // Largest relative change of a deviation.
            let changed = before.zip_map(&learned.covariance.diagonal(), |a, b| {
                (a.sqrt() / b.sqrt().max(FAMILY.least) - 1.0).abs()
            });
            if changed.max() < FAMILY.settled {
                break;
            }
        }
        Ok(learned)
    }

    /// One step of expectation and maximisation: the members given the family, then the family
    /// given the members.
    fn iterate_em(&mut self, evidence: &[MemberEvidence]) -> Result<(), FamilyError> {
        // The prior of every member, in information form.
        let precision = invert_positive(&self.covariance)?;
        // Expectation: posterior of each member, with the family as its prior.
        let pull = &precision * &self.mean;
        let member = |one: &MemberEvidence| -> Result<(DVector<f64>, DMatrix<f64>), FamilyError> {
            let covariance = invert_positive(&(&precision + &one.precision))?;
            Ok((&covariance * (&pull + &one.information), covariance))
        };
        // Collected in order, so that the sums do not depend on the number of cores.
        let members: Vec<_> = evidence.par_iter().map(member).collect::<Result<_, _>>()?;
        // Maximisation: the covariance is the scatter of the members' means plus their mean
        // posterior covariance.
        let mut mean = DVector::zeros(self.mean.len());
        members.iter().for_each(|(own, _)| mean += own / self.members);
        let mut covariance = DMatrix::zeros(mean.len(), mean.len());
        let mut open = DVector::zeros(mean.len());
        for (own, left) in &members {
            let apart = own - &mean;
            covariance += left / self.members;
            covariance.ger(1.0 / self.members, &apart, &apart, 1.0);
            open += left.diagonal() / self.members;
        }
        // A variance of zero would fix the coefficient for good.
        (0..mean.len())
            .for_each(|j| covariance[(j, j)] = covariance[(j, j)].max(FAMILY.least.powi(2)));
        // Share of a coefficient's variance that the trials resolve.
        self.told = open
            .zip_map(&self.covariance.diagonal(), |open, all| (1.0 - open / all).clamp(0.0, 1.0));
        self.covariance = covariance;
        self.mean = mean;
        Ok(())
    }

    /// Prior in the law's units, for a ship that is not a member. The deviations are widened
    /// because the mean is uncertain, and because maximum likelihood underestimates variances.
    fn family_axis(
        &self,
        axis: sistership_model::coefficient::Axis,
        names: Vec<String>,
        units: &[f64],
        kept: f64,
    ) -> FamilyAxis {
        let p = names.len();
        // N / (N - 1) corrects the variance, and 1 + 1/N adds that of the mean.
        let wider = self.members / (self.members - 1.0) * (1.0 + 1.0 / self.members);
        let deviation: Vec<f64> =
            (0..p).map(|j| (self.covariance[(j, j)] * wider).sqrt()).collect();
        let correlation = |i: usize, j: usize| {
            let full = self.covariance[(i, j)]
                / (self.covariance[(i, i)] * self.covariance[(j, j)]).sqrt();
            // Correlations are reduced towards zero; the deviations stay.
            if i == j { 1.0 } else { kept * full }
        };
        FamilyAxis {
            axis,
            names,
            mean: (0..p).map(|j| self.mean[j] * units[j]).collect(),
            deviation: deviation
                .iter()
                .zip(units)
                .map(|(deviation, unit)| deviation * unit)
                .collect(),
            correlation: (0..p).map(|i| (0..p).map(|j| correlation(i, j)).collect()).collect(),
            told_by_trials: self.told.iter().copied().collect(),
        }
    }
}

fn invert_positive(matrix: &DMatrix<f64>) -> Result<DMatrix<f64>, FamilyError> {
    let root: Option<Cholesky<f64, Dyn>> = matrix.clone().cholesky();
    root.map(|root| root.inverse())
        .ok_or_else(|| FamilyError::Numbers("a covariance is not positive definite".into()))
}
