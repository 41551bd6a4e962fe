//! Leave-one-ship-out: a ship with little data, held by what its family teaches, or by the nearest
//! ship's model.

mod regressions;
mod ships;

use std::collections::BTreeMap;

use rand::SeedableRng;
use rand_chacha::ChaCha12Rng;
use sistership_fleet::bulk::{BulkPrior, BulkSettings, refined_model, solve_path};
use sistership_fleet::family::{FamilyMember, learn_family};
use sistership_fleet::statistics::TrialStatistics;
use sistership_model::{Law, Model};
use sistership_simulation::state::at;

use ships::{Sailed, Sistership, draw, foundation, sail, statistics};

const SHIPS: usize = 20;
/// What a member has sailed, and what a new ship has, with their durations in ship's lengths.
const MEMBERS: [(Sailed, f64); 4] = [
    (Sailed::Turn(35.0), 20.0),
    (Sailed::Zigzag(20.0), 30.0),
    (Sailed::Zigzag(-10.0), 30.0),
    (Sailed::Turn(-20.0), 20.0),
];
const NEW: [(Sailed, f64); 2] = [(Sailed::Zigzag(10.0), 20.0), (Sailed::Zigzag(-10.0), 20.0)];
/// The weakest prior: of the whole path, and of its most conservative range, which may suit the
/// nearest ship better.
const PATH: f64 = 1e-6;
const HELD: f64 = 1.0;
/// What it is judged by, none of which it has sailed.
const JUDGED: [(Sailed, f64); 3] =
    [(Sailed::Turn(35.0), 15.0), (Sailed::Turn(-35.0), 15.0), (Sailed::Zigzag(20.0), 25.0)];

type Values = BTreeMap<String, f64>;

/// A ship with the statistics of both lists of trials.
struct Known {
    ship: Sistership,
    all: Vec<TrialStatistics>,
    few: Vec<TrialStatistics>,
}

fn known(rng: &mut ChaCha12Rng, foundation: &Model, law: &Law) -> Vec<Known> {
    let mut known = Vec::new();
    for index in 0.. {
        let ship = draw(rng, index, foundation, law);
        let sailed = statistics(&ship, law, rng, &MEMBERS).zip(statistics(&ship, law, rng, &NEW));
        known.extend(sailed.map(|(all, few)| Known { ship, all, few }));
        if known.len() == SHIPS {
            break;
        }
    }
    known
}

fn values(model: &Model) -> Values {
    model.coefficients.iter().map(|(name, quantity)| (name.clone(), quantity.value)).collect()
}

fn refined(
    frame: &Model,
    trials: &[TrialStatistics],
    prior: BulkPrior<'_>,
    lambda_min: f64,
) -> Model {
    let settings = BulkSettings { lambda_min, ..BulkSettings::default() };
    let solved = solve_path(trials, prior, &settings).expect("a path");
    refined_model(frame, &solved.coefficients_at(0).0, "test")
}

/// The closest in the ratios that the regressions know.
fn nearest<'a>(of: &Known, others: &[&'a Known]) -> &'a Known {
    let ratios = |known: &Known| {
        let hull = known.ship.hull;
        [
            hull.lpp_m / hull.beam_m / 6.0,
            hull.beam_m / hull.draught_m / 2.8,
            hull.block_coefficient / 0.73,
        ]
    };
    let far = |other: &Known| {
        ratios(of).iter().zip(ratios(other)).map(|(a, b)| (a - b).powi(2)).sum::<f64>()
    };
    others.iter().min_by(|a, b| far(a).total_cmp(&far(b))).expect("another ship")
}

/// Root mean square of the error in yaw rate by that of the yaw rate, over manoeuvres it has not
/// sailed; none where it diverges.
fn error(model: &Model, truth: &Model, law: &Law) -> Option<f64> {
    let (mut wrong, mut whole) = (0.0_f64, 0.0);
    for (what, lengths) in JUDGED {
        let (modelled, sailed) =
            (sail(model, law, what, lengths)?, sail(truth, law, what, lengths)?);
        for (a, b) in modelled.states.iter().zip(&sailed.states) {
            wrong += (a[at::R] - b[at::R]).powi(2);
            whole += b[at::R].powi(2);
        }
    }
    Some((wrong / whole).sqrt())
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

#[test]
fn a_family_tells_more_of_a_new_ship_than_its_nearest_sister() {
    let (foundation, law) = foundation();
    let known = known(&mut ChaCha12Rng::seed_from_u64(12), &foundation, &law);
    let source = values(&foundation);
    let own: Vec<Model> = known
        .iter()
        .map(|one| refined(&one.ship.frame, &one.all, BulkPrior::Source(&source), PATH))
        .collect();
    println!(
        "error in yaw rate, %: the model of the nearest ship, refined on two zigzags, and held \
         more tightly; the family's"
    );
    println!(
        "mean, and refined with the family's prior on the same zigzags; refined on all of its own \
         trials"
    );
    let mut table: [Vec<f64>; 6] = Default::default();
    for (index, out) in known.iter().enumerate() {
        let others: Vec<&Known> = known
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != index)
            .map(|(_, one)| one)
            .collect();
        let sister = nearest(out, &others);
        let place =
            known.iter().position(|one| one.ship.name == sister.ship.name).expect("a sister");
        let own_values = values(&own[place]);
        let members: Vec<FamilyMember<'_>> = others
            .iter()
            .map(|one| FamilyMember { name: &one.ship.name, trials: &one.all })
            .collect();
        let family = learn_family(&members).expect("a family");
        let axes = family.axis_priors().expect("its axes");
        let prior = BulkPrior::Family { axes: &axes, design_effect: family.design_effect };
        let with = |values: &Values| {
            let mut model = out.ship.frame.clone();
            model
                .coefficients
                .iter_mut()
                .for_each(|(name, quantity)| quantity.value = values[name]);
            model
        };
        let mean: Values = axes
            .iter()
            .flat_map(|axis| axis.names.iter().cloned().zip(axis.mean.iter().copied()))
            .collect();
        let models = [
            with(&own_values),
            refined(&out.ship.frame, &out.few, BulkPrior::Source(&own_values), PATH),
            refined(&out.ship.frame, &out.few, BulkPrior::Source(&own_values), HELD),
            with(&mean),
            refined(&out.ship.frame, &out.few, prior, PATH),
            own[index].clone(),
        ];
        // A model that diverges is as wrong as one that does not turn.
        let errors =
            models.each_ref().map(|model| error(model, &out.ship.truth, &law).unwrap_or(1.0));
        let row: Vec<String> =
            errors.iter().map(|error| format!("{:8.1}", 100.0 * error)).collect();
        println!("{:10} {}", out.ship.name, row.join(" "));
        table.iter_mut().zip(errors).for_each(|(column, error)| column.push(error));
    }
    let medians = table.each_ref().map(|column| median(column));
    println!("{:10} {}", "median", medians.map(|m| format!("{:8.1}", 100.0 * m)).join(" "));
    let wins = |column: usize| {
        table[column].iter().zip(&table[4]).filter(|(nearest, family)| family < nearest).count()
    };
    println!(
        "the family's prior is the better one for {} of {SHIPS} ships, held more tightly {}",
        wins(1),
        wins(2)
    );
    let nearest = medians[..3].iter().copied().fold(f64::INFINITY, f64::min);
    assert!(medians[4] < 0.8 * nearest, "{medians:?}");
    assert!(wins(1) > SHIPS * 3 / 4 && wins(2) > SHIPS / 2, "{} {}", wins(1), wins(2));
}
