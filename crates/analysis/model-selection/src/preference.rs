//! Preference for the least error, or for a model of few physical parameters.

use sistership_identification::refine::CandidateEvaluation;

use crate::thresholds::SEARCH;

/// Preference among models whose errors are nearly the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Preference {
    /// The model that the errors select.
    Accurate,
    /// A model of few physical parameters where both its error and its variance elsewhere are no
    /// greater than those of the model that the errors select.
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
/// fitted coefficients, a source as it is among them, whose error, and its sum with a multiple of the
/// variance elsewhere, are no greater than a ratio ([`SEARCH`]`.defensible`) times those of the selected one, the one with the least
/// error. `None` if there is none. `all` has the evaluations, `true` for a physical model.
pub(crate) fn defensible_place(
    all: &[(&CandidateEvaluation, bool)],
    selected: usize,
) -> Option<usize> {
    let (chosen, is_physical) = all[selected];
    if is_physical {
        return None;
    }
    // Error, and its sum with the variance elsewhere.
    let figures = |one: &CandidateEvaluation| {
        let error = one.error.filter(|error| error.is_finite())?;
        Some([error, error + SEARCH.elsewhere * one.variance.unwrap_or(f64::INFINITY)])
    };
    let [error, anywhere] = figures(chosen)?;
    let is_as_good = |one: &CandidateEvaluation| {
        let own = figures(one).filter(|_| one.coefficients < chosen.coefficients)?;
        let ratio = SEARCH.defensible;
        (own[0] <= ratio * error && own[1] <= ratio * anywhere).then_some(own[0])
    };
    let physical = all.iter().enumerate().filter(|(_, (_, is_physical))| *is_physical);
    let as_good = physical.filter_map(|(place, (one, _))| Some((place, is_as_good(one)?)));
    as_good.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
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
        let scattered = CandidateEvaluation { variance: Some(1.0), ..tied };
        assert_eq!(defensible_place(&[(&many, false), (&scattered, true)], 0), None);
    }
}
