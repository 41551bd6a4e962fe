//! Plots of the partial dependence of the unexplained acceleration on a variable: the mean over the
//! samples with the variable fixed.

use sistership_diagnosis::{RemainderDependence, VariableDependence};

use super::decimate::path_data;
use super::small::SmallPlot;
use super::{Shape, SvgPlot};
use crate::words::{acceleration_unit, variable_words};

const HEIGHT: f64 = 150.0;

/// Returns one plot for each acceleration and variable.
pub(crate) fn dependence_plots(all: &[RemainderDependence]) -> Vec<SvgPlot> {
    let of = |one: &RemainderDependence| -> Vec<SvgPlot> {
        one.variables.iter().map(|variable| dependence_plot(&one.channel, variable)).collect()
    };
    all.iter().flat_map(of).collect()
}

fn dependence_plot(channel: &str, variable: &VariableDependence) -> SvgPlot {
    let (name, unit, shown) = variable_words(&variable.variable);
    let (of_rest, factor) = acceleration_unit(channel);
    let mut points: Vec<(f64, f64)> =
        variable.at.iter().zip(&variable.remainder).map(|(x, y)| (shown(*x), y * factor)).collect();
    // The conversion of angles to 0 to 360 degrees may change the order.
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let plot = SmallPlot::from_points(points.iter(), HEIGHT);
    let places: Vec<(f64, f64)> = points.iter().map(|point| plot.position_of(point)).collect();
    let line = Shape::Path { d: path_data(&places, |_, _| false), class: "refined" };
    plot.with_content(
        vec![line],
        format!("residual of d{channel}/dt [{of_rest}]"),
        format!("{name} [{unit}]"),
        format!("Residual of d{channel}/dt by {name}"),
    )
}
