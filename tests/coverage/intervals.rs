//! Nominal intervals of 95 % against the truth, over replicas of a refinement.

use std::collections::BTreeMap;

use rayon::prelude::*;
use sistership_assessment::uncertainty::Sampling;
use sistership_identification::refine::{
    EstimationMethod, RefinementSettings, RefinementSpec, TermFamily, refine,
};
use sistership_model::trial::Trial;
use sistership_model::{Law, Model, Vessel, Zoo};
use sistership_simulation::Ship;
use sistership_tests::synthetic::{Orders, Trouble, relative, replica, trial};

use super::diameters::{band, diameter};
use super::setting;

/// What one replica says: by figure, whether the interval held the truth, and its half width by the
/// source's own figure.
type Held = BTreeMap<String, (bool, f64)>;

const DIAMETER: &str = "tactical diameter, 35 deg";
const ORDERS: [Orders; 6] = [
    Orders::Zigzag(10.0, 10.0),
    Orders::Zigzag(-20.0, 20.0),
    Orders::Zigzag(20.0, 20.0),
    Orders::Zigzag(-10.0, 10.0),
    Orders::Turn(35.0),
    Orders::Turn(-20.0),
];

struct Case<'a> {
    vessel: &'a Vessel,
    source: Model,
    law: &'a Law,
    settings: RefinementSettings,
    seed: u64,
}

impl Case<'_> {
    fn replica(&self, index: usize) -> Held {
        let mut rng = replica(self.seed, index);
        let truth = relative(&self.source, self.law, 0.15, &mut rng);
        let ship = Ship::new(&truth, self.law).unwrap_or_else(|e| panic!("{e}"));
        let sail = |(k, orders): (usize, &Orders)| {
            trial(&ship, &format!("trial {k}"), *orders, 30.0, &Trouble::default(), &mut rng)
        };
        let trials: Vec<Trial> = ORDERS.iter().enumerate().map(sail).collect();
        let trials: Vec<&Trial> = trials.iter().collect();
        let request = RefinementSpec {
            target: self.vessel,
            source: &self.source,
            source_law: None,
            law: self.law,
            trials: &trials,
            population: &[],
            settings: &self.settings,
        };
        let refined = refine(&request, &|_, _| true)
            .unwrap_or_else(|error| panic!("replica {index}: {error}"));
        held(&self.source, &truth, &refined.model, self.law)
    }
}

fn held(source: &Model, truth: &Model, refined: &Model, law: &Law) -> Held {
    let posterior = refined.valid_posterior().expect("a refined model has a posterior");
    let one = |(name, deviation): (&str, f64)| {
        let off = refined.coefficient(name) - truth.coefficient(name);
        (
            name.to_owned(),
            (off.abs() <= 1.96 * deviation, 1.96 * deviation / source.coefficient(name).abs()),
        )
    };
    let mut held: Held = posterior.deviations_by_name().into_iter().map(one).collect();
    let true_diameter = diameter(truth, law).expect("the truth turns");
    let (low, high) = band(refined, law).expect("draws that turn");
    held.insert(
        DIAMETER.to_owned(),
        ((low..=high).contains(&true_diameter), 0.5 * (high - low) / true_diameter),
    );
    held
}

/// By figure, the share of replicas whose interval held the truth and the mean half width.
fn table(replicas: &[Held]) -> BTreeMap<String, (f64, f64)> {
    let mut sums: BTreeMap<String, (f64, f64)> = BTreeMap::new();
    for (name, (held, width)) in replicas.iter().flatten() {
        let sum = sums.entry(name.clone()).or_default();
        sum.0 += f64::from(u8::from(*held));
        sum.1 += width;
    }
    let count = replicas.len() as f64;
    sums.into_iter().map(|(name, (held, width))| (name, (held / count, width / count))).collect()
}

/// Prints the table and gives the shares of the coefficients in the mean and of the diameter.
fn coverage(ship: &str, method: EstimationMethod, replicas: usize) -> (f64, f64) {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let source = zoo.find_model(ship).unwrap_or_else(|error| panic!("{error}"));
    let law = zoo.law(&source.law).expect("the law").clone();
    let strengths = vec![1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5];
    let bands = Sampling { samples: 0, ..Sampling::default() };
    let settings = RefinementSettings {
        method,
        families: vec![TermFamily::Own],
        strengths,
        bands,
        ..RefinementSettings::default()
    };
    let seed = setting("COVERAGE_SEED", "20").parse().expect("a number");
    let case =
        Case { vessel: zoo.vessel(ship).expect("the ship"), source, law: &law, settings, seed };
    let held: Vec<Held> = (0..replicas).into_par_iter().map(|index| case.replica(index)).collect();
    let mut table = table(&held);
    println!(
        "{ship}, {}, {replicas} replicas of seed {seed}\n{:28} {:>8} {:>12}",
        method.name(),
        "figure",
        "covered",
        "half width"
    );
    for (name, (share, width)) in &table {
        println!("{name:28} {share:8.3} {width:12.3}");
    }
    let diameter = table.remove(DIAMETER).map_or(0.0, |(share, _)| share);
    let mean = table.values().map(|(share, _)| share).sum::<f64>() / table.len() as f64;
    println!("{:28} {mean:8.3}", "coefficients, mean");
    (mean, diameter)
}

/// By default as many replicas as take seconds; `COVERAGE_REPLICAS=200` is the whole table
/// (decision 12), `COVERAGE_SHIP`, `COVERAGE_METHOD` and `COVERAGE_SEED` choose another.
#[test]
fn intervals_of_95_per_cent_cover_90_to_98() {
    let replicas: usize = setting("COVERAGE_REPLICAS", "16").parse().expect("a number");
    let method = EstimationMethod::by_name(&setting("COVERAGE_METHOD", "weak"))
        .expect("COVERAGE_METHOD is the name of an estimator");
    let (coefficients, diameter) = coverage(&setting("COVERAGE_SHIP", "mariner"), method, replicas);
    // Chance: two standard errors of a share over so few replicas. Coefficients of one replica
    // depend on each other.
    let chance = if replicas < 200 { 2.0 * (0.95 * 0.05 / replicas as f64).sqrt() } else { 0.0 };
    let promised = 0.90 - chance..=0.98 + chance;
    assert!(promised.contains(&coefficients), "coefficients: {coefficients}");
    assert!(promised.contains(&diameter), "tactical diameter: {diameter}");
}
