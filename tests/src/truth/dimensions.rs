//! Size and mass of a ship.

/// Acceleration of gravity, m/s2.
pub const GRAVITY: f64 = 9.81;

/// Roll stability, of ships that roll.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Upright {
    /// Metacentric height, m.
    pub gm_m: f64,
    /// Centre of gravity above the keel, m.
    pub kg_m: f64,
}

/// What a ship's papers say, SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Dimensions {
    /// Name in files: lower case, digits, hyphens.
    pub name: String,
    /// Category of the zoo.
    pub category: &'static str,
    /// Length between perpendiculars, m.
    pub lpp_m: f64,
    /// Breadth, m.
    pub beam_m: f64,
    /// Draught, m.
    pub draught_m: f64,
    /// Block coefficient.
    pub block_coefficient: f64,
    /// Centre of gravity ahead of midship, m.
    pub x_g_m: f64,
    /// Radius of gyration in yaw by length.
    pub yaw_gyradius_ratio: f64,
    /// Area of all rudders, m2.
    pub rudder_area_m2: f64,
    /// Height of a rudder, m.
    pub rudder_height_m: f64,
    /// Diameter of a propeller, m.
    pub propeller_diameter_m: f64,
    /// Approach speed of the trials, m/s.
    pub speed_m_s: f64,
    /// Density of the water, kg/m3.
    pub density_kg_m3: f64,
    /// Roll stability; absent for ships that are told in the plane.
    pub upright: Option<Upright>,
}

impl Dimensions {
    /// Displaced volume, m3.
    pub fn volume_m3(&self) -> f64 {
        self.block_coefficient * self.lpp_m * self.beam_m * self.draught_m
    }

    /// Mass, kg.
    pub fn mass_kg(&self) -> f64 {
        self.density_kg_m3 * self.volume_m3()
    }

    /// Moment of inertia in yaw about midship, kg m2.
    pub fn yaw_inertia_kg_m2(&self) -> f64 {
        let about_gravity = (self.yaw_gyradius_ratio * self.lpp_m).powi(2);
        self.mass_kg() * (about_gravity + self.x_g_m.powi(2))
    }

    /// Wetted surface, m2: Denny's formula `L (1.7 T + C_B B)`.
    pub fn wetted_surface_m2(&self) -> f64 {
        self.lpp_m * (1.7 * self.draught_m + self.block_coefficient * self.beam_m)
    }

    /// Time in which the ship sails its length on the approach, s.
    pub fn length_time_s(&self) -> f64 {
        self.lpp_m / self.speed_m_s
    }
}
