//! Whether an effect is the same at all times. What only resembles something else is needed in one size here and in another
//! there: the pieces of the trials, each by itself, ask for more than what all together gave.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::base::Base;
use super::discount::is_from_outside;
use super::evidence::{Fixed, Fixing, Reduced};
use super::search::{Judged, Search, priors};
use crate::residual::Gram;
use sistership_estimate::refine::RefineError;

/// Pieces of each trial.
const PIECES: usize = 2;
/// The share of an effect's own response by which its pieces may differ, as a square.
const LIMIT: f64 = 0.1;

impl Search<'_> {
    /// The effects that are not. One that follows a record from outside may vary where records of other times explain the
    /// trials less ([`Search::follow_records`]): what is unknown does not follow that record.
    ///
    /// # Errors
    /// Names what a trial lacks.
    pub fn inconstant(&self, base: &Base<'_>, judged: &Judged, margin: f64) -> Result<Vec<usize>, RefineError> {
        let pieces = base.stand(&self.learned, &judged.stood)?.pieces(judged.level, PIECES);
        let known = self.known_after(judged);
        let reduced: Vec<Reduced> = pieces.iter().filter_map(|piece| Reduced::new(piece, &known)).collect();
        let varies: Vec<f64> = (0..judged.stood.len()).map(|place| self.varies(judged, place, &reduced)).collect();
        let mut places: Vec<usize> = (0..varies.len()).filter(|&place| varies[place] > LIMIT).collect();
        let is_outside = |place: &usize| is_from_outside(&judged.candidates[*place]);
        if places.iter().any(is_outside) && self.follow_records(judged, margin)? {
            places.retain(|place| !is_outside(place));
        }
        Ok(places)
    }

    /// What is known of the coefficients after all trials, whose change has been fitted.
    fn known_after(&self, judged: &Judged) -> Fixed {
        let size = self.nuisance.len();
        let total = Gram::sum(&judged.grams, judged.grams.first().map_or(0, |gram| gram.products.nrows()));
        let information = total.products.view((1, 1), (size, size)) + &self.fixed.information;
        Fixed { weighted_mean: &information * &judged.shift, information }
    }

    /// What pieces ask for beyond the common size and beyond chance, by the response to that size.
    fn varies(&self, judged: &Judged, place: usize, pieces: &[Reduced]) -> f64 {
        let first: usize = judged.stood[..place].iter().map(|stood| stood.at.len()).sum();
        let own = first..first + judged.stood[place].at.len();
        let moved = judged.candidates.iter().zip(&judged.stood).flat_map(|(c, s)| c.at.iter().zip(&s.at).map(|(a, b)| a - b));
        let moved = DVector::from_iterator(pieces.first().map_or(0, |piece| piece.right.len()), moved);
        let fixing: Vec<Fixing> = priors(&judged.stood[place]);
        let change = DVector::from_vec(judged.candidates[place].change());
        let (mut asked, mut chance, mut response) = (0.0, 0.0, 0.0);
        for piece in pieces {
            let left = (&piece.right - &piece.information * &moved).rows(own.start, own.len()).into_owned();
            let information = piece.information.view((own.start, own.start), (own.len(), own.len())).into_owned();
            let prior = DMatrix::from_diagonal(&DVector::from_iterator(own.len(), fixing.iter().map(|f| f.deviation.powi(-2))));
            let Some(factor) = Cholesky::new(&information + prior) else { continue };
            asked += left.dot(&factor.solve(&left));
            chance += factor.solve(&information).trace();
            response += change.dot(&(&information * &change));
        }
        (asked - self.discount(&judged.candidates[place]) * chance) / response.max(1e-9)
    }
}
