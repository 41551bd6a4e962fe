//! Sizes at which the detection of a parameter is evaluated.

use sistership_model::effect::EffectParameter;

use super::super::thresholds::THRESHOLDS;

/// Sizes of a parameter on both sides of the absence of its effect, which is zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SizeGrid {
    /// Largest plausible size below zero; 0 where no value below zero is expected.
    below: f64,
    /// Largest plausible size above zero; 0 where no value above zero is expected.
    above: f64,
}

impl SizeGrid {
    /// Sizes on the side of the prior mean. A mean of zero expects both sides of the bounds.
    pub fn new(parameter: &EffectParameter) -> Self {
        let [least, most] = parameter.bounds;
        let (below, above) = ((-least).max(0.0), most.max(0.0));
        match parameter.prior_mean {
            mean if mean > 0.0 => Self { below: 0.0, above },
            mean if mean < 0.0 => Self { below, above: 0.0 },
            _ => Self { below, above },
        }
    }

    /// Returns the smallest size of which every expected value is shown, from a grid of equal ratios
    /// below the largest one; none where there is no such size.
    pub fn smallest_shown(&self, is_shown: impl Fn(f64) -> bool) -> Option<f64> {
        let given = THRESHOLDS.limits;
        let largest = self.below.max(self.above);
        let sizes = (0..given.steps).map(|k| largest * given.ratio.powi(-(k as i32)));
        let all_shown = |size: &f64| self.expected_values(*size).all(&is_shown);
        // The largest sizes may be implausible: their prior probability is too low.
        sizes.skip_while(|size| !all_shown(size)).take_while(all_shown).last()
    }

    /// Values of a size on the sides that extend to it.
    fn expected_values(&self, size: f64) -> impl Iterator<Item = f64> {
        let below = (size <= self.below).then_some(-size);
        below.into_iter().chain((size <= self.above).then_some(size))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_formula::units::Dimension;
    use sistership_model::effect::Mirror;

    use super::*;

    fn grid(prior_mean: f64, bounds: [f64; 2]) -> SizeGrid {
        SizeGrid::new(&EffectParameter {
            dimension: Dimension::NONE,
            prior_mean,
            prior_deviation: 1.0,
            bounds,
            absent: 0.0,
            start: 0.0,
            shape: false,
            mirror: Mirror::Same,
        })
    }

    fn is_near(size: Option<f64>, wanted: f64) -> bool {
        size.is_some_and(|size| (1.0..1.1).contains(&(size / wanted)))
    }

    #[test]
    fn a_negative_mean_has_the_limit_of_its_negative_values() {
        let shown_below = |value: f64| value <= -0.3 && value > -2.0;
        assert!(is_near(grid(-0.6, [-6.0, 6.0]).smallest_shown(shown_below), 0.3));
        assert!(is_near(grid(0.0, [-6.0, 0.0]).smallest_shown(shown_below), 0.3));
        assert_eq!(grid(0.6, [-6.0, 6.0]).smallest_shown(shown_below), None);
    }

    #[test]
    fn a_mean_of_zero_is_limited_by_the_side_that_is_harder_to_show() {
        let shown = |value: f64| value >= 0.1 || value <= -0.4;
        assert!(is_near(grid(0.0, [-3.0, 3.0]).smallest_shown(shown), 0.4));
        assert!(is_near(grid(0.0, [0.0, 3.0]).smallest_shown(shown), 0.1));
        // Beyond the bound of one side only the other is expected.
        assert!(is_near(grid(0.0, [-0.3, 3.0]).smallest_shown(shown), 0.3));
    }

    #[test]
    fn sizes_stay_within_the_bound_of_their_side() {
        let largest = grid(0.5, [-9.0, 2.0]).smallest_shown(|value| value > 1.9).unwrap();
        assert_eq!(largest, 2.0);
    }
}
