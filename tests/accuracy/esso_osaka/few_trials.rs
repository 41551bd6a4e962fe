//! Few trials, and a source of another law.

use sistership_identification::refine::{
    EstimationMethod, RefinementSettings, RefinementSpec, refine,
};
use sistership_model::{Law, Model, Zoo};
use sistership_priors::transfer::{blank_model, trial_approach};
use sistership_tests::{esso_osaka, shared};

use super::compared;
use super::score::{KINDS, by_source, over_all, simulated};

/// How many files, and the first of them; they are evenly spread over the kinds.
const FEW: [(usize, usize); 6] = [(2, 0), (2, 5), (4, 1), (4, 7), (8, 2), (8, 3)];

/// What the KVLCC2's MMG model says, as the prior of a polynomial fitted on few files, against the
/// same fit without a source. With two files nothing but a source makes a model of so many
/// coefficients.
#[test]
fn a_source_of_another_law_helps_where_trials_are_few() {
    let Some(folder) = shared::data("esso-osaka") else { return };
    let trials = esso_osaka::trials(&folder, &KINDS);
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let (target, law) = (
        zoo.vessel("esso-osaka-3m").expect("in the zoo"),
        zoo.law("low-speed").expect("in the zoo"),
    );
    let kvlcc2 = zoo.find_model("kvlcc2").unwrap_or_else(|error| panic!("{error}"));
    let own = zoo.law(&kvlcc2.law).expect("in the zoo");
    let settings = RefinementSettings {
        strengths: vec![1e1, 1.0, 1e-1, 1e-2, 1e-3],
        ..compared(EstimationMethod::Weak)
    };
    let as_it_is = over_all(&trials, &by_source(&trials, "kvlcc2"), "all");
    println!(
        "standardised mean squared error of the other files; the source as it is: {as_it_is:.4}"
    );
    println!("files  first  without  with the source");
    let mut sums = [0.0; 2];
    for (count, first) in FEW {
        let chosen =
            |k: usize| (0..count).any(|i| (first + i * (trials.len() / count)) % trials.len() == k);
        let (inside, outside): (Vec<_>, Vec<_>) =
            trials.iter().enumerate().partition(|(k, _)| chosen(*k));
        let [inside, outside] = [inside, outside]
            .map(|some| some.into_iter().map(|(_, trial)| trial).collect::<Vec<_>>());
        let nothing = blank_model(law, target, trial_approach(&inside))
            .unwrap_or_else(|error| panic!("{error}"));
        let error = |source: &Model, source_law: &Law| {
            let request = RefinementSpec {
                target,
                source,
                source_law: Some(source_law),
                law,
                trials: &inside,
                population: &[],
                settings: &settings,
            };
            let model = refine(&request, &|_, _| true).ok()?.model;
            Some(over_all(&trials, &simulated(&model, law, &outside), "all"))
        };
        let (without, with) = (error(&nothing, law), error(&kvlcc2, own).expect("a refined model"));
        println!(
            "{count:5}  {first:5}  {}  {with:.4}",
            without.map_or("   none".into(), |error| format!("{error:.4} "))
        );
        assert!(
            with < 0.7 * as_it_is,
            "{count} files from {first}: {with} against the source's {as_it_is}"
        );
        sums = [sums[0] + without.unwrap_or(as_it_is).ln(), sums[1] + with.ln()];
    }
    assert!(sums[1] < sums[0], "{sums:?}");
}
