//! Likelihood of parts of trials, several of them in lockstep.
//!
//! The filter of [`super::filter`] with one column, a part in each lane: the numbers equal those of
//! one part after the other to the last bit.

use rayon::prelude::*;
use sistership_identification::refine::RefineError;
use sistership_simulation::simd::{SimdKernel, dispatch_simd};

use super::discrepancies::AxisDiscrepancies;
use super::filter::prediction_errors;
use super::filter_value::{LANES, ValueLanes};
use super::kalman_filter::KalmanFilter;
use super::linearised::LinearisedPart;
use super::noise::InstrumentNoise;

/// Returns minus twice the logarithm of the likelihood of each part, less a constant; each part has
/// one column that combines all others.
///
/// # Errors
/// Returns an error if the noise of a channel is unknown.
pub fn part_deviances(
    parts: &[&LinearisedPart],
    noise: &InstrumentNoise,
    discrepancies: &AxisDiscrepancies,
) -> Result<Vec<f64>, RefineError> {
    let mut order: Vec<usize> = (0..parts.len()).collect();
    // Parts of one shape are grouped, those of like length first.
    let moves = |part: &LinearisedPart| part.samples.len() > 1;
    let shape = |place: &usize| {
        let part = parts[*place];
        let channels: Vec<usize> = part.channels.iter().map(|(_, state)| *state).collect();
        (moves(part), part.by_state.is_some(), part.sizes.states, part.every, channels)
    };
    order.sort_by_cached_key(|place| (shape(place), usize::MAX - parts[*place].samples.len()));
    // A part of one sample has no transition and is filtered alone.
    let alike = order.chunk_by(|a, b| {
        let (a, b) = (parts[*a], parts[*b]);
        moves(a)
            && moves(b)
            && a.by_state.is_some() == b.by_state.is_some()
            && (a.sizes, a.every, &a.channels) == (b.sizes, b.every, &b.channels)
    });
    let together: Vec<&[usize]> = alike.flat_map(|alike| alike.chunks(LANES)).collect();
    let of = |places: &&[usize]| {
        let each: Vec<&LinearisedPart> = places.iter().map(|place| parts[*place]).collect();
        let found = match each[..] {
            [only] => vec![single_deviance(only, noise, discrepancies)?],
            _ => lockstep_deviances(each, noise, discrepancies)?,
        };
        Ok(places.iter().copied().zip(found).collect())
    };
    let mut all = vec![0.0; parts.len()];
    let found: Vec<Vec<(usize, f64)>> =
        together.par_iter().map(of).collect::<Result<_, RefineError>>()?;
    // Written by index, so that the order of the results does not depend on the grouping.
    found.into_iter().flatten().for_each(|(place, deviance)| all[place] = deviance);
    Ok(all)
}

fn single_deviance(
    part: &LinearisedPart,
    noise: &InstrumentNoise,
    discrepancies: &AxisDiscrepancies,
) -> Result<f64, RefineError> {
    let (errors, log_variance) = prediction_errors(part, noise, discrepancies)?;
    Ok(errors.iter().map(|error| error * error).sum::<f64>() + log_variance)
}

fn lockstep_deviances(
    parts: Vec<&LinearisedPart>,
    noise: &InstrumentNoise,
    discrepancies: &AxisDiscrepancies,
) -> Result<Vec<f64>, RefineError> {
    let filter = KalmanFilter::new(parts.clone(), noise, discrepancies, 2)?;
    // Sums of floating-point numbers begin with -0.0, as `Iterator::sum` does.
    let (mut squares, mut log_variances) = ([-0.0; LANES], [0.0; LANES]);
    dispatch_simd(DevianceKernel {
        parts: &parts,
        filter,
        squares: &mut squares,
        log_variances: &mut log_variances,
    });
    Ok((0..parts.len()).map(|lane| squares[lane] + log_variances[lane]).collect())
}

/// Arguments of a pass that sums squared prediction errors and logarithms of variances.
struct DevianceKernel<'a> {
    parts: &'a [&'a LinearisedPart],
    filter: KalmanFilter<'a, ValueLanes>,
    squares: &'a mut [f64; LANES],
    log_variances: &'a mut [f64; LANES],
}

impl SimdKernel for DevianceKernel<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { parts, mut filter, squares, log_variances } = self;
        let longest = parts.iter().map(|part| part.samples.len()).max().unwrap_or(0);
        for k in 0..longest {
            if k > 0 {
                filter.predict(k - 1);
            }
            if !k.is_multiple_of(parts[0].every) {
                continue;
            }
            filter.update(k, |error, variance, _| {
                for (lane, part) in parts.iter().enumerate() {
                    // A part that has ended stays at its last sample and no longer counts.
                    if k < part.samples.len() {
                        let scale = variance.0[lane].sqrt().recip();
                        let whitened = error[0].0[lane] * scale - -error[1].0[lane] * scale;
                        squares[lane] += whitened * whitened;
                        log_variances[lane] += variance.0[lane].ln();
                    }
                }
            });
        }
    }
}

#[cfg(test)]
#[path = "likelihood_tests.rs"]
mod tests;
