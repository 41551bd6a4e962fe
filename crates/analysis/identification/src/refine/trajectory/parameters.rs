//! Nonlinear parameters of a law as unbounded unknowns.
//!
//! A parameter `p` of the physical range `(a, b)` is `p = a + (b - a)/(1 + exp(-q))`, so that no
//! step leaves the range. Its prior is normal in `q` about the source's value, with the standard
//! deviation that the law declares divided by `dp/dq` there.

use sistership_model::Model;
use sistership_model::law::{Law, ParameterPrior};

/// A parameter of a law with its prior and its transformation.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BoundedParameter {
    pub name: String,
    /// Standard deviation of the prior, in the parameter's unit.
    pub deviation: f64,
    source: f64,
    low: f64,
    width: f64,
}

impl BoundedParameter {
    /// Creates a parameter about the source's value; the range reaches a deviation beyond that.
    fn new(name: &str, source: f64, prior: ParameterPrior) -> Self {
        let [low, high] = prior.range;
        let low = low.min(source - prior.deviation);
        let high = high.max(source + prior.deviation);
        Self { name: name.to_owned(), deviation: prior.deviation, source, low, width: high - low }
    }

    /// The unknown at the source's value.
    pub fn source_unknown(&self) -> f64 {
        let share = (self.source - self.low) / self.width;
        (share / (1.0 - share)).ln()
    }

    /// Standard deviation of the prior of the unknown.
    pub fn unknown_deviation(&self) -> f64 {
        self.deviation / self.slope(self.source_unknown())
    }

    /// The parameter at an unknown.
    pub fn value(&self, unknown: f64) -> f64 {
        self.low + self.width * logistic(unknown)
    }

    /// Derivative of the parameter by its unknown.
    pub fn slope(&self, unknown: f64) -> f64 {
        let share = logistic(unknown);
        self.width * share * (1.0 - share)
    }
}

fn logistic(unknown: f64) -> f64 {
    1.0 / (1.0 + (-unknown).exp())
}

/// Returns the parameters that trials determine: those with a prior that do not follow from the
/// ship's particulars.
pub(super) fn free_parameters(model: &Model, law: &Law) -> Vec<BoundedParameter> {
    let is_free = |name: &str| law.derived_parameter(name, &model.particulars).is_none();
    law.parameter_priors()
        .filter(|(name, _)| is_free(name))
        .filter_map(|(name, prior)| {
            Some(BoundedParameter::new(name, model.parameters.get(name)?.value, prior))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn no_unknown_leaves_the_range() {
        let prior = ParameterPrior { value: 0.3, deviation: 0.1, range: [0.0, 0.7] };
        let parameter = BoundedParameter::new("w_P0", 0.4, prior);
        assert!((parameter.value(parameter.source_unknown()) - 0.4).abs() < 1e-12);
        assert!(parameter.value(-50.0) >= 0.0 && parameter.value(50.0) <= 0.7);
        let by = 1e-6;
        let slope = (parameter.value(0.3 + by) - parameter.value(0.3 - by)) / (2.0 * by);
        assert!((parameter.slope(0.3) - slope).abs() < 1e-8);
    }

    #[test]
    fn a_source_at_the_bound_may_still_move() {
        let prior = ParameterPrior { value: 0.3, deviation: 0.1, range: [0.0, 0.7] };
        let parameter = BoundedParameter::new("w_P0", 0.0, prior);
        assert!((parameter.value(parameter.source_unknown())).abs() < 1e-12);
        assert!(parameter.unknown_deviation().is_finite());
        assert!(parameter.value(-3.0) > -0.1);
    }
}
