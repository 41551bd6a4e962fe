//! Forward sensitivities of 60 coefficients over a trial of 650 s at 2 Hz, on one core.
#![allow(missing_docs)]

use criterion::{Criterion, criterion_group, criterion_main};
use sistership_model::quantity::Quantity;
use sistership_model::{Law, Model, Zoo};
use sistership_simulation::Method;
use sistership_simulation::sensitivity::{SensitiveRun, SensitiveSystem};
use sistership_simulation::state::straight_state;

const COEFFICIENTS: usize = 60;
const STEPS: usize = 1300;
const STEP_S: f64 = 0.5;

/// The Mariner with further terms of third order, which start at zero.
fn ready() -> (Model, Law) {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let mut model = zoo.find_model("mariner").unwrap_or_else(|error| panic!("{error}"));
    let law = (**zoo.law(&model.law).expect("the law of a zoo model")).clone();
    let terms = ["vrr", "rrr", "rrdelta", "rdeltadelta", "vrdelta", "uuv", "uur", "vvr", "ur"];
    let surge = ["0", "rdelta", "uvr", "urr", "uvv", "urdelta"].map(|term| format!("X_{term}"));
    let further = ["Y", "N"]
        .into_iter()
        .flat_map(|axis| terms.map(|term| format!("{axis}_{term}")))
        .chain(surge);
    for name in further.collect::<Vec<_>>() {
        if model.coefficients.len() < COEFFICIENTS {
            model.coefficients.entry(name).or_insert_with(|| Quantity::new(1e-9, "bench"));
        }
    }
    (model, law)
}

fn bench(criterion: &mut Criterion) {
    let (model, law) = ready();
    let system = SensitiveSystem::new(&model, &law).unwrap_or_else(|error| panic!("{error}"));
    let name = format!("sensitivities of {} coefficients over 650 s at 2 Hz", system.names().len());
    let mut run = SensitiveRun::<1>::new(&system);
    criterion.bench_function(&name, |bencher| {
        bencher.iter(|| {
            run.start(0, &straight_state(7.0));
            for k in 0..STEPS {
                let delta = [[0.2 * (0.02 * k as f64).sin()]];
                run.advance_step(Method::Rk4, STEP_S, [&delta, &delta, &delta]);
            }
            run.state_sensitivities(0, 0)[0]
        });
    });
    let mut run = SensitiveRun::<8>::new(&system);
    criterion.bench_function(&format!("{name}, 8 lanes"), |bencher| {
        bencher.iter(|| {
            (0..8).for_each(|lane| run.start(lane, &straight_state(7.0)));
            for k in 0..STEPS {
                let delta = [[0.2 * (0.02 * k as f64).sin(); 8]];
                run.advance_step(Method::Rk4, STEP_S, [&delta, &delta, &delta]);
            }
            run.state_sensitivities(7, 0)[0]
        });
    });
}

criterion_group!(benches, bench);
criterion_main!(benches);
