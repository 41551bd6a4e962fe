//! Law evaluations: from states, rudder and revolutions to accelerations and rates, one state at a
//! time and in blocks of lanes, on one core.
#![allow(missing_docs)]

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use sistership_model::{Model, Zoo};
use sistership_simulation::plant::{MAX_INPUTS, Plant, PlantWorkspace};
use sistership_simulation::state::{LaneStates, at, straight_state};
use sistership_simulation::tape::LaneValues;

/// States of a turn that differ by lane, with inputs.
fn point<const N: usize>(
    plant: &Plant,
    model: &Model,
) -> (LaneStates<N>, [LaneValues<N>; MAX_INPUTS]) {
    let speed_m_s = model.speed_m_s.unwrap_or(7.0);
    let mut states = straight_state(speed_m_s).data.0[0].map(|value| [value; N]);
    let spread = |most: f64| std::array::from_fn(|lane| most * (lane as f64 + 1.0) / N as f64);
    states[at::V] = spread(-0.1 * speed_m_s);
    states[at::R] = spread(0.005);
    states[at::PSI] = spread(0.3);
    let value = |name: &str| match name {
        "delta" => 0.2,
        "n" => model.revolutions_rps.unwrap_or(1.5),
        _ => 0.0,
    };
    let mut inputs = [[0.0; N]; MAX_INPUTS];
    for (lanes, name) in inputs.iter_mut().zip(plant.input_names()) {
        *lanes = [value(name); N];
    }
    (states, inputs)
}

fn lanes<const N: usize>(criterion: &mut Criterion, name: &str) {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let model = zoo.find_model(name).unwrap_or_else(|error| panic!("{error}"));
    let plant = Plant::new(&model, zoo.law(&model.law).expect("the law of a zoo model"))
        .unwrap_or_else(|error| panic!("{error}"));
    let (states, inputs) = point::<N>(&plant, &model);
    let mut work = PlantWorkspace::<N>::default();
    let mut group = criterion.benchmark_group(format!("{}, {name}", model.law));
    group.throughput(Throughput::Elements(N as u64));
    group.bench_function(format!("{N} at a time"), |bencher| {
        bencher.iter(|| plant.state_rates(black_box(&states), black_box(&inputs), &mut work));
    });
    group.finish();
}

fn bench(criterion: &mut Criterion) {
    for name in ["mariner", "kvlcc2"] {
        lanes::<1>(criterion, name);
        lanes::<8>(criterion, name);
        lanes::<16>(criterion, name);
        lanes::<32>(criterion, name);
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
