//! Centres, scales and ranges of the columns of a data set.

use serde::{Deserialize, Serialize};

use crate::sample::centre_and_scale;

/// Centres and scales of columns, with their ranges in the training data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ColumnScaling {
    centres: Vec<f64>,
    scales: Vec<f64>,
    ranges: Vec<[f64; 2]>,
}

impl ColumnScaling {
    /// Computes the scaling of rows of equal length.
    pub fn from_rows(rows: &[&[f64]]) -> Self {
        let width = rows.first().map_or(0, |row| row.len());
        let column = |place: usize| rows.iter().map(|row| row[place]).collect::<Vec<f64>>();
        let (mut centres, mut scales, mut ranges) = (Vec::new(), Vec::new(), Vec::new());
        for place in 0..width {
            let values = column(place);
            let (centre, scale) = centre_and_scale(&values);
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            centres.push(centre);
            scales.push(scale);
            ranges.push([least, most]);
        }
        Self { centres, scales, ranges }
    }

    /// Number of columns.
    pub fn width(&self) -> usize {
        self.centres.len()
    }

    /// Row in standard deviations from the centres.
    pub fn scale_row(&self, row: &[f64]) -> Vec<f64> {
        let of = row.iter().zip(&self.centres).zip(&self.scales);
        of.map(|((value, centre), scale)| (value - centre) / scale).collect()
    }

    /// Row in original units from its scaled values, limited to the range of the training data.
    pub fn unscale_bounded(&self, scaled: &[f64]) -> Vec<f64> {
        let one = |place: usize| {
            let [least, most] = self.ranges[place];
            (self.centres[place] + self.scales[place] * scaled[place]).clamp(least, most)
        };
        (0..scaled.len()).map(one).collect()
    }

    /// Scale of each column.
    pub fn scales(&self) -> &[f64] {
        &self.scales
    }
}
