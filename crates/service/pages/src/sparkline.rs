//! Sparkline of a champion's unexplained force in its trials over time, as small as a word.

use sistership_report::plots::{Shape, SvgPlot, path_data};

use crate::language::say;
use crate::numbers::format_fixed;

const SIZE: (f64, f64) = (110.0, 26.0);

/// Plots residuals in the order of the trials; marked ones have a dot. Returns `None` for fewer
/// than two, or if all are zero.
pub fn sparkline(all: impl Iterator<Item = (f64, bool)>) -> Option<SvgPlot> {
    let all: Vec<(f64, bool)> = all.collect();
    // Scaled to the largest value, so that the line always fills the height.
    let most = all.iter().map(|(left, _)| *left).fold(0.0, f64::max);
    if all.len() < 2 || most <= 0.0 {
        return None;
    }
    let place = |(index, (left, _)): (usize, &(f64, bool))| {
        let across = index as f64 / (all.len() - 1) as f64;
        (4.0 + across * (SIZE.0 - 8.0), SIZE.1 - 4.0 - left / most * (SIZE.1 - 8.0))
    };
    let points: Vec<(f64, f64)> = all.iter().enumerate().map(place).collect();
    let d = path_data(&points, |_, _| false);
    let marked = points.iter().zip(&all).filter(|(_, (_, marked))| *marked);
    let dots = marked.map(|(at, _)| Shape::Dot { at: *at, radius: 1.2, class: "dot b" });
    let shapes = std::iter::once(Shape::Path { d, class: "line a" }).chain(dots).collect();
    let last = 100.0 * all.last().map_or(0.0, |(left, _)| *left);
    let label = say("fleet-spark").with("count", all.len()).with("last", format_fixed(last, 0));
    Some(SvgPlot { width: SIZE.0, height: SIZE.1, label: label.to_string(), shapes })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_line_has_two_ends() {
        assert!(sparkline([(0.1, false)].into_iter()).is_none());
        assert!(sparkline([(0.0, false), (0.0, true)].into_iter()).is_none());
        let plot = sparkline([(0.1, false), (0.3, true), (0.2, false)].into_iter()).unwrap();
        assert_eq!((plot.shapes.len(), plot.width), (2, SIZE.0));
        assert!(plot.label.contains("3 trials over time, 20 % in the last"), "{}", plot.label);
    }
}
