//! The measured Esso Osaka trials with the wind left undeclared: a model of some of them by a law
//! without wind, and what a diagnosis of the others names.

use std::sync::Arc;

use sistership_diagnosis::{Diagnosis, Settings};
use sistership_identification::refine::{self, EstimationMethod, TermFamily};
use sistership_model::Trial;
use sistership_model::law::Law;
use sistership_model::trial::Channel;
use sistership_priors::transfer::{blank_model, trial_approach};
use sistership_store::sha256_hex;

use crate::hidden_effects::baseline::{self, Baseline};
use crate::hidden_effects::truth::ZOO;
use crate::{esso_osaka, shared};

/// The ship.
pub const SHIP: &str = "esso-osaka-3m";
/// Simulations start anew as for the score of Wakita et al. 2022.
const RESTART_S: f64 = 100.0;

/// All turns and zigzags; none where the data are missing.
pub fn trials() -> Option<Vec<Trial>> {
    let folder = shared::data("esso-osaka")?;
    Some(esso_osaka::trials(&folder, &["turning/turn_1", "zigzag/"]))
}

/// The calmer half of the turns and zigzags, and the windier: a model that was fitted in as much
/// wind as it is judged in has taken it into its coefficients.
pub fn halves() -> Option<(Vec<Trial>, Vec<Trial>)> {
    let mut calm = trials()?;
    let pressure = |trial: &Trial| {
        trial.channels[&Channel::WindSpeed].iter().map(|w| w * w).sum::<f64>() / trial.len() as f64
    };
    calm.sort_by(|a, b| pressure(a).total_cmp(&pressure(b)));
    let windy = calm.split_off(calm.len() / 2);
    Some((calm, windy))
}

/// The law for all speeds with all that is of wind taken out of its file.
fn windless() -> Arc<Law> {
    const OF_WIND: [&str; 7] =
        ["  wind_", "  u_A:", "  v_A:", "  U_A:", "  ahead", "  beam", "X_A"];
    let kept = |line: &&str| !OF_WIND.iter().any(|start| line.starts_with(start));
    let terms = |line: &str| match line.split_once("terms: [") {
        Some((before, list)) => {
            let names = list.trim_end_matches(']').split(", ");
            let left: Vec<&str> =
                names.filter(|name| !name.contains("_ahead") && !name.contains("_beam")).collect();
            format!("{before}terms: [{}]\n", left.join(", "))
        }
        None => format!("{line}\n"),
    };
    let text: String =
        include_str!("../../models/laws/low-speed.yaml").lines().filter(kept).map(terms).collect();
    Arc::new(Law::parse("windless.yaml", &text).unwrap_or_else(|error| panic!("{error}")))
}

/// How models of these trials are fitted: by trajectories, without a prior to speak of.
pub fn by_trajectories() -> refine::RefinementSettings {
    refine::RefinementSettings {
        method: EstimationMethod::Trajectory,
        restart_s: Some(RESTART_S),
        families: vec![TermFamily::Own],
        strengths: vec![1e-1, 1e-2, 1e-3],
        ..refine::RefinementSettings::default()
    }
}

/// Refined by trajectories, without a source and without any effect.
pub fn baseline(trials: &[Trial]) -> Baseline {
    let (trials, law): (Vec<&Trial>, _) = (trials.iter().collect(), windless());
    let source = blank_model(&law, ZOO.vessel(SHIP).expect("of the zoo"), trial_approach(&trials))
        .unwrap_or_else(|error| panic!("{error}"));
    baseline::by(&source, &law, SHIP, &trials, &by_trajectories())
}

/// What a diagnosis of trials names beside a model.
pub fn diagnosed(baseline: &Baseline, trials: &[Trial]) -> Diagnosis {
    let settings = Settings { restart_s: Some(RESTART_S), ..Settings::default() };
    baseline::diagnosed(baseline, trials, &settings)
}

/// Whether the wind is among what is named.
pub fn names_wind(diagnosis: &Diagnosis) -> bool {
    diagnosis.effects.iter().any(|found| found.name == "wind")
}

/// The wind of another time: everything about it is real but when it blew.
pub fn with_placebo(trial: &Trial) -> Trial {
    let mut trial = trial.clone();
    for channel in [Channel::WindSpeed, Channel::WindFrom] {
        let column = trial.channels.get_mut(&channel).expect("recorded");
        let half = column.len() / 2;
        column.rotate_left(half);
    }
    trial
}

/// Half of the trials, and the other half, by a number that draws them.
pub fn divided(trials: &[Trial], seed: usize) -> [Vec<Trial>; 2] {
    let mut drawn: Vec<&Trial> = trials.iter().collect();
    drawn.sort_by_key(|trial| sha256_hex(format!("{seed} {}", trial.name).as_bytes()));
    let (fit, judged) = drawn.split_at(drawn.len() / 2);
    [fit, judged].map(|half| half.iter().map(|trial| (*trial).clone()).collect())
}
