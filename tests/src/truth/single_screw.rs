//! A ship with one propeller and one rudder: regression for the linear forces, strips for the
//! cross-flow.

use sistership_simulation::state::{StateVector, at};

use super::clarke::{Derivatives, derivatives};
use super::cross_flow::CrossFlow;
use super::dimensions::{Dimensions, GRAVITY, Upright};
use super::motion::{Inertia, Truth};
use super::propeller::Propeller;
use super::resistance::Resistance;
use super::rudder::Rudder;

/// Added mass in surge by mass, chosen among 0.03 to 0.07 of ship forms.
const SURGE_ADDED: f64 = 0.05;
/// Share of the added mass in sway that turns drift and yaw into surge, chosen among 0.3 to 0.8.
const SURGE_BY_TURNING: f64 = 0.4;

/// What makes one ship differ from another of the same size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Form {
    /// Factors on the regression's `Y_v`, `Y_r`, `N_v` and `N_r`.
    pub scatter: [f64; 4],
    /// Cross-flow drag.
    pub cross_flow: CrossFlow,
    /// Resistance.
    pub resistance: Resistance,
    /// Propeller.
    pub propeller: Propeller,
    /// Rudder.
    pub rudder: Rudder,
    /// Rudder rate, deg/s; SOLAS asks for 65 deg in 28 s.
    pub rudder_rate_deg_s: f64,
    /// Heeling; only for ships that roll.
    pub heeling: Option<Heeling>,
}

/// Damping of roll, and what heel does to the flow about the hull.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heeling {
    /// Radius of gyration with the water's share, by breadth.
    pub gyradius_ratio: f64,
    /// Linear damping, a share of the critical.
    pub damping: f64,
    /// Quadratic damping by its moment of inertia, 1/rad.
    pub quadratic: f64,
    /// Sway force by heel, prime system.
    pub y_phi: f64,
    /// Yaw moment by heel, prime system.
    pub n_phi: f64,
    /// Height of the rudder force above the keel by draught.
    pub rudder_height: f64,
}

/// The ship.
#[derive(Debug, Clone)]
pub struct SingleScrew {
    dimensions: Dimensions,
    form: Form,
    derivatives: Derivatives,
    inertia: Inertia,
    revolutions_rps: f64,
}

impl SingleScrew {
    /// A ship of a size and form.
    pub fn new(dimensions: Dimensions, form: Form) -> Self {
        let mut derivatives = derivatives(&dimensions);
        let [y_v, y_r, n_v, n_r] = form.scatter;
        derivatives.y_v *= y_v;
        derivatives.y_r *= y_r;
        derivatives.n_v *= n_v;
        derivatives.n_r *= n_r;
        let inertia = inertia(&dimensions, &derivatives);
        let mut ship = Self { dimensions, form, derivatives, inertia, revolutions_rps: 0.0 };
        ship.revolutions_rps = ship.balanced_rps();
        ship
    }

    /// Revolutions at which the thrust balances hull and rudder.
    fn balanced_rps(&self) -> f64 {
        let Dimensions { speed_m_s, density_kg_m3, .. } = self.dimensions;
        let hull_n = -self.form.resistance.force_n(&self.dimensions, speed_m_s);
        let need = |rudder_n: f64| {
            let resistance_n = hull_n + rudder_n;
            self.form.propeller.revolutions_for(density_kg_m3, speed_m_s, resistance_n, 1.0)
        };
        let mut n_rps = need(0.0);
        for _ in 0..20 {
            let ahead = Flow { u: speed_m_s, v: 0.0, r: 0.0, delta: 0.0 };
            let (_, rudder) = self.stern(&ahead, n_rps);
            n_rps = need(-rudder[0]);
        }
        n_rps
    }

    /// Thrust with its deduction (N) and the rudder's forces.
    fn stern(&self, flow: &Flow, n_rps: f64) -> (f64, [f64; 3]) {
        let (propeller, rudder) = (&self.form.propeller, &self.form.rudder);
        let density = self.dimensions.density_kg_m3;
        let across = flow.v + rudder.x_m * flow.r;
        let drift = (-across).atan2(flow.u.abs().max(1e-6));
        let advance = propeller.advance_m_s(flow.u, drift);
        let thrust = propeller.thrust_n(density, advance, n_rps);
        let slipstream = propeller.slipstream_m_s(density, advance, thrust);
        let axial = rudder.axial_m_s(advance, slipstream);
        let forces = rudder.forces(density, flow.delta, axial, across);
        ((1.0 - propeller.deduction) * thrust, forces)
    }

    /// Surge, sway (N) and yaw (N m) on the hull.
    fn hull(&self, flow: &Flow, heel_rad: f64) -> [f64; 3] {
        let Flow { u, v, r, .. } = *flow;
        let (d, ship) = (&self.derivatives, &self.dimensions);
        // Lift and Munk moment go with the speed ahead; at large drift the strips take over.
        let speed = u.abs();
        let area = 0.5 * ship.density_kg_m3 * ship.lpp_m.powi(2);
        let turning = ship.lpp_m * r;
        let [y_across, n_across] = self.form.cross_flow.forces(ship, v, r);
        let (y_phi, n_phi) = self.form.heeling.map_or((0.0, 0.0), |h| (h.y_phi, h.n_phi));
        let heel = speed * heel_rad;
        let added = self.inertia.sway_kg - self.inertia.mass_kg;
        let x = self.form.resistance.force_n(ship, u) + SURGE_BY_TURNING * added * v * r;
        let y = area * speed * (d.y_v * v + d.y_r * turning + y_phi * heel);
        let n = area * ship.lpp_m * speed * (d.n_v * v + d.n_r * turning + n_phi * heel);
        [x, y + y_across, n + n_across]
    }

    /// Roll acceleration, rad/s2, under the sway forces of hull and rudder (N).
    fn roll(&self, state: &StateVector, hull_n: f64, rudder_n: f64) -> f64 {
        let (Some(heeling), Some(upright)) = (self.form.heeling, self.dimensions.upright) else {
            return 0.0;
        };
        let Upright { gm_m, kg_m } = upright;
        let (mass, draught) = (self.dimensions.mass_kg(), self.dimensions.draught_m);
        let inertia = mass * (heeling.gyradius_ratio * self.dimensions.beam_m).powi(2);
        let (phi, p) = (state[at::PHI], state[at::P]);
        let natural = (mass * GRAVITY * gm_m / inertia).sqrt();
        let damping = 2.0 * heeling.damping * natural * p + heeling.quadratic * p * p.abs();
        let levers =
            (kg_m - 0.5 * draught) * hull_n + (kg_m - heeling.rudder_height * draught) * rudder_n;
        -levers / inertia - damping - natural.powi(2) * phi.sin()
    }
}

/// Velocities and rudder angle.
struct Flow {
    u: f64,
    v: f64,
    r: f64,
    delta: f64,
}

fn inertia(ship: &Dimensions, derivatives: &Derivatives) -> Inertia {
    let mass_kg = ship.mass_kg();
    let half = |power: i32| 0.5 * ship.density_kg_m3 * ship.lpp_m.powi(power);
    let moment_kg_m = mass_kg * ship.x_g_m;
    Inertia {
        mass_kg,
        surge_kg: (1.0 + SURGE_ADDED) * mass_kg,
        sway_kg: mass_kg - half(3) * derivatives.y_vdot,
        sway_by_yaw_kg_m: moment_kg_m - half(4) * derivatives.y_rdot,
        yaw_by_sway_kg_m: moment_kg_m - half(4) * derivatives.n_vdot,
        yaw_kg_m2: ship.yaw_inertia_kg_m2() - half(5) * derivatives.n_rdot,
        moment_kg_m,
    }
}

impl Truth for SingleScrew {
    fn dimensions(&self) -> &Dimensions {
        &self.dimensions
    }

    fn accelerations(&self, state: &StateVector, n_rps: f64) -> [f64; 4] {
        let [u, v, r] = [at::U, at::V, at::R].map(|place| state[place]);
        let flow = Flow { u, v, r, delta: state[at::DELTA] };
        let hull = self.hull(&flow, state[at::PHI]);
        let (thrust, rudder) = self.stern(&flow, n_rps);
        let forces = [hull[0] + rudder[0] + thrust, hull[1] + rudder[1], hull[2] + rudder[2]];
        let [surge, sway, yaw] = self.inertia.accelerations(forces, [u, v, r]);
        [surge, sway, yaw, self.roll(state, hull[1], rudder[1])]
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
