//! Data that the script of charts reads: quantities and scales of panels, and the values of the
//! drawn lines.

use askama::Template;
use serde::Serialize;
use serde_json::{Value, json};

use super::axes::AxisScale;
use super::decimate::drawn_indices;
use super::{HullOutline, SvgPlot};

/// Quantity of a chart of the ground, in place of a channel.
pub const GROUND: &str = "ground";

/// Quantity and scales of a panel.
#[derive(Debug, Clone)]
pub struct PanelAxes {
    /// Name of the quantity in the data, or [`GROUND`].
    pub quantity: String,
    /// Name in words, with symbol.
    pub title: String,
    /// Displayed unit.
    pub unit: &'static str,
    /// Scale to the right: time, s, or metres to the east.
    pub across: AxisScale,
    /// Scale upwards: the quantity in its unit, or metres to the north.
    pub up: AxisScale,
}

/// Values of a drawn line, in displayed units; every list has one value for each time.
#[derive(Debug, Clone)]
pub struct ChartLine {
    /// Style class of the line.
    pub class: &'static str,
    /// Name in the legend.
    pub name: String,
    /// Time, s.
    pub t_s: Vec<f64>,
    /// Name and values of each quantity; `x` and `y` are positions north and east, m, and `psi`
    /// is the heading, deg.
    pub quantities: Vec<(String, Vec<f64>)>,
}

/// Chart of a page: plots side by side with one legend, and their values.
#[derive(Debug, Template)]
#[template(path = "report_chart.html")]
pub struct LiveChart {
    /// Class and name of each line.
    pub legend: Vec<(&'static str, String)>,
    /// Plots in their order.
    pub plots: Vec<SvgPlot>,
    /// Values as JSON.
    pub data: String,
}

impl LiveChart {
    /// Creates a chart of these plots; the legend lists the lines.
    pub fn new(plots: Vec<SvgPlot>, lines: &[ChartLine], hull: Option<HullOutline>) -> Self {
        let mut legend: Vec<(&'static str, String)> = Vec::new();
        for line in lines {
            // Lines of one class share its entry: measured and simulated, not trial by trial.
            if legend.iter().all(|(class, _)| *class != line.class) {
                legend.push((line.class, line.name.clone()));
            }
        }
        let data = ChartData {
            hull: hull.map(|hull| [hull.lpp_m, hull.beam_m]),
            lines: lines.iter().map(encode_line).collect(),
        };
        Self { legend, plots, data: script_json(&data) }
    }
}

#[derive(Serialize)]
struct ChartData {
    /// Length and beam, m.
    hull: Option<[f64; 2]>,
    lines: Vec<Value>,
}

/// Returns JSON that can stand in a script element: no text in it ends the element.
fn script_json(data: &impl Serialize) -> String {
    serde_json::to_string(data).unwrap_or_default().replace('<', "\\u003c")
}

fn encode_line(line: &ChartLine) -> Value {
    let kept = drawn_indices(line.t_s.len());
    let chosen = |values: &[f64]| -> Value {
        encode_values(kept.iter().map(|&index| values.get(index).copied().unwrap_or(f64::NAN)))
    };
    let mut values = serde_json::Map::from_iter([("t".to_owned(), chosen(&line.t_s))]);
    values.extend(line.quantities.iter().map(|(name, list)| (name.clone(), chosen(list))));
    json!({ "class": line.class, "name": line.name, "values": values })
}

/// Encodes values as the exponent of a power of ten, the resolution, and the differences of
/// successive values in it, which takes a third of the bytes of plain numbers. The resolution is
/// at least a ten-thousandth of the range; `null` is a missing value.
fn encode_values(values: impl Iterator<Item = f64> + Clone) -> Value {
    let finite = values.clone().filter(|value| value.is_finite());
    let (low, high) = finite.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
    // A constant line has no range of its own; its size gives one.
    let range = (high - low).max(1e-3 * high.abs().max(low.abs()).min(1e9)).max(1e-9);
    let exponent = (range / 1e4).log10().floor() as i32;
    // Differences of rounded values: errors do not add up along the line.
    let mut last = 0;
    let mut difference = |value: f64| {
        let whole = (value / 10_f64.powi(exponent)).round() as i64;
        let step = whole - last;
        last = whole;
        step
    };
    let steps = values.map(|value| match value.is_finite() {
        true => json!(difference(value)),
        false => Value::Null,
    });
    Value::Array(std::iter::once(json!(exponent)).chain(steps).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decode(encoded: &Value) -> Vec<f64> {
        let all = encoded.as_array().cloned().unwrap_or_default();
        let exponent = all.first().and_then(Value::as_i64).unwrap_or_default() as i32;
        let mut sum = 0;
        let mut value = |step: &Value| match step.as_i64() {
            Some(step) => {
                sum += step;
                sum as f64 * 10_f64.powi(exponent)
            }
            None => f64::NAN,
        };
        all.iter().skip(1).map(&mut value).collect()
    }

    #[test]
    fn values_keep_four_digits_of_their_range() {
        let heading: Vec<f64> = (0..200).map(|k| 350.0 * (f64::from(k) / 31.0).sin()).collect();
        for (value, read) in heading.iter().zip(decode(&encode_values(heading.iter().copied()))) {
            assert!((value - read).abs() <= 700.0 * 1e-4, "{value} is read as {read}");
        }
        let constant = decode(&encode_values([7.71, f64::NAN, 7.71].into_iter()));
        assert!((constant[2] - 7.71).abs() < 1e-5 && constant[1].is_nan(), "{constant:?}");
    }

    #[test]
    fn names_do_not_end_the_script() {
        let name = "</script><b>".to_owned();
        let line = ChartLine { class: "a", name, t_s: vec![0.0, 1.0], quantities: Vec::new() };
        assert!(!LiveChart::new(Vec::new(), &[line], None).data.contains('<'));
    }
}
