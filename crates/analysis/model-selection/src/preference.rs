//! Preference for the least error, or for a model of few physical parameters.

use sistership_identification::refine::CandidateEvaluation;

use crate::choice::is_tied;
use crate::thresholds::SEARCH;

/// Preference among models whose errors are nearly the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Preference {
    /// The model that the errors select.
    Accurate,
    /// A model of few physical parameters where it is as good as the model that the errors select, or
    /// far surer where no trial reaches.
    #[default]
    Defensible,
}

impl Preference {
    /// Every preference.
    pub const ALL: [Self; 2] = [Self::Accurate, Self::Defensible];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Accurate => "accurate",
            Self::Defensible => "defensible",
        }
    }

    /// The preference of that name.
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|preference| preference.name() == name)
    }
}

/// Returns the place of the physical model that replaces the selected one: of those with fewer
/// fitted coefficients, a source as it is among them, that are as good or far surer elsewhere, the
/// one with the least error. `None` if there is none. `all` has the evaluations, `true` for a
/// physical model.
///
/// As good is one whose error, and its sum with a multiple ([`SEARCH`]`.elsewhere`) of the variance
/// where no trial reaches, are no greater. Far surer is one whose error plus that variance is less by
/// a ratio ([`SEARCH`]`.surer`), and whose error is not significantly greater.
pub(crate) fn defensible_place(
    all: &[(&CandidateEvaluation, bool)],
    selected: usize,
) -> Option<usize> {
    let (chosen, is_physical) = all[selected];
    if is_physical {
        return None;
    }
    let to_replace = ExpectedErrors::from_evaluation(chosen)?;
    let replacing = |one: &CandidateEvaluation| {
        let is_smaller = one.coefficients < chosen.coefficients;
        let own = ExpectedErrors::from_evaluation(one).filter(|_| is_smaller)?;
        // What held-out trials clearly tell is not outweighed.
        let is_surer = || own.is_far_surer(&to_replace) && is_tied(one, chosen);
        (own.is_as_good(&to_replace) || is_surer()).then_some(own.held_out)
    };
    let physical = all.iter().enumerate().filter(|(_, (_, is_physical))| *is_physical);
    let as_good = physical.filter_map(|(place, (one, _))| Some((place, replacing(one)?)));
    as_good.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
}

/// Error on held-out trials, and its variance where no trial reaches.
struct ExpectedErrors {
    held_out: f64,
    elsewhere: f64,
}

impl ExpectedErrors {
    fn from_evaluation(one: &CandidateEvaluation) -> Option<Self> {
        let held_out = one.error.filter(|error| error.is_finite())?;
        Some(Self { held_out, elsewhere: one.variance.unwrap_or(f64::INFINITY) })
    }

    fn sum(&self, weight: f64) -> f64 {
        self.held_out + weight * self.elsewhere
    }

    fn is_as_good(&self, other: &Self) -> bool {
        let sums = [self, other].map(|one| one.sum(SEARCH.elsewhere));
        self.held_out <= other.held_out && sums[0] <= sums[1]
    }

    fn is_far_surer(&self, other: &Self) -> bool {
        // A model that does not complete the random orders gives way by its error (`choice`).
        other.elsewhere.is_finite() && SEARCH.surer * self.sum(1.0) <= other.sum(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn evaluation(coefficients: usize, errors: &[f64]) -> CandidateEvaluation {
        let each = errors.iter().enumerate().map(|(k, error)| (k.to_string(), *error)).collect();
        let error = Some(errors.iter().sum::<f64>() / errors.len() as f64);
        CandidateEvaluation {
            error,
            each,
            coefficients,
            variance: Some(0.01),
            reason: None,
            ..CandidateEvaluation::with_refusal(String::new())
        }
    }

    #[test]
    fn few_parameters_replace_many_only_where_they_are_as_good() {
        let many = evaluation(180, &[0.9, 1.1, 0.8, 1.2]);
        let tied = evaluation(28, &[0.8, 1.2, 0.7, 1.1]);
        let worse = evaluation(28, &[2.0, 1.9, 2.2, 2.4]);
        assert_eq!(defensible_place(&[(&many, false), (&tied, true)], 0), Some(1));
        assert_eq!(defensible_place(&[(&many, false), (&tied, false)], 0), None);
        assert_eq!(defensible_place(&[(&many, false), (&worse, true)], 0), None);
        assert_eq!(defensible_place(&[(&tied, true), (&many, false)], 0), None);
        let as_published = evaluation(0, &[0.7, 1.2, 0.7, 1.1]);
        assert_eq!(
            defensible_place(&[(&many, false), (&tied, true), (&as_published, true)], 0),
            Some(2)
        );
        let scattering = evaluation(28, &[0.9, 4.1, 0.8, 2.2]);
        let unsure = CandidateEvaluation { variance: Some(3.1), ..many.clone() };
        assert_eq!(defensible_place(&[(&unsure, false), (&scattering, true)], 0), Some(1));
        let surer = CandidateEvaluation { variance: Some(2.9), ..many.clone() };
        assert_eq!(defensible_place(&[(&surer, false), (&scattering, true)], 0), None);
        // Significantly greater on held-out trials.
        let unsurest = CandidateEvaluation { variance: Some(50.0), ..many.clone() };
        assert_eq!(defensible_place(&[(&unsurest, false), (&worse, true)], 0), None);
        let stops = CandidateEvaluation { variance: Some(f64::INFINITY), ..many.clone() };
        assert_eq!(defensible_place(&[(&stops, false), (&worse, true)], 0), None);
        let scattered = CandidateEvaluation { variance: Some(1.0), ..tied };
        assert_eq!(defensible_place(&[(&many, false), (&scattered, true)], 0), None);
    }
}
