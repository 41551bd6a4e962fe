//! Turning circles of our own, and how far others are from them.
#![allow(clippy::unwrap_used, dead_code)]

pub mod programs;
pub mod units;

use sistership_export::{ExportPlan, ExportSubject, by_name};
use sistership_model::{Model, Zoo};
use sistership_simulation::state::straight_state;
use sistership_simulation::{HelmOrder, Method, RunSettings, Ship, Trajectory};

/// A turning circle: rudder, duration and step, and what differences are measured by.
#[derive(Debug, Clone)]
pub struct Circle {
    pub rudder_deg: f64,
    pub duration_s: f64,
    pub step_s: f64,
    pub lpp_m: f64,
    pub speed_m_s: f64,
}

impl Circle {
    /// Over some ship lengths.
    pub fn of(zoo: &Zoo, name: &str, lengths: f64) -> Self {
        let ship = ship(zoo, &zoo.find_model(name).unwrap());
        let (lpp_m, speed_m_s) = (ship.lpp_m(), ship.approach_speed_m_s());
        let step_s = 0.1_f64.min(0.02 * lpp_m / speed_m_s);
        let duration_s = (lengths * lpp_m / speed_m_s / step_s).round() * step_s;
        Self { rudder_deg: 35.0, duration_s, step_s, lpp_m, speed_m_s }
    }

    /// As the examples of exports take them.
    pub fn arguments(&self) -> [String; 3] {
        [self.rudder_deg, self.duration_s, self.step_s].map(|value| format!("{value:?}"))
    }
}

/// Rows of `u, v, r, p, phi, psi, x, y, delta`.
#[derive(Debug)]
pub struct Track(pub Vec<[f64; 9]>);

impl Track {
    pub fn read(csv: &str) -> Self {
        let row = |line: &str| {
            let values: Vec<f64> = line.split(',').skip(1).map(|v| v.parse().unwrap()).collect();
            values.try_into().unwrap()
        };
        Self(csv.lines().skip(1).map(row).collect())
    }

    pub fn of(trajectory: &Trajectory) -> Self {
        let row = |state: &sistership_simulation::StateVector| std::array::from_fn(|k| state[k]);
        Self(trajectory.states.iter().map(row).collect())
    }
}

/// The names of every model that the zoo has and that has what it takes to sail.
pub fn models(zoo: &Zoo) -> Vec<String> {
    let of = |vessel: &std::sync::Arc<sistership_model::Vessel>| {
        let models = vessel.file.models.iter();
        let name = vessel.name().to_owned();
        models.map(move |model| format!("{name}/{}", model.name)).collect::<Vec<_>>()
    };
    zoo.vessels().flat_map(of).collect()
}

pub fn ship(zoo: &Zoo, model: &Model) -> Ship {
    Ship::new(model, zoo.law(&model.law).unwrap()).unwrap()
}

pub fn plan(zoo: &Zoo, model: &Model, format: &str) -> ExportPlan {
    let law = zoo.law(&model.law).unwrap();
    let subject = ExportSubject { model, law, version: None, sha256: "0".repeat(64) };
    by_name(format).unwrap().prepare(&subject).unwrap()
}

pub fn written(zoo: &Zoo, model: &Model, format: &str) -> Vec<u8> {
    by_name(format).unwrap().write(&plan(zoo, model, format)).unwrap()
}

pub fn identifier(zoo: &Zoo, name: &str) -> String {
    plan(zoo, &zoo.find_model(name).unwrap(), "c").identifier
}

pub fn exported(zoo: &Zoo, name: &str, format: &str) -> Vec<u8> {
    written(zoo, &zoo.find_model(name).unwrap(), format)
}

/// Our own simulation of it; what was sailed until it left the physical range.
pub fn own(zoo: &Zoo, name: &str, circle: &Circle) -> Track {
    sailed(&ship(zoo, &zoo.find_model(name).unwrap()), circle)
}

pub fn sailed(ship: &Ship, circle: &Circle) -> Track {
    let Circle { duration_s, step_s, .. } = *circle;
    let start = straight_state(circle.speed_m_s);
    let order = HelmOrder {
        delta_rad: circle.rudder_deg.to_radians(),
        n_rps: ship.revolutions_at(circle.speed_m_s),
    };
    let mut track = Trajectory::default();
    let run = RunSettings { start, duration_s, step_s, method: Method::Rk4 };
    let _ = ship.simulate_orders(run, &mut track, |_, _| Some(order));
    Track::of(&track)
}

/// The largest difference: speeds by that of the approach, rates by its length a second, positions
/// by length, angles in radians.
pub fn largest(circle: &Circle, found: &Track, own: &Track) -> f64 {
    let (u, l) = (circle.speed_m_s, circle.lpp_m);
    let scale = [u, u, u / l, u / l, 1.0, 1.0, l, l, 1.0];
    assert_eq!(found.0.len(), own.0.len(), "as long as our own");
    assert!(own.0.len() > 50, "something was sailed");
    let of = |(a, b): (&[f64; 9], &[f64; 9])| {
        (0..9).map(|k| (a[k] - b[k]).abs() / scale[k]).fold(0.0, f64::max)
    };
    found.0.iter().zip(&own.0).map(of).fold(0.0, f64::max)
}
