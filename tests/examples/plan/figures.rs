//! Figures with their bands, as a model gives them.

use std::collections::BTreeMap;

use serde_json::Value;

/// The bands of a model: low and high, by figure.
pub type Bands = BTreeMap<String, [f64; 2]>;

/// Those of a document of `sistership manoeuvre --bands`.
pub fn bands(document: &Value) -> Bands {
    let all = document["bands"]["figures"].as_array().cloned().unwrap_or_default();
    let one = |band: &Value| {
        let limits = [band["low"].as_f64()?, band["high"].as_f64()?];
        Some((band["figure"].as_str()?.to_owned(), limits))
    };
    all.iter().filter_map(one).collect()
}

/// The width of a band.
pub fn width(bands: &Bands, figure: &str) -> Option<f64> {
    bands.get(figure).map(|[low, high]| high - low).filter(|width| *width > 0.0)
}

/// How far the middle of a band is from the truth.
pub fn error(bands: &Bands, figure: &str, truth: f64) -> Option<f64> {
    bands.get(figure).map(|[low, high]| (0.5 * (low + high) - truth).abs())
}

/// Whether a band holds the truth.
pub fn holds(bands: &Bands, figure: &str, truth: f64) -> Option<bool> {
    bands.get(figure).map(|[low, high]| (*low..=*high).contains(&truth))
}
