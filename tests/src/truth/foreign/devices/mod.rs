//! What moves and steers a craft: each device gives its force in the flow at its place.

mod azimuth;
mod jet;
mod outboard;
mod pod;
mod rudder;
mod thruster;

pub use azimuth::Azimuth;
pub use jet::Jet;
pub use outboard::Outboard;
pub use pod::Pod;
pub use rudder::ScrewAndRudder;
pub use thruster::Thruster;

/// Velocity of a place of the craft through the water, m/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flow {
    /// Ahead.
    pub along: f64,
    /// To starboard.
    pub across: f64,
}

/// What a device gives and takes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Load {
    /// Surge force, N.
    pub surge_n: f64,
    /// Sway force at the device, N.
    pub sway_n: f64,
    /// Sway force that it draws on the hull, N.
    pub on_hull_n: f64,
    /// Torque that its shaft takes, N m.
    pub torque_n_m: f64,
}

/// A law of force.
pub trait Device: Send + Sync {
    /// Force and torque at an angle (rad, positive turns to starboard) and revolutions (1/s).
    fn load(&self, flow: Flow, angle_rad: f64, n_rps: f64) -> Load;
}

/// A device in its place.
pub struct Unit {
    /// Ahead of midship, m.
    pub x_m: f64,
    /// Off the centre plane to starboard, m.
    pub y_m: f64,
    /// Where the force on the hull acts, m ahead of midship.
    pub hull_x_m: f64,
    /// Which shaft turns it.
    pub shaft: usize,
    /// The device.
    pub device: Box<dyn Device>,
}

impl Unit {
    /// A device in a place that draws no force on the hull.
    pub fn new(x_m: f64, y_m: f64, shaft: usize, device: impl Device + 'static) -> Self {
        Self { x_m, y_m, hull_x_m: x_m, shaft, device: Box::new(device) }
    }

    /// What it gives at velocities of the craft.
    pub fn load(&self, [u, v, r]: [f64; 3], angle_rad: f64, n_rps: f64) -> Load {
        let flow = Flow { along: u - self.y_m * r, across: v + self.x_m * r };
        self.device.load(flow, angle_rad, n_rps)
    }

    /// Surge, sway (N) and yaw (N m) on the craft.
    pub fn forces(&self, load: &Load) -> [f64; 3] {
        let yaw = self.x_m * load.sway_n + self.hull_x_m * load.on_hull_n;
        [load.surge_n, load.sway_n + load.on_hull_n, yaw - self.y_m * load.surge_n]
    }
}

/// Axes of a device turned by an angle: along points ahead and to port for positive angles.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Axes {
    sin: f64,
    cos: f64,
}

impl Axes {
    fn new(angle_rad: f64) -> Self {
        let (sin, cos) = angle_rad.sin_cos();
        Self { sin, cos }
    }

    /// Resolves a vector of the craft along and across the device.
    fn resolve(self, surge: f64, sway: f64) -> [f64; 2] {
        [surge * self.cos - sway * self.sin, surge * self.sin + sway * self.cos]
    }

    /// Resolves a vector of the device in surge and sway.
    fn to_craft(self, [along, across]: [f64; 2]) -> [f64; 2] {
        [along * self.cos + across * self.sin, across * self.cos - along * self.sin]
    }
}
