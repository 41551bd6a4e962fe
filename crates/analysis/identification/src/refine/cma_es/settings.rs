//! What a search may be told, and what it reports.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sistership_simulation::Method;

/// Settings of the search.
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
    /// Most evaluations of the fit on all trials. What was really evaluated is what a version
    /// records, so that it can be derived again.
    #[schemars(range(min = 1))]
    pub evaluations: usize,
    /// Most time of the fit on all trials, s on the wall.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub wall_s: Option<f64>,
    /// Most time of the fit on all trials, s of the whole process on all cores.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub cpu_s: Option<f64>,
    /// Evaluations of each fit with trials left out, by those of the fit on all, at whose optimum
    /// it starts.
    #[schemars(range(min = 0, max = 1))]
    pub fold_share: f64,
    /// Half width of the box by the natural size of a coefficient.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub box_width: f64,
    /// Standard deviation of the first candidates likewise.
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
            deviation: 1e2 / 7407.4,
            absolute: 0.0,
            integration: Method::Euler,
        }
    }
}

/// Why settings of the search are refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(in super::super) enum CmaEsError {
    #[error("population must be from 4 to 100000, largest_population not less")]
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
    /// Checks the numbers.
    ///
    /// # Errors
    /// Says which and what it may be.
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

/// What a search did on all trials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SearchReport {
    /// Its seed.
    pub seed: u64,
    /// Evaluations, and those of the fits with trials left out together.
    pub evaluations: usize,
    /// Of the fits with trials left out.
    pub fold_evaluations: usize,
    /// The population of each run.
    pub populations: Vec<usize>,
    /// Runs after the first.
    pub restarts: usize,
    /// The least objective.
    pub objective: f64,
    /// Its first part: the standardised squared error of u, v and r by time.
    pub error: f64,
    /// The share of the extreme states and controls whose accelerations are beyond what was
    /// measured, weighed by how soon.
    pub deviation: f64,
}
