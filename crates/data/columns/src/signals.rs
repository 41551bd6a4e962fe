//! Columns on a common time base: changes over blocks of rows, and integrals over them.
//!
//! Relations between columns are looked for in integrals rather than in differences of samples,
//! which keeps the noise of instruments out.

use crate::data::RecordingSample;
use crate::summary::{Summary, continuous};

/// Blocks that a recording is cut into: coarse for slow motions, fine where it turns fast.
const BLOCKS: [usize; 2] = [150, 600];

/// One column over the blocks of one scale.
#[derive(Debug, Clone, Default)]
pub(crate) struct BlockSums {
    /// Last value less the first.
    pub change: Vec<f64>,
    /// Integral over the time column, in its unit.
    pub integral: Vec<f64>,
    pub mean: Vec<f64>,
}

/// Blocks of one scale.
#[derive(Debug, Clone, Default)]
pub(crate) struct Scale {
    pub columns: Vec<BlockSums>,
    /// Duration of each block, in the time column's unit.
    pub duration: Vec<f64>,
}

/// All columns, with their summaries.
#[derive(Debug, Clone)]
pub(crate) struct Signals {
    pub summaries: Vec<Summary>,
    pub continuous: Vec<Vec<f64>>,
    pub scales: Vec<Scale>,
}

impl Signals {
    /// Columns by blocks of the time column, or none where there is no time.
    pub(crate) fn new(recording: &RecordingSample, time: Option<usize>) -> Self {
        let columns = &recording.columns;
        let summaries: Vec<Summary> =
            columns.iter().map(|column| Summary::new(&column.values, &recording.breaks)).collect();
        let continuous: Vec<Vec<f64>> = columns
            .iter()
            .zip(&summaries)
            .map(|(column, summary)| continuous(&column.values, summary))
            .collect();
        let scales = time.map_or(Vec::new(), |at| {
            let t = &continuous[at];
            let spans = spans(t, &recording.breaks, summaries[at].step);
            BLOCKS.iter().map(|&count| scale(&continuous, t, &spans, count)).collect()
        });
        Self { summaries, continuous, scales }
    }
}

/// Rows between which time runs forward without a gap.
fn spans(t: &[f64], breaks: &[usize], step: f64) -> Vec<(usize, usize)> {
    let (mut spans, mut first) = (Vec::new(), 0);
    for k in 1..=t.len() {
        let ends = k == t.len()
            || breaks.contains(&k)
            || !(t[k] > t[k - 1])
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

fn scale(columns: &[Vec<f64>], t: &[f64], spans: &[(usize, usize)], count: usize) -> Scale {
    let rows = (t.len() / count).max(2);
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
            let pieces = each.map(|k| 0.5 * (values[k] + values[k + 1]) * (t[k + 1] - t[k]));
            let integral: f64 = pieces.sum();
            sums.change.push(values[last] - values[first]);
            sums.integral.push(integral);
            sums.mean.push(integral / (t[last] - t[first]));
        }
        sums
    };
    let duration = blocks.iter().map(|&(first, last)| t[last] - t[first]).collect();
    Scale { columns: columns.iter().map(sums).collect(), duration }
}
