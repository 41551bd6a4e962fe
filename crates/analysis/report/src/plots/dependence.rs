//! Plots of the partial dependence of the unexplained acceleration on a variable: the mean over the
//! samples with the variable fixed.

use sistership_diagnosis::{RemainderDependence, VariableDependence};

use super::decimate::path;
use super::small::SmallPlot;
use super::{Plot, Shape};
use crate::words::{acceleration, recorded};

const HEIGHT: f64 = 150.0;

/// Returns one plot for each acceleration and variable.
pub(crate) fn dependences(all: &[RemainderDependence]) -> Vec<Plot> {
    let of = |one: &RemainderDependence| -> Vec<Plot> {
        one.variables.iter().map(|variable| plot(&one.channel, variable)).collect()
    };
    all.iter().flat_map(of).collect()
}

fn plot(channel: &str, variable: &VariableDependence) -> Plot {
    let (name, unit, shown) = recorded(&variable.variable);
    let (of_rest, factor) = acceleration(channel);
    let mut points: Vec<(f64, f64)> =
        variable.at.iter().zip(&variable.remainder).map(|(x, y)| (shown(*x), y * factor)).collect();
    // The conversion of angles to 0 to 360 degrees may change the order.
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let plot = SmallPlot::over(points.iter(), HEIGHT);
    let places: Vec<(f64, f64)> = points.iter().map(|point| plot.at(point)).collect();
    let line = Shape::Path { d: path(&places, |_, _| false), class: "refined" };
    plot.with(
        vec![line],
        format!("left of d{channel}/dt [{of_rest}]"),
        format!("{name} [{unit}]"),
        format!("What is left of d{channel}/dt by {name}"),
    )
}
