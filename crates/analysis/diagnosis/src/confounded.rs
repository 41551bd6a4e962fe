//! Effects that these trials can hardly distinguish from those that were found.

use std::collections::BTreeMap;

use nalgebra::{Cholesky, DMatrix, DVector};

use super::evidence::MarginalInformation;
use super::hypothesis::JudgedHypothesis;
use super::outcome::ConfoundedEffect;
use super::search::HypothesisSearch;
use super::thresholds::THRESHOLDS;
use sistership_filtering::{EffectCandidate, FilterColumns, GramMatrix};
use sistership_identification::refine::RefineError;

/// Responses of the effects found and of all others, with the coefficients integrated out.
pub(super) struct EffectResponses<'a> {
    found: Vec<&'a EffectCandidate>,
    others: Vec<&'a EffectCandidate>,
    /// Indices of the columns of each in the information, those found first.
    places: Vec<Vec<usize>>,
    information: DMatrix<f64>,
}

impl<'a> EffectResponses<'a> {
    /// Creates the responses from products of columns: those of coefficients, of the effects found,
    /// and of the other effects.
    ///
    /// # Errors
    /// Returns an error if the information is not positive.
    pub fn new(
        search: &'a HypothesisSearch<'_>,
        columns: &FilterColumns,
        judged: &'a JudgedHypothesis,
        (others, total): (Vec<&'a EffectCandidate>, &GramMatrix),
    ) -> Result<Self, RefineError> {
        let found: Vec<&EffectCandidate> = judged.candidates.iter().collect();
        let all: Vec<&EffectCandidate> = found.iter().chain(&others).copied().collect();
        let columns: Vec<Vec<usize>> =
            all.iter().map(|candidate| columns.matching_columns(candidate)).collect();
        let select: Vec<usize> =
            (0..search.nuisance.len()).chain(columns.iter().flatten().copied()).collect();
        // Columns are consecutive in the reduced information, in the order of `all`.
        let mut first = 0;
        let place = |columns: &Vec<usize>| {
            first += columns.len();
            (first - columns.len()..first).collect()
        };
        let places = columns.iter().map(place).collect();
        let information =
            MarginalInformation::new(&total.select_columns(&select), &search.fixed)?.information;
        Ok(Self { found, others, places, information })
    }

    /// Effects that are nearly the same as one found, the nearest first.
    pub fn confounded_with(&self, found: usize) -> Vec<ConfoundedEffect> {
        let mut nearest: BTreeMap<&str, ConfoundedEffect> = BTreeMap::new();
        for other in 0..self.others.len() {
            let Some((angle_deg, behind)) = self.angle_and_evidence(found, other) else { continue };
            let name = self.others[other].effect.as_str();
            // Of several forms of an effect the nearest one counts.
            let is_nearer = nearest.get(name).is_none_or(|known| angle_deg < known.angle_deg);
            if angle_deg < THRESHOLDS.confounding.apart_deg && is_nearer {
                nearest.insert(name, ConfoundedEffect { name: name.to_owned(), angle_deg, behind });
            }
        }
        let mut all: Vec<ConfoundedEffect> = nearest.into_values().collect();
        all.sort_by(|a, b| a.angle_deg.total_cmp(&b.angle_deg));
        all
    }

    /// Least evidence against any of some other effects as the true cause.
    pub fn least_evidence_against(&self, found: usize, names: &[&str]) -> Option<f64> {
        let named = (0..self.others.len())
            .filter(|&other| names.contains(&self.others[other].effect.as_str()));
        named
            .filter_map(|other| Some(self.angle_and_evidence(found, other)?.1))
            .min_by(f64::total_cmp)
    }

    /// Angle between the response of an effect found and the nearest that another could give, deg;
    /// and the evidence against this other one.
    fn angle_and_evidence(&self, found: usize, other: usize) -> Option<(f64, f64)> {
        let change = DVector::from_vec(self.found[found].parameter_changes());
        let (own, other) = (&self.places[found], &self.places[self.found.len() + other]);
        let part = |rows: &[usize], columns: &[usize]| {
            DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
                self.information[(rows[i], columns[j])]
            })
        };
        // Squared length of the response, and its part in the space of the other effect: cos^2 of
        // the angle.
        let response = change.dot(&(part(own, own) * &change));
        let seen = part(other, own) * &change;
        let mut information = part(other, other);
        // A ridge far below any information of interest: some parameters of an effect may have the
        // same response on these trials.
        let ridge = THRESHOLDS.confounding.ridge * information.diagonal().max();
        (0..other.len()).for_each(|i| information[(i, i)] += ridge);
        let followed = seen.dot(&Cholesky::new(information)?.solve(&seen));
        let share = (followed / response).clamp(0.0, 1.0);
        Some((share.sqrt().acos().to_degrees(), 0.5 * response * (1.0 - share)))
    }
}
