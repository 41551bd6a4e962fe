//! The Esso Osaka model refined from the zoo with `auto`, judged on manoeuvres left out.

use sistership_identification::refine::{Refinement, RefinementSettings, RefinementSpec, refine};
use sistership_model::{Trial, Zoo};
use sistership_priors::source::{best_source, rank_similar};
use sistership_tests::{esso_osaka, shared};

/// Turning and zigzag trials; the `turn_cut` files overlap their parents and are left out.
fn trials() -> Option<Vec<Trial>> {
    let folder = shared::data("esso-osaka")?;
    Some(esso_osaka::trials(&folder, &["turning/turn_1", "zigzag/"]))
}

fn refined(trials: &[Trial], held_out: Vec<String>) -> Refinement {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let target = zoo.vessel("esso-osaka-3m").expect("the ship is in the zoo");
    let trials: Vec<&Trial> = trials.iter().collect();
    let ranking = rank_similar(&zoo, target, None, &trials);
    for ranked in ranking.ranking.iter().filter(|ranked| ranked.model.is_some()) {
        println!(
            "{:<12} {:+.3} eligible {}: {}",
            ranked.ship,
            ranked.correlation.unwrap_or(f64::NAN),
            ranked.eligible,
            ranked.reasons.join("; ")
        );
    }
    let source = best_source(&zoo, &ranking).unwrap_or_else(|reason| panic!("{reason}"));
    let law = zoo.law(&source.law).expect("the law of a zoo model");
    let settings = RefinementSettings { held_out, ..RefinementSettings::default() };
    let request = RefinementSpec {
        target,
        source: &source,
        source_law: None,
        law,
        trials: &trials,
        population: &[],
        settings: &settings,
    };
    refine(&request, &|_, _| true).unwrap_or_else(|error| panic!("{error}"))
}

/// Prints the errors before and after, and asserts that every velocity and the heading have
/// improved.
fn judge(refinement: &Refinement) {
    println!("source {}; {}", refinement.source, refinement.held_out.how);
    for channel in ["u", "v", "r", "psi", "x", "y"] {
        let (before, after) =
            (refinement.held_out.source[channel], refinement.held_out.refined[channel]);
        println!("{channel:>4} {before:10.4} -> {after:10.4}  factor {:.2}", before / after);
    }
    for channel in ["u", "v", "r", "psi"] {
        assert!(
            refinement.held_out.refined[channel] < refinement.held_out.source[channel],
            "{channel} did not improve"
        );
    }
    let diverged: Vec<_> =
        refinement.options.iter().filter_map(|option| option.reason.as_ref()).collect();
    assert!(diverged.is_empty(), "{diverged:?}");
    assert!(
        refinement.manoeuvres.refined.failures.is_empty(),
        "{:?}",
        refinement.manoeuvres.refined.failures
    );
}

#[test]
fn esso_osaka_cross_validated_by_manoeuvre() {
    let Some(trials) = trials() else { return };
    judge(&refined(&trials, Vec::new()));
}

/// Every fourth trial is kept out of fit and choice alike.
#[test]
fn esso_osaka_on_trials_that_nothing_has_seen() {
    let Some(trials) = trials() else { return };
    let held_out = trials.iter().skip(3).step_by(4).map(|trial| trial.name.clone()).collect();
    judge(&refined(&trials, held_out));
}
