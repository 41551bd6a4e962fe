//! Columns on a common time base: changes over blocks of rows, and integrals over them.
//!
//! Relations between columns are computed from integrals rather than from differences of samples,
//! which suppresses the noise of instruments.

use std::cmp::Ordering;

use crate::data::RecordingSample;
use crate::summary::{ColumnSummary, continuous_signal};

/// Number of blocks of a recording: few for slow motions, many for fast turns.
const BLOCKS: [usize; 2] = [150, 600];

/// Sums of one column over the blocks of one scale.
#[derive(Debug, Clone, Default)]
pub(crate) struct BlockSums {
    /// Last value less the first of each block.
    pub change: Vec<f64>,
    /// Integral over time, in the unit of the time column.
    pub integral: Vec<f64>,
    pub mean: Vec<f64>,
}

/// Blocks of one scale.
#[derive(Debug, Clone, Default)]
pub(crate) struct BlockScale {
    pub columns: Vec<BlockSums>,
    /// Duration of each block, in the unit of the time column.
    pub duration: Vec<f64>,
}

/// Columns of a recording with their summaries and block sums.
#[derive(Debug, Clone)]
pub(crate) struct RecordingSignals {
    pub summaries: Vec<ColumnSummary>,
    pub continuous: Vec<Vec<f64>>,
    pub scales: Vec<BlockScale>,
}

impl RecordingSignals {
    /// Computes the signals; without a time column there are no block sums.
    pub(crate) fn new(recording: &RecordingSample, time: Option<usize>) -> Self {
        let columns = &recording.columns;
        let summaries: Vec<ColumnSummary> = columns
            .iter()
            .map(|column| ColumnSummary::new(&column.values, &recording.breaks))
            .collect();
        let continuous: Vec<Vec<f64>> = columns
            .iter()
            .zip(&summaries)
            .map(|(column, summary)| continuous_signal(&column.values, summary))
            .collect();
        let scales = time.map_or(Vec::new(), |at| {
            let t = &continuous[at];
            let spans = continuous_ranges(t, &recording.breaks, summaries[at].step);
            BLOCKS.iter().map(|&count| sum_blocks(&continuous, t, &spans, count)).collect()
        });
        Self { summaries, continuous, scales }
    }
}

/// Returns the ranges of rows in which time increases without a gap.
fn continuous_ranges(t: &[f64], breaks: &[usize], step: f64) -> Vec<(usize, usize)> {
    let (mut spans, mut first) = (Vec::new(), 0);
    for k in 1..=t.len() {
        // Negated, so that a time that is not a number ends the range too.
        let ends = k == t.len()
            || breaks.contains(&k)
            || t[k].partial_cmp(&t[k - 1]) != Some(Ordering::Greater)
            || t[k] - t[k - 1] > 4.0 * step;
        if ends {
            if k - first > 2 {
                spans.push((first, k));
            }
            first = k;
        }
    }
    spans
}

fn sum_blocks(
    columns: &[Vec<f64>],
    t: &[f64],
    spans: &[(usize, usize)],
    count: usize,
) -> BlockScale {
    let rows = (t.len() / count).max(2);
    // Blocks share their end rows, and a rest shorter than a block is not used.
    let blocks: Vec<(usize, usize)> = spans
        .iter()
        .flat_map(|&(first, end)| {
            (first..end).step_by(rows).map(move |k| (k, k + rows)).filter(move |b| b.1 < end)
        })
        .collect();
    let sums = |values: &Vec<f64>| {
        let mut sums = BlockSums::default();
        for &(first, last) in &blocks {
            let each = first..last;
            // Trapezoidal rule.
            let pieces = each.map(|k| 0.5 * (values[k] + values[k + 1]) * (t[k + 1] - t[k]));
            let integral: f64 = pieces.sum();
            sums.change.push(values[last] - values[first]);
            sums.integral.push(integral);
            sums.mean.push(integral / (t[last] - t[first]));
        }
        sums
    };
    let duration = blocks.iter().map(|&(first, last)| t[last] - t[first]).collect();
    BlockScale { columns: columns.iter().map(sums).collect(), duration }
}
