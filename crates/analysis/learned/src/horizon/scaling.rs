//! Centres and scales of numbers in a row, and their range.

use serde::{Deserialize, Serialize};

use crate::sample::centre_and_scale;

/// Centres and scales of numbers in a row, with the range that training held.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scaling {
    centres: Vec<f64>,
    scales: Vec<f64>,
    ranges: Vec<[f64; 2]>,
}

impl Scaling {
    /// Of rows that are all as long as the first.
    pub fn of(rows: &[&[f64]]) -> Self {
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

    /// How many numbers a row has.
    pub fn width(&self) -> usize {
        self.centres.len()
    }

    /// A row in deviations.
    pub fn scaled(&self, row: &[f64]) -> Vec<f64> {
        let of = row.iter().zip(&self.centres).zip(&self.scales);
        of.map(|((value, centre), scale)| (value - centre) / scale).collect()
    }

    /// A row from its deviations, none beyond what training held.
    pub fn bounded(&self, scaled: &[f64]) -> Vec<f64> {
        let one = |place: usize| {
            let [least, most] = self.ranges[place];
            (self.centres[place] + self.scales[place] * scaled[place]).clamp(least, most)
        };
        (0..scaled.len()).map(one).collect()
    }

    /// Scales alone.
    pub fn scales(&self) -> &[f64] {
        &self.scales
    }
}
