//! Effects that the library names, in other forms than its own, and what it does not have. Sizes go
//! with the ship's own: speeds with its speed, lengths with its length, times with `L/U`.

use sistership_tests::truth::causes::{
    Author, Current, Depth, DriftAuthor, Force, Gear, Hidden, Sensor, Waves, Wind, resistance_n,
};
use sistership_tests::truth::dimensions::Dimensions;
use sistership_tests::truth::motion::Truth;

use crate::cases::{Case, Kind, Size};

/// Directions, deg.
const WIND_FROM_DEG: f64 = 60.0;
const TOWARDS_DEG: f64 = 45.0;
const WAVES_FROM_DEG: f64 = 300.0;
const OFFSET_DEG: f64 = 1.0;
const SCALE: f64 = 0.03;

fn case(label: &str, names: &[&'static str], hidden: Hidden, sizes: &[Size]) -> Case {
    let kind = if names.len() > 1 { Kind::Pair } else { Kind::Single };
    let (label, names, sizes) = (label.to_owned(), names.to_vec(), sizes.to_vec());
    Case { label, kind, names, hidden, sizes, seed: 0 }
}

/// Single effects at a share of their size.
pub fn singles(truth: &dyn Truth, share: f64) -> Vec<Case> {
    let ship = truth.dimensions();
    let mut all = of_weather(ship, share);
    all.extend(of_ship(truth, share));
    all.extend(of_instruments(ship, share));
    all
}

fn wind(ship: &Dimensions, by_speed: f64, author: Author, is_recorded: bool) -> Hidden {
    let speed_m_s = by_speed * ship.speed_m_s;
    let wind = Wind { speed_m_s, from_rad: WIND_FROM_DEG.to_radians(), author, is_recorded };
    Hidden { wind: Some(wind), ..Hidden::default() }
}

/// A wind of a speed, m/s, by each author.
pub fn steady_winds(ship: &Dimensions, speed_m_s: f64) -> Vec<Case> {
    let of = |author: Author| {
        let hidden = wind(ship, speed_m_s / ship.speed_m_s, author, true);
        case(&format!("wind of {speed_m_s} m/s, {author:?}"), &["wind"], hidden, &[])
    };
    vec![of(Author::Isherwood), of(Author::Blendermann)]
}

fn current(ship: &Dimensions, by_speed: f64, turns_deg: f64) -> Hidden {
    let (towards_rad, turns_rad) = (TOWARDS_DEG.to_radians(), turns_deg.to_radians());
    let current = Current { speed_m_s: by_speed * ship.speed_m_s, towards_rad, turns_rad };
    Hidden { current: Some(current), ..Hidden::default() }
}

fn forced(force: Force) -> Hidden {
    Hidden { forces: vec![force], ..Hidden::default() }
}

fn geared(gear: Gear) -> Hidden {
    Hidden { gear: vec![gear], ..Hidden::default() }
}

fn read(sensor: Sensor) -> Hidden {
    Hidden { sensors: vec![sensor], ..Hidden::default() }
}

fn waves(ship: &Dimensions, share: f64, author: DriftAuthor) -> Waves {
    let amplitude_m = 0.003 * ship.lpp_m * share.sqrt();
    Waves { amplitude_m, from_rad: WAVES_FROM_DEG.to_radians(), author }
}

fn of_weather(ship: &Dimensions, share: f64) -> Vec<Case> {
    let blowing = |by_speed: f64, author, is_recorded| {
        wind(ship, by_speed * share.sqrt(), author, is_recorded)
    };
    let flowing = |turns_deg: f64| current(ship, 0.05 * share, turns_deg);
    let size = 0.05 * share * ship.speed_m_s;
    let waves = waves(ship, share, DriftAuthor::Wall);
    vec![
        case("wind, Isherwood", &["wind"], blowing(1.1, Author::Isherwood, true), &[]),
        case("wind, Blendermann", &["wind"], blowing(1.3, Author::Blendermann, true), &[]),
        case("wind, not recorded", &["wind"], blowing(1.3, Author::Isherwood, false), &[]),
        case(
            "current",
            &["current"],
            flowing(0.0),
            &[("speed_m_s", size), ("towards_deg", TOWARDS_DEG)],
        ),
        case("current that turns", &["current"], flowing(40.0), &[("speed_m_s", size)]),
        case("wave drift by heading", &["wave-drift"], forced(Force::Waves(waves)), &[]),
    ]
}

/// The coefficient that gives a share of the resistance at the approach speed.
fn coefficient(truth: &dyn Truth, share: f64) -> f64 {
    let ship = truth.dimensions();
    let unit_n = 0.5 * ship.density_kg_m3 * ship.lpp_m * ship.draught_m * ship.speed_m_s.powi(2);
    share * resistance_n(truth) / unit_n
}

fn resisted(truth: &dyn Truth, share: f64) -> (Hidden, Size) {
    let force = Force::Resistance(0.15 * share, 2.6);
    (forced(force), ("coefficient", coefficient(truth, 0.15 * share)))
}

fn offset(share: f64) -> (Hidden, Size) {
    let hidden = geared(Gear::Offset((OFFSET_DEG * share).to_radians()));
    (hidden, ("offset_deg", OFFSET_DEG * share))
}

fn lagging(ship: &Dimensions, share: f64) -> (Hidden, Size) {
    let delay_s = 0.15 * share * ship.length_time_s();
    (geared(Gear::SecondOrder(delay_s, 0.7)), ("time_constant_s", delay_s))
}

fn of_ship(truth: &dyn Truth, share: f64) -> Vec<Case> {
    let ship = truth.dimensions();
    let (offset, of_offset) = offset(share);
    let (lag, of_lag) = lagging(ship, share);
    let (resistance, of_resistance) = resisted(truth, share);
    let band = Gear::DeadBand((2.0 * share).to_radians());
    let depth = Force::Depth(Depth { draught_to_depth: 0.55 * share.sqrt() });
    let propeller = Force::Propeller(0.06 * share, -0.03 * share);
    vec![
        case("rudder offset", &["rudder-offset"], offset, &[of_offset]),
        case("rudder lag, 2nd order", &["rudder-lag"], lag, &[of_lag]),
        case("rudder dead band", &["rudder-lag"], geared(band), &[]),
        case("resistance, power 2.6", &["extra-resistance"], resistance, &[of_resistance]),
        case("shallow water, Taimuri", &["shallow-water"], forced(depth), &[]),
        case("propeller by thrust", &["propeller-asymmetry"], forced(propeller), &[]),
    ]
}

fn biased(ship: &Dimensions, share: f64) -> (Hidden, Size) {
    let bias = 0.006 * share / ship.length_time_s();
    (read(Sensor::RateBias(bias)), ("bias_rad_s", bias))
}

fn of_instruments(ship: &Dimensions, share: f64) -> Vec<Case> {
    let (bias, of_bias) = biased(ship, share);
    let drift = 0.0015 * share / ship.length_time_s();
    let (scale, forward) = (SCALE * share, 0.12 * share * ship.lpp_m);
    let delay_s = (0.08 * share * ship.length_time_s() * 10.0).round().max(1.0) / 10.0;
    let lever = Sensor::LeverArm(forward, 0.1 * forward);
    vec![
        case("rate bias", &["yaw-rate-bias"], bias, &[of_bias]),
        case(
            "heading drift",
            &["heading-drift"],
            read(Sensor::HeadingDrift(drift)),
            &[("drift_rad_s", drift)],
        ),
        case("log scale", &["speed-log"], read(Sensor::Log(scale)), &[("scale", scale)]),
        case("lever arm", &["lever-arm"], read(lever), &[("forward_m", forward)]),
        case("late compass", &["time-delay"], read(Sensor::Late(delay_s)), &[("delay_s", delay_s)]),
    ]
}

/// Single effects by a second author, of those that have one above.
pub fn other_authors(truth: &dyn Truth, share: f64) -> Vec<Case> {
    let ship = truth.dimensions();
    let drift = waves(ship, share, DriftAuthor::Daidola);
    let fouled = forced(Force::Resistance(0.15 * share, 1.8));
    let walk = forced(Force::PropellerWalk(0.06 * share, -0.03 * share));
    vec![
        case("drift by angle, Daidola", &["wave-drift"], forced(Force::Waves(drift)), &[]),
        case("fouling, power 1.8", &["extra-resistance"], fouled, &[]),
        case("propeller by revolutions", &["propeller-asymmetry"], walk, &[]),
    ]
}

/// Pairs that are found together at sea.
pub fn pairs(truth: &dyn Truth, share: f64) -> Vec<Case> {
    let ship = truth.dimensions();
    let (offset, of_offset) = offset(share);
    let (lag, of_lag) = lagging(ship, share);
    let (resistance, of_resistance) = resisted(truth, share);
    let (bias, of_bias) = biased(ship, share);
    let flowing = current(ship, 0.05 * share, 0.0);
    let blowing = wind(ship, 1.1 * share.sqrt(), Author::Isherwood, true);
    vec![
        case(
            "current + offset",
            &["current", "rudder-offset"],
            flowing.and(offset.clone()),
            &[("speed_m_s", 0.05 * share * ship.speed_m_s), of_offset],
        ),
        case("wind + rate bias", &["wind", "yaw-rate-bias"], blowing.and(bias.clone()), &[of_bias]),
        case(
            "resistance + lag",
            &["extra-resistance", "rudder-lag"],
            resistance.and(lag),
            &[of_resistance, of_lag],
        ),
        case(
            "offset + rate bias",
            &["rudder-offset", "yaw-rate-bias"],
            offset.and(bias),
            &[of_offset, of_bias],
        ),
    ]
}

/// What the library does not have.
pub fn unlisted(share: f64) -> Vec<Case> {
    let one = |label: &str, channel, from, hidden| Case {
        kind: Kind::Unlisted(channel, from),
        ..case(label, &[], hidden, &[])
    };
    vec![
        one("thrust lost at half time", "u", 0.5, forced(Force::ThrustLost(0.3 * share))),
        one("rudder damaged at half time", "r", 0.5, geared(Gear::Damaged(1.0 - 0.35 * share))),
        one("oscillating moment", "r", 0.0, forced(Force::Oscillating(0.02 * share, 3.0))),
        one("sway by heading", "v", 0.0, forced(Force::ByHeading(0.012 * share))),
    ]
}
