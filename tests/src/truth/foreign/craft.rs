//! A craft: hulls, devices, engine, steering gear, roll and windage under one set of equations of
//! motion.

use sistership_simulation::StateVector;
use sistership_simulation::state::at;

use super::devices::{Load, Unit};
use super::engine::{Engine, Rating};
use super::hull::Hull;
use super::motion::{Motion, Orders, SHAFTS};
use super::resistance::Windage;
use super::roll::{Heeling, Roll};
use super::size::Size;
use crate::truth::dimensions::{Dimensions, Upright};
use crate::truth::motion::{Inertia, Truth};

/// Added mass in surge by mass, chosen among 0.03 to 0.07 of ship forms.
const SURGE_ADDED: f64 = 0.05;
/// Length below which the step of the integration is short, m.
const SMALL_M: f64 = 30.0;
/// Steps of the integration, s, for small craft and others.
const STEPS_S: [f64; 2] = [0.02, 0.1];
/// Revolutions beyond any that drive a craft, 1/s.
const MOST_RPS: f64 = 200.0;

/// Steering gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steering {
    /// Rate, rad/s.
    pub rate_rad_s: f64,
    /// Largest angle, rad.
    pub stop_rad: f64,
    /// For craft without an angle: difference of the revolutions of either shaft, by those of the
    /// approach, that stands for one radian.
    pub difference: Option<f64>,
}

/// What a craft is made of.
pub struct Parts {
    /// Particulars.
    pub size: Size,
    /// One hull or two.
    pub hulls: Vec<Hull>,
    /// Devices.
    pub units: Vec<Unit>,
    /// Engine of each shaft.
    pub engine: Engine,
    /// Steering gear.
    pub steering: Steering,
    /// Roll, where trials record it.
    pub roll: Option<Roll>,
    /// Windage, where it counts.
    pub windage: Option<Windage>,
}

/// The craft.
pub struct Craft {
    parts: Parts,
    dimensions: Dimensions,
    inertia: Inertia,
    rating: Rating,
    shafts: usize,
}

impl Craft {
    /// Puts a craft together; what its engine can do follows from its speed.
    pub fn new(parts: Parts) -> Self {
        let shafts = 1 + parts.units.iter().map(|unit| unit.shaft).max().unwrap_or_default();
        let inertia = inertia(&parts.size, &parts.hulls);
        let dimensions = dimensions(&parts);
        let rating = Rating::default();
        let mut craft = Self { parts, dimensions, inertia, rating, shafts };
        let speed = craft.size().speed_m_s;
        let n_rps = craft.balanced_rps(speed);
        let loads = craft.loads([speed, 0.0, 0.0], 0.0, [n_rps; SHAFTS]);
        craft.rating = Rating { n_rps, torque_n_m: craft.torques(&loads)[0] };
        craft
    }

    /// Particulars.
    pub fn size(&self) -> &Size {
        &self.parts.size
    }

    /// Step of the integration, s.
    pub fn step_s(&self) -> f64 {
        STEPS_S[usize::from(self.size().lpp_m >= SMALL_M)]
    }

    /// Number of shafts.
    pub fn shafts(&self) -> usize {
        self.shafts
    }

    /// Whether trials record roll.
    pub fn rolls(&self) -> bool {
        self.parts.roll.is_some()
    }

    /// Whether the difference of two thrusts steers, and no angle.
    pub fn steers_by_difference(&self) -> bool {
        self.parts.steering.difference.is_some()
    }

    /// Inertia with the added mass.
    pub fn inertia(&self) -> &Inertia {
        &self.inertia
    }

    /// Revolutions on the approach at full speed, 1/s.
    pub fn rated_rps(&self) -> f64 {
        self.rating.n_rps
    }

    /// Revolutions, 1/s, that balance the resistance in straight running.
    pub fn balanced_rps(&self, speed_m_s: f64) -> f64 {
        let (mut low, mut high) = (0.0, MOST_RPS);
        for _ in 0..70 {
            let middle = 0.5 * (low + high);
            if self.net_surge_n(speed_m_s, middle) < 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    fn net_surge_n(&self, speed_m_s: f64, n_rps: f64) -> f64 {
        let velocities = [speed_m_s, 0.0, 0.0];
        let loads = self.loads(velocities, 0.0, [n_rps; SHAFTS]);
        self.forces(velocities, 0.0, &loads).total[0]
    }

    /// Orders for a speed by that of the approach and an angle: at full speed the engine's limit
    /// may hold the revolutions below the order.
    pub fn orders(&self, speed: f64, angle_rad: f64) -> Orders {
        let n_rps = match speed {
            full if full >= 1.0 => self.rating.n_rps * self.parts.engine.order,
            part => self.balanced_rps(part * self.size().speed_m_s),
        };
        self.orders_at(n_rps, angle_rad)
    }

    /// Orders at revolutions (1/s) and an angle.
    pub fn orders_at(&self, n_rps: f64, angle_rad: f64) -> Orders {
        match self.parts.steering.difference {
            None => Orders { angle_rad, n_rps: [n_rps; SHAFTS] },
            Some(by_radian) => {
                let apart = by_radian * angle_rad;
                Orders { angle_rad: 0.0, n_rps: [n_rps * (1.0 + apart), n_rps * (1.0 - apart)] }
            }
        }
    }

    /// Rate of change of the state.
    pub fn rate(&self, motion: &Motion, orders: &Orders) -> Motion {
        let mut body = kinematics(&motion.body);
        let (accelerations, n_rps) = self.response(motion, orders.n_rps);
        [body[at::U], body[at::V], body[at::R], body[at::P]] = accelerations;
        body[at::DELTA] = self.gear_rate(motion.body[at::DELTA], orders.angle_rad);
        Motion { body, n_rps }
    }

    /// Accelerations of surge, sway, yaw and roll, and of the shafts under ordered revolutions.
    fn response(&self, motion: &Motion, orders_rps: [f64; SHAFTS]) -> ([f64; 4], [f64; SHAFTS]) {
        let velocities = motion.velocities();
        let loads = self.loads(velocities, motion.body[at::DELTA], motion.n_rps);
        let forces = self.forces(velocities, motion.body[at::PHI], &loads);
        let [surge, sway, yaw] = self.inertia.accelerations(forces.total, velocities);
        let roll = self.roll_acceleration(&motion.body, &forces);
        let torques = self.torques(&loads);
        let engine = &self.parts.engine;
        let spin = |shaft: usize| {
            let order = orders_rps[shaft];
            engine.acceleration(self.rating, motion.n_rps[shaft], order, torques[shaft])
        };
        // A single shaft stands in both places, so that their mean is its own.
        let shafts = std::array::from_fn(|k| spin(k.min(self.shafts - 1)));
        ([surge, sway, yaw, roll], shafts)
    }

    fn loads(&self, velocities: [f64; 3], angle_rad: f64, n_rps: [f64; SHAFTS]) -> Vec<Load> {
        let load = |unit: &Unit| unit.load(velocities, angle_rad, n_rps[unit.shaft]);
        self.parts.units.iter().map(load).collect()
    }

    fn torques(&self, loads: &[Load]) -> [f64; SHAFTS] {
        let mut torques = [0.0; SHAFTS];
        for (unit, load) in self.parts.units.iter().zip(loads) {
            torques[unit.shaft] += load.torque_n_m;
        }
        torques
    }

    fn forces(&self, velocities: [f64; 3], heel_rad: f64, loads: &[Load]) -> Forces {
        let hulls = self.parts.hulls.iter().map(|hull| hull.forces(velocities, heel_rad));
        let hull = hulls.fold([0.0; 3], add);
        let units = self.parts.units.iter().zip(loads).map(|(unit, load)| unit.forces(load));
        let devices = units.fold([0.0; 3], add);
        let air = self.parts.windage.map_or([0.0; 3], |windage| windage.forces(velocities));
        Forces { total: add(add(hull, devices), air), sway_n: [hull[1], devices[1]] }
    }

    fn roll_acceleration(&self, body: &StateVector, forces: &Forces) -> f64 {
        let Some(roll) = &self.parts.roll else { return 0.0 };
        let speed = body[at::U].abs() / self.size().speed_m_s;
        let mass_kg = self.size().mass_kg();
        let heeling = Heeling { mass_kg, sway_n: forces.sway_n, speed };
        roll.acceleration(&heeling, body[at::PHI], body[at::P])
    }

    /// A gear that moves at its full rate and slows down over the last step.
    fn gear_rate(&self, angle_rad: f64, order_rad: f64) -> f64 {
        let Steering { rate_rad_s, stop_rad, .. } = self.parts.steering;
        let order = order_rad.clamp(-stop_rad, stop_rad);
        ((order - angle_rad) / self.step_s()).clamp(-rate_rad_s, rate_rad_s)
    }
}

/// The craft at the full order of its engine, for what may be hidden in its trials.
impl Truth for Craft {
    fn dimensions(&self) -> &Dimensions {
        &self.dimensions
    }

    fn accelerations(&self, state: &StateVector, n_rps: f64) -> [f64; 4] {
        self.powered_accelerations(state, [n_rps; SHAFTS]).0
    }

    fn powered_accelerations(
        &self,
        state: &StateVector,
        n_rps: [f64; SHAFTS],
    ) -> ([f64; 4], [f64; SHAFTS]) {
        self.response(&Motion { body: *state, n_rps }, self.orders(1.0, 0.0).n_rps)
    }

    fn step_s(&self) -> f64 {
        Craft::step_s(self)
    }

    fn inertia(&self) -> &Inertia {
        &self.inertia
    }

    fn revolutions_rps(&self) -> f64 {
        self.rated_rps()
    }

    fn rudder_rate_rad_s(&self) -> f64 {
        self.parts.steering.rate_rad_s
    }
}

/// Surge, sway (N) and yaw (N m), and what of the sway hull and devices make.
struct Forces {
    total: [f64; 3],
    sway_n: [f64; 2],
}

fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] + b[axis])
}

fn kinematics(body: &StateVector) -> StateVector {
    let (sin, cos) = body[at::PSI].sin_cos();
    let (u, across) = (body[at::U], body[at::V] * body[at::PHI].cos());
    let mut rate = StateVector::zeros();
    rate[at::PHI] = body[at::P];
    rate[at::PSI] = body[at::R] * body[at::PHI].cos();
    rate[at::X] = u * cos - across * sin;
    rate[at::Y] = u * sin + across * cos;
    rate
}

/// Dimensions by which hidden effects are sized; without a rudder its area is zero.
fn dimensions(parts: &Parts) -> Dimensions {
    let size = &parts.size;
    let further = |name: &str| {
        size.further.iter().find(|(known, _)| *known == name).map_or(0.0, |(_, value)| *value)
    };
    // The height of the centre of gravity is not used by any effect.
    let upright = |roll: &Roll| Upright { gm_m: roll.gm_m, kg_m: size.draught_m };
    Dimensions {
        name: size.name.clone(),
        category: size.category,
        lpp_m: size.lpp_m,
        beam_m: size.beam_m,
        draught_m: size.draught_m,
        block_coefficient: size.volume_m3 / (size.lpp_m * size.beam_m * size.draught_m),
        x_g_m: size.x_g_m,
        yaw_gyradius_ratio: size.yaw_gyradius_ratio,
        rudder_area_m2: further("rudder_area_m2"),
        rudder_height_m: further("rudder_height_m"),
        propeller_diameter_m: further("propeller_diameter_m"),
        speed_m_s: size.speed_m_s,
        density_kg_m3: size.density_kg_m3,
        upright: parts.roll.as_ref().map(upright),
    }
}

fn inertia(size: &Size, hulls: &[Hull]) -> Inertia {
    let mass_kg = size.mass_kg();
    let [added, first, second] = hulls.iter().map(Hull::added_mass).fold([0.0; 3], add);
    let moment_kg_m = mass_kg * size.x_g_m;
    let gyration = (size.yaw_gyradius_ratio * size.lpp_m).powi(2) + size.x_g_m.powi(2);
    Inertia {
        mass_kg,
        surge_kg: (1.0 + SURGE_ADDED) * mass_kg,
        sway_kg: mass_kg + added,
        sway_by_yaw_kg_m: moment_kg_m + first,
        yaw_by_sway_kg_m: moment_kg_m + first,
        yaw_kg_m2: mass_kg * gyration + second,
        moment_kg_m,
    }
}
