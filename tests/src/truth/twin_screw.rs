//! A ship with two propellers and two rudders, whose flow differs from side to side as soon as it
//! drifts: slender-body theory for the hull's lift, strips for the cross-flow.

use std::f64::consts::PI;

use sistership_simulation::state::{StateVector, at};

use super::cross_flow::CrossFlow;
use super::dimensions::Dimensions;
use super::motion::{Inertia, Truth};
use super::propeller::Propeller;
use super::resistance::Resistance;
use super::rudder::Rudder;

/// Port and starboard.
const SIDES: [f64; 2] = [-1.0, 1.0];
/// Added mass in surge by mass, chosen.
const SURGE_ADDED: f64 = 0.04;
/// Share of the added mass in sway that turns drift and yaw into surge, chosen.
const SURGE_BY_TURNING: f64 = 0.5;

/// What makes one ship differ from another of the same size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwinForm {
    /// Shafts off the centre line, m.
    pub shaft_m: f64,
    /// Added mass of the hull by that of a plate of its draught.
    pub section: f64,
    /// The same at the trailing edge, with skegs and shaft brackets.
    pub trailing_edge: f64,
    /// Share of the wake that goes on the side from which the water comes, and comes on the other.
    pub wake_shelter: f64,
    /// Share of the straightening of the flow that the hull adds on the sheltered side.
    pub rudder_shelter: f64,
    /// Drift at the stern at which the shelter is three quarters of its full effect, rad.
    pub shelter_rad: f64,
    /// Cross-flow drag.
    pub cross_flow: CrossFlow,
    /// Resistance.
    pub resistance: Resistance,
    /// One of the two propellers.
    pub propeller: Propeller,
    /// One of the two rudders.
    pub rudder: Rudder,
    /// Rudder rate, deg/s.
    pub rudder_rate_deg_s: f64,
}

/// The ship.
#[derive(Debug, Clone)]
pub struct TwinScrew {
    dimensions: Dimensions,
    form: TwinForm,
    inertia: Inertia,
    revolutions_rps: f64,
}

impl TwinScrew {
    /// A ship of a size and form.
    pub fn new(dimensions: Dimensions, form: TwinForm) -> Self {
        let inertia = inertia(&dimensions, form.section);
        let mut ship = Self { dimensions, form, inertia, revolutions_rps: 0.0 };
        ship.revolutions_rps = ship.balanced_rps();
        ship
    }

    fn balanced_rps(&self) -> f64 {
        let Dimensions { speed_m_s, density_kg_m3, .. } = self.dimensions;
        let hull_n = -self.form.resistance.force_n(&self.dimensions, speed_m_s);
        let need = |rudders_n: f64| {
            let resistance_n = hull_n + rudders_n;
            self.form.propeller.revolutions_for(density_kg_m3, speed_m_s, resistance_n, 2.0)
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
        let advance = (1.0 - self.form.propeller.wake) * speed_m_s;
        let thrust = self.form.propeller.thrust_n(density_kg_m3, advance, n_rps);
        2.0 * (1.0 - self.form.propeller.deduction) * thrust
    }

    /// Surge, sway (N) and yaw (N m) of propeller and rudder on one side.
    fn side(&self, [u, v, r]: [f64; 3], delta: f64, n_rps: f64, side: f64) -> [f64; 3] {
        let density = self.dimensions.density_kg_m3;
        let across = v + self.form.rudder.x_m * r;
        let along = u - side * self.form.shaft_m * r;
        // Positive where the water comes from this side.
        let from_here = side * (across.atan2(u.abs().max(1e-6)) / self.form.shelter_rad).tanh();
        let wake = self.form.propeller.wake * (1.0 - self.form.wake_shelter * from_here);
        let advance = (1.0 - wake) * along;
        let thrust = self.form.propeller.thrust_n(density, advance, n_rps);
        let slipstream = self.form.propeller.slipstream_m_s(density, advance, thrust);
        let axial = self.form.rudder.axial_m_s(advance, slipstream);
        let seen = (1.0 + self.form.rudder_shelter * from_here) * across;
        let [x, y, n] = self.form.rudder.forces(density, delta, axial, seen);
        let ahead = (1.0 - self.form.propeller.deduction) * thrust + x;
        [ahead, y, n - side * self.form.shaft_m * ahead]
    }

    /// Slender-body theory with a trailing edge at the stern (Newman 1977, Marine Hydrodynamics,
    /// chapter 7): with `a` the added mass of a section, `Y = -u a_T (v + x_T r)`, `N = x_T Y - u v
    /// A`, `A` its integral over the length; and the strips.
    fn hull(&self, [u, v, r]: [f64; 3]) -> [f64; 3] {
        let ship = &self.dimensions;
        let plate = section(ship);
        let edge = -0.5 * ship.lpp_m;
        let lift = -u.abs() * self.form.trailing_edge * plate * (v + edge * r);
        let munk = u * v * self.form.section * plate * ship.lpp_m;
        let [y, n] = self.form.cross_flow.forces(ship, v, r);
        let added = self.inertia.sway_kg - self.inertia.mass_kg;
        let x = self.form.resistance.force_n(ship, u) + SURGE_BY_TURNING * added * v * r;
        [x, lift + y, edge * lift - munk + n]
    }
}

/// Added mass of a plate of the draught by length, kg/m: half of `pi rho T^2`, as the surface is a
/// mirror.
fn section(ship: &Dimensions) -> f64 {
    0.5 * PI * ship.density_kg_m3 * ship.draught_m.powi(2)
}

fn inertia(ship: &Dimensions, share: f64) -> Inertia {
    let mass_kg = ship.mass_kg();
    let added = share * section(ship) * ship.lpp_m;
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

impl Truth for TwinScrew {
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
        self.form.rudder_rate_deg_s.to_radians()
    }
}
