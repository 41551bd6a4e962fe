//! What begins within trials, or between them.

use sistership_tests::truth::causes::{Force, Gear, Hidden, Sensor};
use sistership_tests::truth::dimensions::Dimensions;

use crate::cases::{Case, Kind};

/// Sizes are those of single effects throughout, or twice as much where half as long.
pub fn changes(ship: &Dimensions) -> Vec<Case> {
    let forced = |force| Hidden { forces: vec![force], ..Hidden::default() };
    let geared = |gear| Hidden { gear: vec![gear], ..Hidden::default() };
    let offset = || geared(Gear::Offset(1.5_f64.to_radians()));
    let bias = Sensor::RateBias(0.01 / ship.length_time_s());
    let biased = Hidden { sensors: vec![bias], ..Hidden::default() };
    let fouled = || forced(Force::Resistance(0.25, 2.6));
    let lost: &[&str] = &["extra-resistance", "propeller-damage"];
    vec![
        case("thrust lost at 0.5", lost, Some(0.5), forced(Force::ThrustLost(0.3))),
        case("rudder damaged at 0.5", &["rudder-damage"], Some(0.5), geared(Gear::Damaged(0.65))),
        case("offset from 0.33", &["rudder-offset"], Some(0.33), since(0.33, offset())),
        case("resistance from 0.6", lost, Some(0.6), since(0.6, fouled())),
        case("rate bias from 0.4", &["yaw-rate-bias"], Some(0.4), since(0.4, biased)),
        case("resistance in two trials of six", lost, None, between(4, fouled())),
        case("offset in three trials of six", &["rudder-offset"], None, between(3, offset())),
    ]
}

fn since(share: f64, hidden: Hidden) -> Hidden {
    Hidden { since: share, ..hidden }
}

fn between(first_trial: usize, hidden: Hidden) -> Hidden {
    Hidden { first_trial, ..hidden }
}

fn case(label: &str, names: &[&'static str], from: Option<f64>, hidden: Hidden) -> Case {
    let (label, names) = (label.to_owned(), names.to_vec());
    Case { label, kind: Kind::Change(from), names, hidden, sizes: Vec::new(), seed: 0 }
}
