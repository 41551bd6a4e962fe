//! Residual of each acceleration over time, before and after, with the band of the residual
//! expected from noise alone.

use sistership_diagnosis::{ResidualSeries, UnexplainedSegment};

use super::axes::{AxisScale, grid_columns, grid_rows, padded_range, value_range};
use super::decimate::{drawn_indices, path_data};
use super::{ChartLine, LiveChart, PanelAxes, Shape, SvgPlot, WIDTH};
use crate::words::acceleration_unit;

const LEFT: f64 = 52.0;
const RIGHT: f64 = 12.0;
const TITLE: f64 = 20.0;
const HEIGHT: f64 = 78.0;
const BOTTOM: f64 = 34.0;

/// Returns the residuals of a trial over time.
pub(crate) fn residual_chart(
    trial: &str,
    series: &[&ResidualSeries],
    unexplained: &[&UnexplainedSegment],
) -> LiveChart {
    let plots = vec![residual_plot(trial, series, unexplained)];
    let mut chart = LiveChart::new(plots, &residual_lines(series), None);
    if !unexplained.is_empty() {
        chart.legend.push(("stretch", "unexplained".to_owned()));
    }
    chart
}

/// Returns the panels of one trial, one for each acceleration; unexplained segments are shaded.
fn residual_plot(
    trial: &str,
    series: &[&ResidualSeries],
    stretches: &[&UnexplainedSegment],
) -> SvgPlot {
    let (low, high) = value_range(series.iter().flat_map(|series| series.t_s.iter().copied()))
        .unwrap_or((0.0, 1.0));
    let time = AxisScale {
        low,
        high: high.max(low + 1e-9),
        length: WIDTH - LEFT - RIGHT,
        reversed: false,
    };
    let mut shapes = Vec::new();
    for (index, one) in series.iter().enumerate() {
        let top = TITLE + index as f64 * (TITLE + HEIGHT);
        let own: Vec<&UnexplainedSegment> =
            stretches.iter().copied().filter(|stretch| stretch.channel == one.channel).collect();
        shapes.extend(acceleration_panel(one, &own, &time, top, index + 1 == series.len()));
    }
    let height = series.len() as f64 * (TITLE + HEIGHT) + BOTTOM;
    shapes.push(Shape::Text {
        at: (LEFT + time.length / 2.0, height - 4.0),
        text: "time [s]".into(),
        class: "title mid",
    });
    SvgPlot {
        width: WIDTH,
        height,
        label: format!("Residual accelerations of trial {trial} over time"),
        shapes,
    }
}

/// Panel of one acceleration.
fn acceleration_panel(
    series: &ResidualSeries,
    stretches: &[&UnexplainedSegment],
    time: &AxisScale,
    top: f64,
    last: bool,
) -> Vec<Shape> {
    let (unit, factor) = acceleration_unit(&series.channel);
    let all = series.before.iter().chain(&series.after).chain(&series.band);
    let (low, high) = value_range(all.map(|value| value * factor)).unwrap_or((-1.0, 1.0));
    // The band is symmetric, so its negative side must also fit.
    let (low, high) = padded_range((low.min(-high_band(series, factor)), high), 0.06);
    let scale = AxisScale { low, high, length: HEIGHT, reversed: true };
    let title = format!("residual of d{}/dt [{unit}]", series.channel);
    let mut shapes = vec![Shape::Text { at: (LEFT, top - 6.0), text: title, class: "title" }];
    let place = |values: &[f64]| -> Vec<(f64, f64)> {
        series
            .t_s
            .iter()
            .zip(values)
            .map(|(t, value)| (time.position_of(*t), scale.position_of(value * factor)))
            .collect()
    };
    let mut areas: Vec<Shape> =
        stretches.iter().map(|stretch| shade_segment(stretch, time)).collect();
    areas.push(band_area(&place(&series.band), scale.position_of(0.0)));
    let line =
        |values: &[f64], class| Shape::Path { d: path_data(&place(values), |_, _| false), class };
    let lines = vec![line(&series.before, "source"), line(&series.after, "refined")];
    let size = (time.length, HEIGHT);
    // Order of drawing: shaded areas below the grid, lines above it.
    shapes.push(Shape::Panel { at: (LEFT, top), size, shapes: areas, axes: None });
    shapes.extend(grid_rows((LEFT, top), time.length, &scale, 4));
    shapes.extend(grid_columns((LEFT, top), HEIGHT, time, 6, last));
    let axes = PanelAxes {
        quantity: series.channel.clone(),
        title: format!("residual of d{}/dt", series.channel),
        unit,
        across: *time,
        up: scale,
    };
    shapes.push(Shape::Panel { at: (LEFT, top), size, shapes: lines, axes: Some(axes) });
    shapes.push(Shape::Rect { at: (LEFT, top), size, class: "frame" });
    shapes
}

/// Returns the lines of the panels, each with its own times.
fn residual_lines(series: &[&ResidualSeries]) -> Vec<ChartLine> {
    let line = |one: &ResidualSeries, class, name: &str, values: &[f64]| {
        let (_, factor) = acceleration_unit(&one.channel);
        let values = values.iter().map(|value| value * factor).collect();
        let quantities = vec![(one.channel.clone(), values)];
        ChartLine { class, name: name.to_owned(), t_s: one.t_s.clone(), quantities }
    };
    let both = |one: &&ResidualSeries| {
        [
            line(one, "source", "before", &one.before),
            line(one, "refined", "after", &one.after),
            line(one, "band", "range of noise alone (two standard deviations)", &one.band),
        ]
    };
    series.iter().flat_map(both).collect()
}

fn high_band(series: &ResidualSeries, factor: f64) -> f64 {
    series.band.iter().fold(0.0, |most: f64, value| most.max(value * factor))
}

fn shade_segment(stretch: &UnexplainedSegment, time: &AxisScale) -> Shape {
    let (from, to) = (time.position_of(stretch.from_s), time.position_of(stretch.to_s));
    // Very short segments stay visible.
    Shape::Rect { at: (from, 0.0), size: ((to - from).max(1.0), HEIGHT), class: "stretch" }
}

/// Area between the band and its mirror image about `zero`.
fn band_area(edge: &[(f64, f64)], zero: f64) -> Shape {
    let kept = drawn_indices(edge.len());
    let upper = kept.iter().map(|&index| edge[index]);
    let lower = kept.iter().rev().map(|&index| (edge[index].0, 2.0 * zero - edge[index].1));
    let points: Vec<String> = upper.chain(lower).map(|(x, y)| format!("{x:.1} {y:.1}")).collect();
    let d = if points.is_empty() { String::new() } else { format!("M{}Z", points.join("L")) };
    Shape::Path { d, class: "band" }
}
