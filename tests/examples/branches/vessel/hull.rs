//! The hull with its thrusters: a derived law, its coefficients by least squares.

use nalgebra::{Cholesky, DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use sistership_model::hybrid::derive_law;
use sistership_model::quantity::Quantity;
use sistership_model::{Law, Model, Zoo};
use sistership_simulation::Ship;
use sistership_simulation::plant::{LawInputs, MAX_INPUTS, PlantWorkspace};
use sistership_simulation::state::{StateVector, at};

/// Two thrusters under one order, as one.
const DECLARATION: &str = "
kind: hybrid
name: azimuth-hybrid
title: Abkowitz-MMG hybrid of third order for azimuth thrusters under one order
order: 3
scaling: bis
actuators: { pod: { kind: azimuth } }
rules: { symmetry: mirror, signed_squares: true, trigonometric_powers: drop }
submodels: one
";
/// The ship of the zoo whose figures it has.
pub const VESSEL: &str = "gunnerus-34m";
/// Motions at which it is fitted, and their ranges: u, v (m/s), r (rad/s), revolutions (rps) and
/// the thrusters' angle (rad).
const MOTIONS: usize = 3000;
const RANGES: [[f64; 2]; 5] = [[-1.0, 6.5], [-1.5, 1.5], [-0.2, 0.2], [0.0, 3.4], [-0.9, 0.9]];
/// Ridge by the mean square of the terms, which are collinear in part.
const RIDGE: f64 = 1e-6;

/// Length of that ship, m, and its revolutions on trial, 1/s: times, weather and orders of another
/// ship are its own by Froude's law.
const LENGTH_M: f64 = 33.9;
const REVOLUTIONS_RPS: f64 = 2.75;

/// The hull.
pub struct Hull {
    ship: Ship,
    pub mass: Mass,
    pub lpp_m: f64,
    pub beam_m: f64,
    approach_n_rps: f64,
    /// Root mean square of what the fit left, by that of the accelerations: surge, sway, yaw.
    pub left: [f64; 3],
}

/// Mass with the water's, and what couples sway to yaw.
#[derive(Debug, Clone, Copy)]
pub struct Mass {
    pub surge_kg: f64,
    pub sway_kg: f64,
    pub coupling_kg_m: f64,
    pub yaw_kg_m2: f64,
}

impl Mass {
    fn of(model: &Model, lpp_m: f64) -> Self {
        let of = |name: &str| model.parameters[name].value;
        let mass = of("m");
        Self {
            surge_kg: mass * (1.0 + of("m_x")),
            sway_kg: mass * (1.0 + of("m_y")),
            coupling_kg_m: mass * lpp_m * of("x_G"),
            yaw_kg_m2: mass * lpp_m.powi(2) * (of("I_zz_plus_J_zz") + of("x_G").powi(2)),
        }
    }

    /// Of a merchant ship: 5 and 90 % of the mass more, and a gyradius of a quarter of the length.
    fn typical(mass_kg: f64, lpp_m: f64) -> Self {
        Self {
            surge_kg: 1.05 * mass_kg,
            sway_kg: 1.9 * mass_kg,
            coupling_kg_m: 0.0,
            yaw_kg_m2: 1.9 * mass_kg * (0.25 * lpp_m).powi(2),
        }
    }

    /// Accelerations under forces from outside, N and N m.
    pub fn answers(&self, [x, y, n]: [f64; 3]) -> [f64; 3] {
        let (a, b, d) = (self.sway_kg, self.coupling_kg_m, self.yaw_kg_m2);
        let determinant = a * d - b * b;
        [x / self.surge_kg, (d * y - b * n) / determinant, (a * n - b * y) / determinant]
    }
}

/// A motion with its orders.
type Motion = [f64; 5];

impl Hull {
    pub fn new(zoo: &Zoo) -> Self {
        let law = derive_law("azimuth-hybrid.yaml", DECLARATION)
            .unwrap_or_else(|error| panic!("{error}"))
            .law;
        let vessel = zoo.vessel(VESSEL).expect("in the zoo");
        let like = zoo.find_model(VESSEL).unwrap_or_else(|error| panic!("{error}"));
        let own = ship(&like, zoo.law(&like.law).expect("its law"));
        assert!((own.lpp_m() - LENGTH_M).abs() < 1e-9, "the ship of the ranges");
        let mut model = empty(&like, &law);
        let left = fill(&mut model, &law, &own);
        let of = |name: &str| vessel.particular(name).expect("a particular of its own");
        let (lpp_m, beam_m) = (of("lpp_m"), of("beam_m"));
        let mass = Mass::of(&model, lpp_m);
        let approach_n_rps = REVOLUTIONS_RPS;
        Self { ship: ship(&model, &law), mass, lpp_m, beam_m, approach_n_rps, left }
    }

    /// A ship of the zoo by its own model.
    pub fn of_zoo(zoo: &Zoo, name: &str) -> Self {
        let model = zoo.find_model(name).unwrap_or_else(|error| panic!("{error}"));
        let vessel = zoo.vessel(&model.ship).expect("in the zoo");
        let own = ship(&model, zoo.law(&model.law).expect("its law"));
        let of = |name: &str| vessel.particular(name).expect("a particular of its own");
        let (lpp_m, beam_m) = (of("lpp_m"), of("beam_m"));
        let approach_n_rps = own.revolutions_at(own.approach_speed_m_s());
        let mass = Mass::typical(1025.0 * of("displacement_m3"), lpp_m);
        Self { ship: own, mass, lpp_m, beam_m, approach_n_rps, left: [0.0; 3] }
    }

    /// What a foundation says of the same ship, for calm water alone: masses are not its own.
    pub fn in_calm(ship: Ship, like: &Self) -> Self {
        let Self { mass, lpp_m, beam_m, approach_n_rps, .. } = *like;
        Self { ship, mass, lpp_m, beam_m, approach_n_rps, left: [0.0; 3] }
    }

    /// Its length by that of the virtual ship.
    pub fn scale(&self) -> f64 {
        self.lpp_m / LENGTH_M
    }

    /// Its revolutions by those of the virtual ship.
    pub fn revolutions(&self) -> f64 {
        self.approach_n_rps / REVOLUTIONS_RPS
    }

    /// Speed at a share of the revolutions on trial, m/s.
    pub fn speed_m_s(&self, share: f64) -> f64 {
        self.ship.approach_speed_m_s() * share
    }

    /// Accelerations in still water: m/s2, m/s2, rad/s2. The rudder angle of the zoo's law is that
    /// of the thrusters the other way round.
    pub fn accelerations(&self, velocities: [f64; 3], n_rps: f64, delta_rad: f64) -> [f64; 3] {
        let [u, v, r] = velocities;
        accelerations(&self.ship, &[u, v, r, n_rps, delta_rad])
    }
}

/// The law with the masses of the ship and nothing else; where it turns about is left as it is.
fn empty(like: &Model, law: &Law) -> Model {
    let of = |name: &str| like.parameters[name].value;
    let masses = [
        ("m", of("m")),
        ("x_G", 0.0),
        ("m_x", -of("X_udot")),
        ("m_y", -of("Y_vdot")),
        ("I_zz_plus_J_zz", of("I_z") - of("N_rdot")),
    ];
    let quantity = |value: f64| Quantity::new(value, "the zoo's model");
    let terms = law.axes.values().flat_map(|axis| axis.terms.keys());
    Model {
        law: law.name.clone(),
        parameters: masses.map(|(name, value)| (name.to_owned(), quantity(value))).into(),
        coefficients: terms.map(|name| (name.clone(), quantity(0.0))).collect(),
        ..like.clone()
    }
}

fn ship(model: &Model, law: &Law) -> Ship {
    Ship::new(model, law).unwrap_or_else(|error| panic!("{error}"))
}

fn accelerations(ship: &Ship, &[u, v, r, n, delta]: &Motion) -> [f64; 3] {
    let mut state = StateVector::zeros();
    (state[at::U], state[at::V], state[at::R], state[at::DELTA]) = (u, v, r, delta);
    let mut inputs: LawInputs = [0.0; MAX_INPUTS];
    for (place, (name, default)) in ship.law_inputs().enumerate() {
        inputs[place] = match name {
            "n" | "n_pod" => n,
            "delta" => delta,
            "pod" => -delta,
            _ => default.unwrap_or_default(),
        };
    }
    let rate = ship.rate_with(&state, &inputs, &mut PlantWorkspace::default());
    [rate[at::U], rate[at::V], rate[at::R]]
}

/// Fits the coefficients to another law; what the fit leaves.
fn fill(model: &mut Model, law: &Law, like: &Ship) -> [f64; 3] {
    let mut rng = ChaCha12Rng::seed_from_u64(34);
    let motions: Vec<Motion> =
        (0..MOTIONS).map(|_| RANGES.map(|[least, most]| rng.random_range(least..most))).collect();
    let of = |ship: &Ship| -> Vec<[f64; 3]> {
        motions.iter().map(|motion| accelerations(ship, motion)).collect()
    };
    let (none, wanted) = (of(&ship(model, law)), of(like));
    let names: Vec<String> = model.coefficients.keys().cloned().collect();
    let unit = |name: &String| {
        let mut one = model.clone();
        one.coefficients.insert(name.clone(), Quantity::new(1.0, "a unit"));
        of(&ship(&one, law))
    };
    let units: Vec<Vec<[f64; 3]>> = names.iter().map(unit).collect();
    let scales = deviations(&wanted);
    let row = |all: &[[f64; 3]], k: usize| {
        let (motion, axis) = (k / 3, k % 3);
        (all[motion][axis] - none[motion][axis]) / scales[axis]
    };
    let matrix = DMatrix::from_fn(3 * MOTIONS, names.len(), |k, place| row(&units[place], k));
    let target = DVector::from_fn(3 * MOTIONS, |k, _| row(&wanted, k));
    let found = ridge(&matrix, &target);
    for (name, value) in names.iter().zip(found.iter()) {
        model.coefficients.insert(name.clone(), Quantity::new(*value, "fitted"));
    }
    let left = target - matrix * found;
    std::array::from_fn(|axis| {
        let squares = (0..MOTIONS).map(|motion| left[3 * motion + axis].powi(2)).sum::<f64>();
        (squares / MOTIONS as f64).sqrt()
    })
}

fn deviations(all: &[[f64; 3]]) -> [f64; 3] {
    std::array::from_fn(|axis| {
        let squares = all.iter().map(|one| one[axis].powi(2)).sum::<f64>();
        (squares / all.len() as f64).sqrt()
    })
}

/// Least squares with every column scaled to one.
fn ridge(matrix: &DMatrix<f64>, target: &DVector<f64>) -> DVector<f64> {
    let norms: Vec<f64> = matrix.column_iter().map(|column| column.norm().max(1e-12)).collect();
    let scaled = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)] / norms[j]);
    let mut normal = scaled.tr_mul(&scaled);
    (0..normal.nrows()).for_each(|k| normal[(k, k)] += RIDGE);
    let solved = Cholesky::new(normal).expect("positive").solve(&scaled.tr_mul(target));
    DVector::from_fn(solved.len(), |k, _| solved[k] / norms[k])
}
