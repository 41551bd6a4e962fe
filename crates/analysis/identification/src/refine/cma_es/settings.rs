//! Settings and report of the search by CMA-ES.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sistership_simulation::Method;

/// Settings of the search by CMA-ES.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CmaEs {
    /// Seed of all random numbers.
    pub seed: u64,
    /// Population of the first run: Miyauchi 2024, sec. 3.5.
    #[schemars(range(min = 4, max = 100_000))]
    pub population: usize,
    /// Largest population of a restart, each of which has twice that of the run before.
    #[schemars(range(min = 4, max = 100_000))]
    pub largest_population: usize,
    /// Largest number of evaluations of the fit on all trials. A version records the number of
    /// evaluations that were made, so that it can be derived again.
    #[schemars(range(min = 1))]
    pub evaluations: usize,
    /// Longest elapsed time of the fit on all trials, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub wall_s: Option<f64>,
    /// Longest CPU time of the fit on all trials, s, summed over all cores.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub cpu_s: Option<f64>,
    /// Evaluations of each fit with held-out trials as a share of those of the fit on all trials,
    /// at whose optimum it starts.
    #[schemars(range(min = 0, max = 1))]
    pub fold_share: f64,
    /// Half width of the box in units of the natural size of a coefficient.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub box_width: f64,
    /// Standard deviation of the first candidates in the same units.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub spread: f64,
    /// Weight of the deviation penalty, `alpha/T` for as many combinations as in the paper.
    #[schemars(range(min = 0))]
    pub deviation: f64,
    /// Weight of the sizes of the parameters, `lambda/T` where 1 is the edge of the box.
    #[schemars(range(min = 0))]
    pub absolute: f64,
    /// Integration method.
    pub integration: Method,
}

impl Default for CmaEs {
    /// The paper's populations, box and Euler's method, and `alpha` of 1e2 s over its 7,407 s;
    /// `lambda` of zero, which did best there.
    fn default() -> Self {
        Self {
            seed: 1,
            population: 64,
            largest_population: 256,
            evaluations: 20_000,
            wall_s: None,
            cpu_s: None,
            fold_share: 0.1,
            box_width: 10.0,
            spread: 0.05,
            // `alpha/T` of the paper.
            deviation: 1e2 / 7407.4,
            absolute: 0.0,
            integration: Method::Euler,
        }
    }
}

/// The error type for settings of the search that are refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(in super::super) enum CmaEsError {
    #[error("population must be from 4 to 100000, and largest_population at least as large")]
    Population,
    #[error("evaluations, wall_s and cpu_s must be above 0")]
    Budget,
    #[error("box_width and spread must be above 0")]
    Box,
    #[error("fold_share must be from 0 to 1")]
    FoldShare,
    #[error("deviation and absolute must not be below 0")]
    Weights,
}

impl CmaEs {
    /// Checks that the settings are in range.
    ///
    /// # Errors
    /// Returns an error with the settings at fault and the values that are allowed.
    pub(in super::super) fn check(&self) -> Result<(), CmaEsError> {
        let positive = |value: f64| value > 0.0 && value.is_finite();
        let limit = |value: Option<f64>| value.is_none_or(positive);
        if !(4..=100_000).contains(&self.population)
            || !(self.population..=100_000).contains(&self.largest_population)
        {
            return Err(CmaEsError::Population);
        }
        if self.evaluations == 0 || !limit(self.wall_s) || !limit(self.cpu_s) {
            return Err(CmaEsError::Budget);
        }
        if !(positive(self.box_width) && positive(self.spread)) {
            return Err(CmaEsError::Box);
        }
        if !(0.0..=1.0).contains(&self.fold_share) {
            return Err(CmaEsError::FoldShare);
        }
        if [self.deviation, self.absolute]
            .iter()
            .any(|weight| !(*weight >= 0.0 && weight.is_finite()))
        {
            return Err(CmaEsError::Weights);
        }
        Ok(())
    }
}

/// Report of a search on all trials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SearchReport {
    /// Its seed.
    pub seed: u64,
    /// Evaluations of the fit on all trials.
    pub evaluations: usize,
    /// Evaluations of the fits with held-out trials together.
    pub fold_evaluations: usize,
    /// The population of each run.
    pub populations: Vec<usize>,
    /// Runs after the first.
    pub restarts: usize,
    /// The least objective.
    pub objective: f64,
    /// First part of the objective: the standardised squared error of u, v and r by time.
    pub error: f64,
    /// Share of the extreme states and controls whose accelerations exceed the measured ones,
    /// weighted by how soon they do.
    pub deviation: f64,
}
