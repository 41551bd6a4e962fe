//! A ferry with two propellers and two rudders, whose flow differs from side to side as soon as it
//! drifts.

use std::f64::consts::PI;

use sistership_dynamics::state::{StateVector, at};

use super::cross_flow::CrossFlow;
use super::dimensions::Dimensions;
use super::motion::{Inertia, Truth};
use super::propeller::Propeller;
use super::resistance::Resistance;
use super::rudder::Rudder;

/// Port and starboard.
const SIDES: [f64; 2] = [-1.0, 1.0];
/// Shafts off the centre line, m.
const SHAFT_M: f64 = 5.6;
/// Added mass in surge by mass, chosen.
const SURGE_ADDED: f64 = 0.04;
/// Share of the added mass in sway that turns drift and yaw into surge, chosen.
const SURGE_BY_TURNING: f64 = 0.5;
/// Added mass of the hull by that of a plate of its draught, chosen for sections of fullness 0.9.
const SECTION: f64 = 0.85;
/// The same at the trailing edge, with skegs and shaft brackets, chosen.
const TRAILING_EDGE: f64 = 0.90;
/// Share of the wake that goes on the side from which the water comes, and comes on the other,
/// chosen.
const WAKE_SHELTER: f64 = 0.35;
/// Share of the straightening of the flow that the hull adds on the sheltered side, chosen.
const RUDDER_SHELTER: f64 = 0.25;
/// Drift at the stern at which the shelter is three quarters of its full effect, rad.
const SHELTER_RAD: f64 = 0.15;

/// The ship.
#[derive(Debug, Clone)]
pub struct Ferry {
    dimensions: Dimensions,
    cross_flow: CrossFlow,
    resistance: Resistance,
    propeller: Propeller,
    rudder: Rudder,
    inertia: Inertia,
    revolutions_rps: f64,
}

/// The ship. Main dimensions chosen as those of a day ferry; drag and propellers chosen for a fine
/// form with open shafts.
pub fn ferry() -> Ferry {
    let dimensions = Dimensions {
        name: "twin-screw-ferry".into(),
        category: "dry-cargo",
        lpp_m: 160.0,
        beam_m: 24.5,
        draught_m: 6.8,
        block_coefficient: 0.58,
        x_g_m: -2.6,
        yaw_gyradius_ratio: 0.25,
        rudder_area_m2: 34.0,
        rudder_height_m: 5.0,
        propeller_diameter_m: 4.6,
        speed_m_s: 10.3,
        density_kg_m3: 1025.0,
        upright: None,
    };
    let propeller = Propeller {
        diameter_m: 4.6,
        thrust: [0.52, -0.38, -0.06],
        wake: 0.10,
        wake_by_drift: 0.0,
        deduction: 0.14,
    };
    let rudder = Rudder {
        area_m2: 17.0,
        aspect_ratio: 1.47,
        x_m: -78.0,
        in_slipstream: 0.85,
        accelerated: 0.75,
        straightening: 0.60,
        hull_force: 0.15,
        hull_x_m: -66.0,
    };
    Ferry::new(dimensions, propeller, rudder)
}

impl Ferry {
    fn new(dimensions: Dimensions, propeller: Propeller, rudder: Rudder) -> Self {
        let cross_flow = CrossFlow { drag: 0.70, ends: 0.4, bow: 0.1 };
        let resistance = Resistance { form: 1.15, residuary: 0.0009 };
        let inertia = inertia(&dimensions);
        let mut ferry = Self {
            dimensions,
            cross_flow,
            resistance,
            propeller,
            rudder,
            inertia,
            revolutions_rps: 0.0,
        };
        ferry.revolutions_rps = ferry.balanced_rps();
        ferry
    }

    fn balanced_rps(&self) -> f64 {
        let Dimensions { speed_m_s, density_kg_m3, .. } = self.dimensions;
        let hull_n = -self.resistance.force_n(&self.dimensions, speed_m_s);
        let need = |rudders_n: f64| {
            let resistance_n = hull_n + rudders_n;
            self.propeller.revolutions_for(density_kg_m3, speed_m_s, resistance_n, 2.0)
        };
        let mut n_rps = need(0.0);
        for _ in 0..20 {
            let thrusts = SIDES.map(|side| self.side([speed_m_s, 0.0, 0.0], 0.0, n_rps, side));
            let net: f64 = thrusts.iter().map(|forces| forces[0]).sum();
            // What the rudders take is what thrust alone would have over the net force.
            n_rps = need(self.thrust_ahead(n_rps) - net);
        }
        n_rps
    }

    fn thrust_ahead(&self, n_rps: f64) -> f64 {
        let Dimensions { speed_m_s, density_kg_m3, .. } = self.dimensions;
        let advance = (1.0 - self.propeller.wake) * speed_m_s;
        let thrust = self.propeller.thrust_n(density_kg_m3, advance, n_rps);
        2.0 * (1.0 - self.propeller.deduction) * thrust
    }

    /// Surge, sway (N) and yaw (N m) of propeller and rudder on one side.
    fn side(&self, [u, v, r]: [f64; 3], delta: f64, n_rps: f64, side: f64) -> [f64; 3] {
        let density = self.dimensions.density_kg_m3;
        let across = v + self.rudder.x_m * r;
        let along = u - side * SHAFT_M * r;
        // Positive where the water comes from this side.
        let from_here = side * (across.atan2(u.abs().max(1e-6)) / SHELTER_RAD).tanh();
        let wake = self.propeller.wake * (1.0 - WAKE_SHELTER * from_here);
        let advance = (1.0 - wake) * along;
        let thrust = self.propeller.thrust_n(density, advance, n_rps);
        let slipstream = self.propeller.slipstream_m_s(density, advance, thrust);
        let axial = self.rudder.axial_m_s(advance, slipstream);
        let seen = (1.0 + RUDDER_SHELTER * from_here) * across;
        let [x, y, n] = self.rudder.forces(density, delta, axial, seen);
        let ahead = (1.0 - self.propeller.deduction) * thrust + x;
        [ahead, y, n - side * SHAFT_M * ahead]
    }

    /// Slender-body theory with a trailing edge at the stern (Newman 1977, Marine Hydrodynamics,
    /// chapter 7): with `a` the added mass of a section, `Y = -u a_T (v + x_T r)`, `N = x_T Y - u v
    /// A`, `A` its integral over the length; and the strips.
    fn hull(&self, [u, v, r]: [f64; 3]) -> [f64; 3] {
        let ship = &self.dimensions;
        let plate = section(ship);
        let edge = -0.5 * ship.lpp_m;
        let lift = -u.abs() * TRAILING_EDGE * plate * (v + edge * r);
        let munk = u * v * SECTION * plate * ship.lpp_m;
        let [y, n] = self.cross_flow.forces(ship, v, r);
        let added = self.inertia.sway_kg - self.inertia.mass_kg;
        let x = self.resistance.force_n(ship, u) + SURGE_BY_TURNING * added * v * r;
        [x, lift + y, edge * lift - munk + n]
    }
}

/// Added mass of a plate of the draught by length, kg/m: half of `pi rho T^2`, as the surface is a
/// mirror.
fn section(ship: &Dimensions) -> f64 {
    0.5 * PI * ship.density_kg_m3 * ship.draught_m.powi(2)
}

fn inertia(ship: &Dimensions) -> Inertia {
    let mass_kg = ship.mass_kg();
    let added = SECTION * section(ship) * ship.lpp_m;
    let moment_kg_m = mass_kg * ship.x_g_m;
    Inertia {
        mass_kg,
        surge_kg: (1.0 + SURGE_ADDED) * mass_kg,
        sway_kg: mass_kg + added,
        sway_by_yaw_kg_m: moment_kg_m,
        yaw_by_sway_kg_m: moment_kg_m,
        yaw_kg_m2: ship.yaw_inertia_kg_m2() + added * ship.lpp_m.powi(2) / 15.0,
        moment_kg_m,
    }
}

impl Truth for Ferry {
    fn dimensions(&self) -> &Dimensions {
        &self.dimensions
    }

    fn accelerations(&self, state: &StateVector, n_rps: f64) -> [f64; 4] {
        let velocities = [at::U, at::V, at::R].map(|place| state[place]);
        let sides = SIDES.map(|side| self.side(velocities, state[at::DELTA], n_rps, side));
        let hull = self.hull(velocities);
        let forces = std::array::from_fn(|axis| hull[axis] + sides[0][axis] + sides[1][axis]);
        let [surge, sway, yaw] = self.inertia.accelerations(forces, velocities);
        [surge, sway, yaw, 0.0]
    }

    fn inertia(&self) -> &Inertia {
        &self.inertia
    }

    fn revolutions_rps(&self) -> f64 {
        self.revolutions_rps
    }

    fn rudder_rate_rad_s(&self) -> f64 {
        3.5_f64.to_radians()
    }
}
