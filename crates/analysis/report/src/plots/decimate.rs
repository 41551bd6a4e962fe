//! Decimation of lines with more points than a plot can show.

/// Largest number of points of a line.
const MOST: usize = 600;

/// Indices of the drawn points: at equal strides, including the first and the last.
pub fn drawn_indices(count: usize) -> Vec<usize> {
    // One point is reserved for the last sample.
    let stride = count.div_ceil(MOST - 1).max(1);
    let mut kept: Vec<usize> = (0..count).step_by(stride).collect();
    // The stride may miss the last sample.
    if kept.last().is_some_and(|last| last + 1 < count) {
        kept.push(count - 1);
    }
    kept
}

/// SVG path data through points, broken where `jumps` returns true for a gap between two samples.
pub fn path_data(points: &[(f64, f64)], jumps: impl Fn(usize, usize) -> bool) -> String {
    let mut data = String::new();
    let mut last: Option<usize> = None;
    for index in drawn_indices(points.len()) {
        let (x, y) = points[index];
        let pen = if last.is_none_or(|last| jumps(last, index)) { 'M' } else { 'L' };
        data.push_str(&format!("{pen}{x:.1} {y:.1}"));
        last = Some(index);
    }
    data
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_line_has_more_than_the_most() {
        for count in [0, 1, 599, 600, 601, 1301, 100_000] {
            let kept = drawn_indices(count);
            assert!(kept.len() <= MOST, "{count}");
            assert_eq!(kept.last().copied(), count.checked_sub(1));
        }
    }
}
