#![allow(clippy::unwrap_used)]
use super::super::{EstimationMethod, Refinement, RefinementSettings, RefinementSpec, refine};
use super::*;
use crate::testing::{mariner_model, simulated_trials, with_scaled_coefficients};
use sistership_assessment::uncertainty::Sampling;
use sistership_model::{Trial, Zoo};

/// Coefficients that zigzags tell well, and how the truth differs in them.
const CHANGED: [(&str, f64); 3] = [("Y_delta", 1.15), ("N_delta", 0.85), ("N_r", 1.2)];

/// What the small law keeps: so little that zigzags tell all of it.
const KEPT: [&str; 10] =
    ["X_u", "X_uu", "X_vv", "X_deltadelta", "Y_v", "Y_r", "Y_delta", "N_v", "N_r", "N_delta"];

fn refined(evaluations: usize) -> Refinement {
    let (mut source, law) = mariner_model();
    source.coefficients.retain(|name, _| KEPT.contains(&name.as_str()));
    let zoo = Zoo::load_embedded().unwrap();
    let target = zoo.vessel("mariner").unwrap();
    let factor = |name: &str| {
        CHANGED.iter().find(|(changed, _)| *changed == name).map_or(1.0, |(_, factor)| *factor)
    };
    let sailed = simulated_trials(&with_scaled_coefficients(&source, factor), &law, 0.0);
    let trials: Vec<&Trial> = sailed.iter().collect();
    let search = CmaEs {
        evaluations,
        population: 16,
        largest_population: 32,
        fold_share: 0.2,
        ..CmaEs::default()
    };
    let search = CmaEs { integration: sistership_simulation::Method::Rk4, ..search };
    let settings = RefinementSettings {
        method: EstimationMethod::CmaEs,
        cma_es: Some(search),
        folds: 2,
        step_s: Some(2.0),
        residual_s: Some(4.0),
        bands: Sampling { samples: 0, ..Sampling::default() },
        ..RefinementSettings::default()
    };
    refine(
        &RefinementSpec {
            target,
            source: &source,
            source_law: None,
            law: &law,
            population: &[],
            trials: &trials,
            settings: &settings,
        },
        &|_, _| true,
    )
    .unwrap()
}

#[test]
fn a_search_recovers_what_is_known_and_is_the_same_again() {
    let first = refined(6_000);
    let report = first.search.clone().unwrap();
    assert!(
        report.evaluations >= 6_000 && report.fold_evaluations > 0 && report.error < 1e-3,
        "{report:?}"
    );
    let taken = first.options.iter().find(|option| option.chosen).unwrap();
    assert_eq!(taken.step, "cma-es, all terms of the law");
    for (name, factor) in CHANGED {
        let change = first.coefficients.iter().find(|change| change.name == name).unwrap();
        let wanted = change.source * factor;
        assert!(
            (change.refined - wanted).abs() < 0.05 * wanted.abs(),
            "{name}: {} instead of {wanted}",
            change.refined
        );
    }
    assert_eq!(first, refined(6_000));
}

#[test]
fn a_search_that_time_ends_records_what_gives_it_again() {
    let mut settings = CmaEs { wall_s: Some(0.0), ..CmaEs::default() };
    assert!(settings.check().unwrap_err().to_string().contains("above 0"));
    settings = CmaEs { population: 2, ..CmaEs::default() };
    assert!(settings.check().unwrap_err().to_string().contains("population"));
    assert_eq!(CmaEs::default().check(), Ok(()));
    let refinement = refined(300);
    let recorded = refinement.settings.cma_es.unwrap();
    assert_eq!(
        (recorded.evaluations, recorded.wall_s),
        (refinement.search.unwrap().evaluations, None)
    );
}
