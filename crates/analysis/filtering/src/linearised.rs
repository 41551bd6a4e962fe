//! A model linearised along a recorded motion.

use sistership_model::trial::Channel;

/// Linearisation along one gap-free part of a trial: transition of deviations from the recorded
/// path from sample to sample, and their readings. All matrices are row by row, sample after
/// sample.
#[derive(Debug, Clone)]
pub struct LinearisedPart {
    /// Indices of the samples of the trial.
    pub samples: Vec<usize>,
    /// Time of each, s.
    pub t_s: Vec<f64>,
    /// Numbers of states, accelerations and columns.
    pub sizes: LinearisationSizes,
    /// Jacobian of the states' rates: states by states, for each interval.
    pub jacobian: Vec<f64>,
    /// Derivatives of the accelerations with the columns: axes by columns, for each interval.
    pub accelerations: Vec<f64>,
    /// Movement by the model less that of the recorded path over each interval, by state.
    pub defect: Vec<f64>,
    /// Readings less those that instruments would give on the path, by recorded channel.
    pub reading: Vec<f64>,
    /// Derivatives of readings with the states: channels by states; absent where all instruments
    /// read the state itself.
    pub by_state: Option<Vec<f64>>,
    /// Derivatives of readings with the columns that act on instruments: channels by `measured`
    /// columns.
    pub by_column: Vec<f64>,
    /// Columns that act on instruments.
    pub measured: Vec<usize>,
    /// Part of `reading` and of `by_column` that depends on the rate of a state.
    pub by_rate: Vec<RateResponse>,
    /// The recorded channels with their indices among the states.
    pub channels: Vec<(Channel, usize)>,
    /// Number of samples per reading.
    pub every: usize,
}

/// Dependence of a reading, or of its derivative with a column, on the rate of a state, as for a
/// delayed instrument.
///
/// The rate on the path contains the noise of the very reading that is predicted, so that it would
/// correlate with the prediction error of a model that is right; the rate at the state that the
/// filter expects does not (errors in variables: Soderstrom 2007, Automatica 43, 939-958).
#[derive(Debug, Clone, PartialEq)]
pub struct RateResponse {
    /// Index of the channel among those that are recorded.
    pub channel: usize,
    /// Column; none for the reading itself with the parameters at their values.
    pub column: Option<usize>,
    /// State.
    pub state: usize,
    /// Change of the reading by a unit of the rate (and of the column), at each sample.
    pub by: Vec<f64>,
}

/// Extent of a linearisation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinearisationDetail {
    /// Everything.
    Whole,
    /// The path and the columns; transitions and readings of deviations come from another
    /// linearisation.
    Columns,
}

/// Sizes of a linearisation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LinearisationSizes {
    /// Number of states.
    pub states: usize,
    /// Number of accelerations.
    pub axes: usize,
    /// Number of columns.
    pub columns: usize,
}

impl LinearisedPart {
    /// Combines the path and the columns of this linearisation with the filter (transitions and
    /// readings of deviations) of another.
    pub fn with_filter_from(self, other: &Self) -> Self {
        Self { jacobian: other.jacobian.clone(), by_state: other.by_state.clone(), ..self }
    }

    /// Sums all columns, weighted by given parameters, into one column, with rates as they are on
    /// the path.
    pub fn combine_columns(&self, parameters: &[f64]) -> Self {
        let weighted =
            |row: &[f64]| row.iter().zip(parameters).map(|(value, by)| value * by).sum::<f64>();
        let measured: Vec<f64> = self.measured.iter().map(|&column| parameters[column]).collect();
        let said =
            |row: &[f64]| row.iter().zip(&measured).map(|(value, by)| value * by).sum::<f64>();
        Self {
            sizes: LinearisationSizes { columns: 1, ..self.sizes },
            accelerations: self
                .accelerations
                .chunks_exact(self.sizes.columns.max(1))
                .map(weighted)
                .collect(),
            by_column: self.by_column.chunks_exact(self.measured.len().max(1)).map(said).collect(),
            measured: if self.measured.is_empty() { Vec::new() } else { vec![0] },
            ..self.without_columns()
        }
    }

    /// Removes all columns but the first.
    pub fn truncate_columns(&mut self, count: usize) {
        let (all, seen) = (self.sizes.columns, self.measured.len());
        if count >= all {
            return;
        }
        let rows = self.accelerations.chunks_exact(all);
        self.accelerations = rows.flat_map(|row| &row[..count]).copied().collect();
        let kept: Vec<usize> = (0..seen).filter(|&place| self.measured[place] < count).collect();
        let rows = self.by_column.chunks_exact(seen.max(1));
        self.by_column = rows.flat_map(|row| kept.iter().map(|&place| row[place])).collect();
        self.measured.retain(|column| *column < count);
        self.by_rate.retain(|response| response.column.is_none_or(|column| column < count));
        self.sizes.columns = count;
    }

    /// Copy of the path and its filter, which are small in comparison with the columns.
    fn without_columns(&self) -> Self {
        Self {
            sizes: LinearisationSizes { columns: 0, ..self.sizes },
            accelerations: Vec::new(),
            by_column: Vec::new(),
            measured: Vec::new(),
            by_rate: Vec::new(),
            samples: self.samples.clone(),
            t_s: self.t_s.clone(),
            jacobian: self.jacobian.clone(),
            defect: self.defect.clone(),
            reading: self.reading.clone(),
            by_state: self.by_state.clone(),
            channels: self.channels.clone(),
            every: self.every,
        }
    }

    /// Keeps some columns as they are and appends each column of `cut` once for every weight of a
    /// time, multiplied by that weight.
    pub fn weight_columns(
        &self,
        kept: &[usize],
        cut: &[usize],
        weights: &dyn Fn(f64) -> Vec<f64>,
    ) -> Self {
        let count = self.t_s.first().map_or(0, |t| weights(*t).len());
        let copies = cut.iter().flat_map(|&column| (0..count).map(move |k| (column, Some(k))));
        // Kept columns come first, then the pieces of each cut column in the order of the weights.
        let pieces: Vec<WeightedColumn> =
            kept.iter().map(|&column| (column, None)).chain(copies).collect();
        let place = |column: usize| self.measured.iter().position(|&known| known == column);
        let seen: Vec<(usize, WeightedColumn)> = pieces
            .iter()
            .enumerate()
            .filter_map(|(own, &(column, copy))| Some((own, (place(column)?, copy))))
            .collect();
        // Derivatives of the readings, taken at the samples; those of the accelerations are taken
        // in the middle of each interval (`in_pieces`).
        let mut by_column = Vec::new();
        if !seen.is_empty() {
            let rows = self.channels.len() * self.measured.len();
            for (t, rows) in self.t_s.iter().zip(self.by_column.chunks_exact(rows)) {
                let by = weights(*t);
                for row in rows.chunks_exact(self.measured.len()) {
                    by_column
                        .extend(seen.iter().map(|(_, piece)| weighted_value(*piece, row, &by)));
                }
            }
        }
        Self {
            sizes: LinearisationSizes { columns: pieces.len(), ..self.sizes },
            accelerations: self.weighted_accelerations(&pieces, weights),
            by_column,
            measured: seen.into_iter().map(|(own, _)| own).collect(),
            by_rate: self.weighted_rate_responses(&pieces, weights),
            ..self.without_columns()
        }
    }

    fn weighted_rate_responses(
        &self,
        pieces: &[WeightedColumn],
        weights: &dyn Fn(f64) -> Vec<f64>,
    ) -> Vec<RateResponse> {
        let of = |(column, &(from, copy)): (usize, &WeightedColumn)| {
            let weight = |t: &f64| copy.map_or(1.0, |copy| weights(*t)[copy]);
            let weighted = |response: &RateResponse| {
                let by = response.by.iter().zip(&self.t_s).map(|(by, t)| by * weight(t)).collect();
                RateResponse { column: Some(column), by, ..response.clone() }
            };
            let own = self.by_rate.iter().filter(move |response| response.column == Some(from));
            own.map(weighted).collect::<Vec<_>>()
        };
        // Responses without a column belong to the reading itself and stay as they are.
        let said = self.by_rate.iter().filter(|response| response.column.is_none()).cloned();
        said.chain(pieces.iter().enumerate().flat_map(of)).collect()
    }

    fn weighted_accelerations(
        &self,
        pieces: &[WeightedColumn],
        weights: &dyn Fn(f64) -> Vec<f64>,
    ) -> Vec<f64> {
        let LinearisationSizes { axes, columns, .. } = self.sizes;
        let steps = self.accelerations.chunks_exact((axes * columns).max(1));
        let mut all = Vec::with_capacity(steps.len() * axes * pieces.len());
        for (ends, rows) in self.t_s.windows(2).zip(steps) {
            // Accelerations are means over an interval, so their weight is that of its middle.
            let by = weights(0.5 * (ends[0] + ends[1]));
            for row in rows.chunks_exact(columns) {
                all.extend(pieces.iter().map(|piece| weighted_value(*piece, row, &by)));
            }
        }
        all
    }
}

/// A column, and the index of the weight by which it is multiplied.
type WeightedColumn = (usize, Option<usize>);

fn weighted_value((column, copy): WeightedColumn, row: &[f64], by: &[f64]) -> f64 {
    row[column] * copy.map_or(1.0, |copy| by[copy])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two steps of one acceleration with two columns, the second of which acts on the instrument.
    fn part() -> LinearisedPart {
        LinearisedPart {
            samples: vec![0, 1, 2],
            t_s: vec![0.0, 1.0, 2.0],
            sizes: LinearisationSizes { states: 1, axes: 1, columns: 2 },
            jacobian: vec![0.0; 2],
            accelerations: vec![1.0, 2.0, 3.0, 4.0],
            defect: vec![0.0; 2],
            reading: vec![0.0; 3],
            by_state: Some(vec![1.0; 3]),
            by_column: vec![5.0, 6.0, 7.0],
            measured: vec![1],
            by_rate: vec![RateResponse {
                channel: 0,
                column: Some(1),
                state: 0,
                by: vec![-1.0; 3],
            }],
            channels: vec![(Channel::U, 0)],
            every: 1,
        }
    }

    #[test]
    fn a_column_is_cut_where_its_weights_say_so() {
        let halves = |t: f64| vec![f64::from(u8::from(t < 1.0)), f64::from(u8::from(t >= 1.0))];
        let cut = part().weight_columns(&[0], &[1], &halves);
        assert_eq!(cut.sizes.columns, 3);
        assert_eq!(cut.accelerations, [1.0, 2.0, 0.0, 3.0, 0.0, 4.0]);
        assert_eq!(cut.measured, [1, 2]);
        assert_eq!(cut.by_column, [5.0, 0.0, 0.0, 6.0, 0.0, 7.0]);
        let rates: Vec<_> = cut.by_rate.iter().map(|rate| (rate.column, &rate.by[..])).collect();
        assert_eq!(rates, [(Some(1), &[-1.0, 0.0, 0.0][..]), (Some(2), &[0.0, -1.0, -1.0][..])]);
        // Together they are what was cut.
        let (whole, again) =
            (part().combine_columns(&[0.5, 2.0]), cut.combine_columns(&[0.5, 2.0, 2.0]));
        assert_eq!(whole.accelerations, again.accelerations);
        assert_eq!(whole.by_column, again.by_column);
    }

    #[test]
    fn the_first_columns_are_kept() {
        let mut first = part();
        first.truncate_columns(1);
        assert_eq!((first.sizes.columns, &first.accelerations[..]), (1, &[1.0, 3.0][..]));
        assert!(first.measured.is_empty() && first.by_column.is_empty());
        assert!(first.by_rate.is_empty());
    }
}
