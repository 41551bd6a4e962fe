//! The limits of one variant of a refinement, and the nearest coefficients within them.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, Matrix2};
use sistership_model::Model;
use sistership_model::law::Law;
use sistership_simulation::PlantError;

use super::conflict::find_conflict;
use super::error::LimitError;
use super::limit::{AffineFunction, CoefficientLimit};
use super::programme::{LimitEnforcement, NearestPointProblem};
use super::settings::{Constraints, StraightLine};
use super::straight::{
    affine_functions, has_stability, spectral_abscissa, stability_limit, surge_derivative,
    sway_and_yaw,
};
use super::thresholds::CONSTRAINTS;

/// Signs that physics determines: 1 for coefficients of at least 0, -1 for coefficients of at most
/// 0.
const SIGNS: [(&str, f64); 4] = [("Y_v", -1.0), ("N_r", -1.0), ("Y_delta", -1.0), ("N_delta", 1.0)];
/// Surge terms that are resistance in every published set of coefficients.
const BRAKES: [&str; 1] = ["X_deltadelta"];

/// Limits of the coefficients of a model.
pub struct CoefficientLimits {
    names: Vec<String>,
    source: Vec<f64>,
    /// Limits that do not depend on a solution.
    fixed: Vec<CoefficientLimit>,
    trust_sd: Option<f64>,
    straight: Option<(StraightLine, [AffineFunction; 4])>,
}

impl CoefficientLimits {
    /// Creates the limits for the coefficients that a model has; `speeds` are the least and the
    /// greatest speed that the trials covered, m/s.
    ///
    /// # Errors
    /// Returns an error that names the setting if it refers to a coefficient that the model does
    /// not have.
    pub fn new(
        settings: &Constraints,
        model: &Model,
        law: &Law,
        speeds: [f64; 2],
    ) -> Result<Self, LimitError> {
        let names: Vec<String> = model.coefficients.keys().cloned().collect();
        let mut fixed = Vec::new();
        if settings.physical_signs {
            fixed.extend(sign_limits(&names, &SIGNS, "physical sign"));
        }
        if settings.dissipative {
            fixed.extend(sign_limits(&names, &BRAKES.map(|name| (name, -1.0)), "dissipation"));
            fixed.extend(damping_limits(model, law, &names, speeds)?);
        }
        for (name, bound) in &settings.bounds {
            let unknown = || LimitError::Unknown(name.clone());
            let place = names.iter().position(|own| own == name).ok_or_else(unknown)?;
            // Both bounds become functions that are at least 0: `c - min` and `-(c - max)`.
            for (sign, bound, word) in [(1.0, bound.min, "least"), (-1.0, bound.max, "greatest")] {
                let limit = |bound| {
                    CoefficientLimit::at_least_zero(
                        format!("bound of {name}: {word} {bound}"),
                        AffineFunction::single_coefficient(names.len(), place, sign, bound),
                    )
                };
                fixed.extend(bound.map(limit));
            }
        }
        let straight = settings.straight_line.map(|line| {
            Ok::<_, PlantError>((line, affine_functions(model, law, &names, &sway_and_yaw)?))
        });
        let source = model.coefficients.values().map(|quantity| quantity.value).collect();
        Ok(Self {
            names,
            source,
            fixed,
            trust_sd: settings.trust_sd,
            straight: straight.transpose()?,
        })
    }

    /// Returns the coefficients within the limits that are nearest to a solution. `curvature` is
    /// the curvature of the objective over `names`; `prior` gives the prior's standard deviation of
    /// a coefficient.
    ///
    /// # Errors
    /// Returns an error with the limits that cannot be kept together, or with the solver's status
    /// if it found no solution.
    pub fn nearest_coefficients(
        &self,
        solution: &BTreeMap<String, f64>,
        names: &[String],
        curvature: &DMatrix<f64>,
        prior: &dyn Fn(&str) -> f64,
    ) -> Result<BTreeMap<String, f64>, LimitError> {
        // The regression orders coefficients by block, the limits by name: the curvature is brought
        // into the limits' order.
        let place = |name: &String| names.iter().position(|own| own == name);
        let places: Option<Vec<usize>> = self.names.iter().map(place).collect();
        let places = places.ok_or(LimitError::NotFitted)?;
        let curvature = curvature.select_rows(&places).select_columns(&places);
        // Distance is measured from the unconstrained solution.
        let centre: Vec<f64> =
            self.names.iter().map(|name| solution.get(name).copied().unwrap_or(0.0)).collect();
        let nearest = NearestPointProblem { centre: &centre, curvature: &curvature };
        let mut common = self.fixed.clone();
        common.extend(self.trust_region_limits(prior));
        let mut at = centre.clone();
        // The limit of straight-line stability depends on a reference matrix and is only sufficient
        // for it. Each round takes the last point as its reference, which makes the limit less
        // conservative.
        for _ in 0..if self.straight.is_some() { CONSTRAINTS.references } else { 1 } {
            let own = self.straight_line_limit(&at);
            let limits: Vec<&CoefficientLimit> = common.iter().chain(&own).collect();
            if limits.is_empty() {
                break;
            }
            at = solve_within(&nearest, &limits)?;
        }
        Ok(self.names.iter().cloned().zip(at).collect())
    }

    /// Checks that the coefficients of a model keep the limits that do not depend on a prior.
    ///
    /// # Errors
    /// Returns an error with the first limit that is not kept.
    pub fn check(&self, model: &Model) -> Result<(), LimitError> {
        let at: Vec<f64> = self.names.iter().map(|name| model.coefficient(name)).collect();
        // All fixed limits are half spaces, so that each has a single function.
        let broken = self.fixed.iter().find(|limit| limit.cone[0].value_at(&at) < 0.0);
        if let Some(limit) = broken {
            return Err(LimitError::Broken(limit.name.clone()));
        }
        match &self.straight {
            Some((line, functions)) if !has_stability(*line, &sway_yaw_matrix(functions, &at)) => {
                Err(LimitError::StraightLine(*line))
            }
            _ => Ok(()),
        }
    }

    /// Limits of the trust region about the source: `|c - source|` of at most `trust_sd` standard
    /// deviations of the prior; none without a trust region.
    fn trust_region_limits(&self, prior: &dyn Fn(&str) -> f64) -> Vec<CoefficientLimit> {
        let Some(sd) = self.trust_sd else { return Vec::new() };
        let one = |(place, name): (usize, &String)| {
            let reach = sd * prior(name);
            [1.0, -1.0].map(|sign| {
                let edge = self.source[place] - sign * reach;
                let word = if sign > 0.0 { "below" } else { "above" };
                let label = format!(
                    "trust region of {name}: at most {sd} standard deviations {word} the source"
                );
                CoefficientLimit::at_least_zero(
                    label,
                    AffineFunction::single_coefficient(self.names.len(), place, sign, edge),
                )
            })
        };
        self.names.iter().enumerate().flat_map(one).collect()
    }

    /// The limit of straight-line stability by the first reference matrix that has the declared
    /// stability: that of the solution, of the source, or of the solution with all eigenvalues
    /// shifted.
    fn straight_line_limit(&self, at: &[f64]) -> Option<CoefficientLimit> {
        let (line, functions) = self.straight.as_ref()?;
        let (own, source) =
            (sway_yaw_matrix(functions, at), sway_yaw_matrix(functions, &self.source));
        let towards =
            if *line == StraightLine::Stable { -CONSTRAINTS.shift } else { CONSTRAINTS.shift };
        // Adding a multiple of the identity shifts every eigenvalue by it: the largest real part
        // becomes `towards`.
        let shifted = own + Matrix2::identity() * (towards - spectral_abscissa(&own));
        let candidates =
            [own, source, shifted].into_iter().filter(|matrix| has_stability(*line, matrix));
        candidates.filter_map(|reference| stability_limit(*line, functions, &reference)).next()
    }
}

/// The nearest point within limits; where there is none, the error names the limits that conflict.
fn solve_within(
    nearest: &NearestPointProblem<'_>,
    limits: &[&CoefficientLimit],
) -> Result<Vec<f64>, LimitError> {
    match nearest.solve(limits, LimitEnforcement::Held) {
        Ok(point) => Ok(point.coefficients),
        Err(status) => Err(match find_conflict(nearest, limits) {
            Some(names) => LimitError::Conflict(names),
            None => LimitError::Solver(status),
        }),
    }
}

/// The matrix of sway and yaw from its four affine elements, row by row.
fn sway_yaw_matrix(functions: &[AffineFunction; 4], at: &[f64]) -> Matrix2<f64> {
    let [vv, vr, rv, rr] = [0, 1, 2, 3].map(|k: usize| functions[k].value_at(at));
    Matrix2::new(vv, vr, rv, rr)
}

/// Limits of sign for those coefficients of `signs` that the model has.
fn sign_limits(names: &[String], signs: &[(&str, f64)], what: &str) -> Vec<CoefficientLimit> {
    let one = |&(name, sign): &(&str, f64)| {
        let place = names.iter().position(|own| own == name)?;
        let word = if sign > 0.0 { "at least" } else { "at most" };
        Some(CoefficientLimit::at_least_zero(
            format!("{what}: {name} {word} 0"),
            AffineFunction::single_coefficient(names.len(), place, sign, 0.0),
        ))
    };
    signs.iter().filter_map(one).collect()
}

/// Limits by which surge acceleration falls with speed, at several speeds ahead that the trials
/// covered.
fn damping_limits(
    model: &Model,
    law: &Law,
    names: &[String],
    [low, high]: [f64; 2],
) -> Result<Vec<CoefficientLimit>, PlantError> {
    // Near rest the resistance and its slope vanish, so that the lowest speed is bounded from
    // below.
    let ahead = low.max(CONSTRAINTS.least_speed * high);
    let speeds: Vec<f64> = (0..CONSTRAINTS.speeds)
        .map(|k| ahead + (high - ahead) * k as f64 / (CONSTRAINTS.speeds - 1) as f64)
        .filter(|u| *u > 0.0)
        .collect();
    // `d(du/dt)/du <= 0` as a function that is at least 0.
    let one = |speed: f64| {
        let [slope] = affine_functions(model, law, names, &|ship| [surge_derivative(ship, speed)])?;
        Ok(CoefficientLimit::at_least_zero(
            format!("dissipation: surge damping at {speed:.2} m/s"),
            slope.linear_combination(-1.0, &slope, 0.0),
        ))
    };
    speeds.into_iter().map(one).collect()
}
