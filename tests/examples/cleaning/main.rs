//! Faults planted at four rates into trials of a ship whose law the zoo lacks: what import excludes
//! of them, and the error of a refinement with the exclusions, with the faults, and on the trials
//! that are not refused.
//!
//! `cargo run -p sistership-tests --example cleaning`

use sistership_model::Trial;
use sistership_tests::planted_faults::{
    CleanedTrials, FaultKind, PlantedTrial, RefinementJudge, import_planted, judge_trials, plant,
};
use sistership_tests::synthetic::replica;

const RATES: [f64; 4] = [0.001, 0.003, 0.01, 0.03];

fn main() {
    let (judge, trials) = (RefinementJudge::new(), judge_trials(1));
    let sound = judge.error_deg_s(&trials);
    println!("sound trials: error of the yaw rate {} deg/s", text(sound));
    println!(
        "| fault | rate, % | planted | found, % | false alarms per 10,000 values | cleaned, deg/s | faults kept, deg/s | refused trials | on the others, deg/s |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for (at, kind) in FaultKind::ALL.into_iter().enumerate() {
        for (number, rate) in RATES.into_iter().enumerate() {
            let mut rng = replica(7, 10 * at + number);
            let planted: Vec<PlantedTrial> =
                trials.iter().map(|trial| plant(trial, kind, rate, &mut rng)).collect();
            print_row(&judge, kind, rate, &planted);
        }
    }
}

fn print_row(judge: &RefinementJudge, kind: FaultKind, rate: f64, planted: &[PlantedTrial]) {
    let folder = tempfile::tempdir().expect("a folder");
    let CleanedTrials { cleaned, accepted, count } = import_planted(folder.path(), planted);
    let kept: Vec<Trial> = planted.iter().map(|one| unwrapped(&one.trial)).collect();
    let found = match count.planted {
        0 => "-".to_owned(),
        planted => format!("{:.1}", 100.0 * count.found as f64 / planted as f64),
    };
    println!(
        "| {} | {} | {} | {found} | {:.2} | {} | {} | {} of {} | {} |",
        kind.name(),
        100.0 * rate,
        count.planted,
        1e4 * count.false_alarms as f64 / count.sound as f64,
        text(judge.error_deg_s(&cleaned)),
        text(judge.error_deg_s(&kept)),
        planted.len() - accepted.len(),
        planted.len(),
        text(judge.error_deg_s(&accepted)),
    );
}

/// A trial with its faults and a heading without jumps, as a reader makes it.
fn unwrapped(trial: &Trial) -> Trial {
    let mut trial = trial.clone();
    if let Some(psi) = trial.channels.get_mut(&sistership_model::trial::Channel::Psi) {
        for k in 1..psi.len() {
            let turns = ((psi[k] - psi[k - 1]) / std::f64::consts::TAU).round();
            psi[k] -= turns * std::f64::consts::TAU;
        }
    }
    trial
}

fn text(error: Option<f64>) -> String {
    error.map_or_else(|| "no model".to_owned(), |error| format!("{error:.4}"))
}
