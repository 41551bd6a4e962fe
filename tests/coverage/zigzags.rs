//! A refinement on zigzags may know no more of a hard turn than its source; it may not know less
//! than it says.

use rayon::prelude::*;
use sistership_assessment::uncertainty::Sampling;
use sistership_identification::refine::{
    EstimationMethod, RefinementSettings, RefinementSpec, refine,
};
use sistership_model::trial::Trial;
use sistership_model::{Law, Model, Zoo};
use sistership_simulation::Ship;
use sistership_tests::synthetic::{Orders, Trouble, relative, replica, trial};

use super::diameters::{band, diameter};
use super::setting;

const SHIPS: [&str; 5] = ["mariner", "kvlcc2", "kcs", "kvlcc2-7m", "esso-tanker"];
const ORDERS: [(f64, f64); 4] = [(10.0, 10.0), (-20.0, 20.0), (20.0, 20.0), (-10.0, 10.0)];

/// Tactical diameters at 35 deg in lengths: the truth, the source's, the refined model's and its
/// band.
struct Turned {
    ship: &'static str,
    truth: f64,
    source: f64,
    refined: f64,
    band: (f64, f64),
}

impl Turned {
    /// How much worse the refined model is than the source, and the width of the band on the side
    /// of the truth.
    fn worse(&self) -> (f64, f64) {
        let worse = (self.refined - self.truth).abs() - (self.source - self.truth).abs();
        let side = if self.truth < self.refined {
            self.refined - self.band.0
        } else {
            self.band.1 - self.refined
        };
        (worse, side)
    }
}

/// A ship like one of the zoo, refined from it on zigzags under gusts and noise.
fn turned(zoo: &Zoo, (seed, index): (u64, usize), method: EstimationMethod) -> Turned {
    let ship = SHIPS[index % SHIPS.len()];
    let source = zoo.find_model(ship).unwrap_or_else(|error| panic!("{error}"));
    let law = zoo.law(&source.law).expect("the law");
    let mut rng = replica(seed, index);
    let truth = relative(&source, law, 0.15, &mut rng);
    let sails = Ship::new(&truth, law).unwrap_or_else(|error| panic!("{error}"));
    let sail = |(rudder, switch): &(f64, f64)| {
        let name = format!("zigzag {rudder}/{switch}");
        trial(&sails, &name, Orders::Zigzag(*rudder, *switch), 25.0, &Trouble::default(), &mut rng)
    };
    let trials: Vec<Trial> = ORDERS.iter().map(sail).collect();
    let trials: Vec<&Trial> = trials.iter().collect();
    let strengths = vec![1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5];
    let bands = Sampling { samples: 0, ..Sampling::default() };
    let settings = RefinementSettings { method, strengths, bands, ..RefinementSettings::default() };
    let target = zoo.vessel(ship).expect("the ship");
    let request = RefinementSpec {
        target,
        source: &source,
        source_law: None,
        law,
        trials: &trials,
        population: &[],
        settings: &settings,
    };
    let refined = refine(&request, &|_, _| true)
        .unwrap_or_else(|error| panic!("{ship} {index}: {error}"))
        .model;
    of(ship, law, [&truth, &source, &refined], index)
}

fn of(
    ship: &'static str,
    law: &Law,
    [truth, source, refined]: [&Model; 3],
    index: usize,
) -> Turned {
    let length = Ship::new(truth, law).map_or(1.0, |ship| ship.lpp_m());
    let lengths = |model: &Model| {
        diameter(model, law).unwrap_or_else(|| panic!("{ship} {index} does not turn")) / length
    };
    let (low, high) = band(refined, law).unwrap_or_else(|| panic!("{ship} {index} has no band"));
    Turned {
        ship,
        truth: lengths(truth),
        source: lengths(source),
        refined: lengths(refined),
        band: (low / length, high / length),
    }
}

/// By default a few ships; `ZIGZAG_SHIPS=200` is the whole property (decision 12), `ZIGZAG_METHOD`
/// another estimator, `ZIGZAG_SEED` other ships.
#[test]
fn zigzags_never_spoil_the_turn_by_more_than_the_band() {
    let count: usize = setting("ZIGZAG_SHIPS", "10").parse().expect("a number");
    let method = EstimationMethod::by_name(&setting("ZIGZAG_METHOD", "weak"))
        .expect("ZIGZAG_METHOD is the name of an estimator");
    let seed: u64 = setting("ZIGZAG_SEED", "3").parse().expect("a number");
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let all: Vec<Turned> =
        (0..count).into_par_iter().map(|index| turned(&zoo, (seed, index), method)).collect();
    println!(
        "{:4} {:12} {:>7} {:>7} {:>7} {:>15} {:>7}",
        "", "ship", "truth", "source", "refined", "band", "worse"
    );
    for (index, turned) in all.iter().enumerate() {
        let Turned { ship, truth, source, refined, band: (low, high) } = turned;
        let worse = turned.worse().0;
        println!(
            "{index:4} {ship:12} {truth:7.3} {source:7.3} {refined:7.3} {low:7.3} {high:7.3} \
             {worse:7.3}"
        );
    }
    let mean = |of: &dyn Fn(&Turned) -> f64| all.iter().map(of).sum::<f64>() / all.len() as f64;
    let off = [mean(&|t| (t.source - t.truth).abs()), mean(&|t| (t.refined - t.truth).abs())];
    println!(
        "mean error in lengths: source {:.3}, refined {:.3}; better: {:.0} %",
        off[0],
        off[1],
        100.0 * mean(&|t| f64::from(u8::from(t.worse().0 < 0.0)))
    );
    let spoilt: Vec<usize> = (0..all.len())
        .filter(|&k| {
            let (worse, side) = all[k].worse();
            worse > side
        })
        .collect();
    assert!(spoilt.is_empty(), "worse than the source by more than the band: {spoilt:?}");
}
