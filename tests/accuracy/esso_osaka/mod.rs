//! Measured data: the trials of the Esso Osaka model.

mod estimators;
mod few_trials;
mod from_the_zoo;
mod score;
mod time;

use sistership_identification::refine::{EstimationMethod, RefinementSettings, TermFamily};

use score::RESTART_S;

/// The estimators that are compared: the weak and the trajectory form among few strengths, which is
/// enough and quicker.
fn compared(method: EstimationMethod) -> RefinementSettings {
    let strengths =
        if method == EstimationMethod::Published { Vec::new() } else { vec![1e-1, 1e-2, 1e-3] };
    RefinementSettings {
        method,
        restart_s: Some(RESTART_S),
        families: vec![TermFamily::Own],
        strengths,
        ..RefinementSettings::default()
    }
}
