//! Times that do not increase.

use super::runs::MAX_FAULTY_FRACTION;

/// Returns the smallest set of rows without which time increases strictly; none if that set is
/// large. Of rows with one time the first is kept.
pub fn backward_times(t_s: &[f64]) -> Vec<usize> {
    // The longest strictly increasing subsequence (Fredman 1975, doi 10.1016/0012-365X(75)90103-X).
    let mut ends: Vec<usize> = Vec::new();
    let mut before: Vec<Option<usize>> = vec![None; t_s.len()];
    for k in (0..t_s.len()).filter(|&k| t_s[k].is_finite()) {
        // `ends[n]` is the row with the smallest time at which an increasing subsequence of length
        // n + 1 can end; `before` links each row to its predecessor in that subsequence.
        let place = ends.partition_point(|&at| t_s[at] < t_s[k]);
        before[k] = place.checked_sub(1).map(|place| ends[place]);
        match ends.get_mut(place) {
            Some(end) if t_s[*end] > t_s[k] => *end = k,
            Some(_) => {}
            None => ends.push(k),
        }
    }
    // Follow the links backwards from the end of the longest subsequence.
    let mut kept = vec![false; t_s.len()];
    let mut at = ends.last().copied();
    while let Some(k) = at {
        kept[k] = true;
        at = before[k];
    }
    let dropped: Vec<usize> = (0..t_s.len()).filter(|&k| !kept[k]).collect();
    if dropped.len() as f64 > MAX_FAULTY_FRACTION * t_s.len() as f64 { Vec::new() } else { dropped }
}
