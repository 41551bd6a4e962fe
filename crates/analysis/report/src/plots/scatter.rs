//! Residual of an acceleration against the variable that explains most of it, before and after, for
//! all trials together.

use std::collections::BTreeMap;

use sistership_diagnosis::ResidualSeries;

use super::decimate::drawn_indices;
use super::small::SmallPlot;
use super::{Shape, SvgPlot};
use crate::words::{acceleration_unit, variable_words};

const HEIGHT: f64 = 190.0;

/// Returns one plot for each acceleration and variable.
pub(crate) fn scatter_plots(residuals: &[ResidualSeries]) -> Vec<SvgPlot> {
    let mut groups: BTreeMap<(usize, &str, &str), Vec<&ResidualSeries>> = BTreeMap::new();
    for series in residuals
        .iter()
        // Without values of the variable there is nothing to plot against.
        .filter(|series| series.variable.len() == series.t_s.len() && !series.t_s.is_empty())
    {
        // Order of the plots: surge, sway, yaw, roll.
        let rank =
            ["u", "v", "r", "p"].iter().position(|known| *known == series.channel).unwrap_or(4);
        groups.entry((rank, &series.channel, &series.against)).or_default().push(series);
    }
    groups
        .into_iter()
        .map(|((_, channel, against), group)| scatter_plot(channel, against, &group))
        .collect()
}

fn scatter_plot(channel: &str, against: &str, group: &[&ResidualSeries]) -> SvgPlot {
    let ((name, unit, of_variable), (residual_unit, factor)) =
        (variable_words(against), acceleration_unit(channel));
    let points = |of: fn(&ResidualSeries) -> &[f64]| -> Vec<(f64, f64)> {
        let pairs = group.iter().flat_map(|series| series.variable.iter().zip(of(series)));
        pairs.map(|(x, y)| (of_variable(*x), y * factor)).collect()
    };
    let (before, after) = (points(|series| &series.before), points(|series| &series.after));
    let plot = SmallPlot::from_points(before.iter().chain(&after), HEIGHT);
    let clouds = [(&before, "cloud source"), (&after, "cloud refined")]
        .map(|(points, class)| point_cloud(points, &plot, class));
    plot.with_content(
        clouds.into(),
        format!("residual of d{channel}/dt [{residual_unit}]"),
        format!("{name} [{unit}]"),
        format!("Residual of d{channel}/dt against {name}"),
    )
}

/// Points as strokes of zero length: much smaller in bytes than as many circles.
fn point_cloud(points: &[(f64, f64)], plot: &SmallPlot, class: &'static str) -> Shape {
    let dot = |index: usize| {
        let (x, y) = plot.position_of(&points[index]);
        format!("M{x:.1} {y:.1}h0")
    };
    Shape::Path { d: drawn_indices(points.len()).into_iter().map(dot).collect(), class }
}
