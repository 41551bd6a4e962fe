//! Detection limits as a diagnosis states them, and cases at shares of them.

use rayon::prelude::*;
use serde_json::Value;

use crate::arguments::Arguments;
use crate::cases::{Case, Kind, clean};
use crate::diagnosed;
use crate::listed::singles;
use crate::outcome::Outcome;
use crate::program::Program;
use crate::ships::{Refined, TrueShip};

/// Whether the size that a case hides is below what its diagnosis would have shown.
pub fn is_below(limits: &Value, case: &Case) -> bool {
    case.names.iter().any(|effect| {
        let limit =
            case.sizes.iter().find_map(|(name, size)| Some((of(limits, effect, name)?, *size)));
        limit.is_some_and(|(limit, size)| size < limit)
    })
}

/// The limit of a parameter by the name that tables give it; of a current, that of its weaker
/// component. The smallest over the forms of the effect; infinite where none is shown.
fn of(limits: &Value, effect: &str, name: &str) -> Option<f64> {
    let (parameters, unit): (&[&str], f64) = match name {
        "offset_deg" => (&["offset_rad"], 180.0 / std::f64::consts::PI),
        "speed_m_s" => (&["north_m_s", "east_m_s"], 1.0),
        other => (&[other], 1.0),
    };
    let all: Vec<&Value> =
        limits.as_array()?.iter().filter(|limit| limit["effect"] == effect).collect();
    let smallest = |parameter: &&str| {
        let own = all.iter().filter(|limit| limit["parameter"] == **parameter);
        own.map(|limit| limit["size"].as_f64().unwrap_or(f64::INFINITY)).reduce(f64::min)
    };
    parameters.iter().filter_map(smallest).reduce(f64::max).map(|limit| unit * limit)
}

/// Single effects of known size at shares of the limits that a diagnosis of clean trials states.
pub fn tested(
    program: &Program,
    ship: &TrueShip,
    model: &Refined,
    given: &Arguments,
) -> Vec<Outcome> {
    let limits =
        diagnosed::answer(program, ship, model, &clean(40 + 1000 * ship.seed)).0["limits"].clone();
    let cases: Vec<Case> = singles(&*ship.truth, 1.0)
        .iter()
        .filter(|case| given.has(&case.label))
        .flat_map(|case| at_shares(&limits, ship, case, &given.limits))
        .collect();
    cases.into_par_iter().map(|case| diagnosed::run(program, ship, model, case)).collect()
}

fn at_shares(limits: &Value, ship: &TrueShip, full: &Case, shares: &[f64]) -> Vec<Case> {
    let Some((name, size)) = full.sizes.first() else { return Vec::new() };
    let limit = of(limits, full.names[0], name).unwrap_or(f64::INFINITY);
    if !limit.is_finite() {
        println!("{}, {}: no limit", ship.name(), full.label);
        return Vec::new();
    }
    let at = |(k, share): (usize, &f64)| {
        let all = singles(&*ship.truth, share * limit / size);
        let case = all.into_iter().find(|case| case.label == full.label).expect("the same cases");
        let label = format!("{}, {share} of {limit:.3e}", case.label);
        Case { label, kind: Kind::AtLimit(*share), seed: 1000 * ship.seed + 60 + k as u64, ..case }
    };
    shares.iter().enumerate().map(at).collect()
}

/// Prints how many are named by share of the limit.
pub fn print(outcomes: &[Outcome], shares: &[f64]) {
    println!("\n| share of the limit | named | first |\n| ---: | ---: | ---: |");
    for share in shares {
        let of: Vec<&Outcome> =
            outcomes.iter().filter(|o| o.case.kind == Kind::AtLimit(*share)).collect();
        let named = of.iter().filter(|outcome| outcome.has_all()).count();
        let first = of.iter().filter(|outcome| outcome.is_first()).count();
        println!("| {share} | {named} of {} | {first} of {} |", of.len(), of.len());
    }
}
