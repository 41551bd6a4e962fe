//! Particulars of a craft.

/// What a vessel file says, SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Size {
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
    /// Displaced volume, m3.
    pub volume_m3: f64,
    /// Centre of gravity ahead of midship, m.
    pub x_g_m: f64,
    /// Radius of gyration in yaw by length.
    pub yaw_gyradius_ratio: f64,
    /// Speed of the trials, m/s.
    pub speed_m_s: f64,
    /// Density of the water, kg/m3.
    pub density_kg_m3: f64,
    /// Further particulars by their names in vessel files.
    pub further: Vec<(&'static str, f64)>,
}

impl Size {
    /// Mass, kg.
    pub fn mass_kg(&self) -> f64 {
        self.density_kg_m3 * self.volume_m3
    }

    /// Time in which the craft covers its length at its speed, s.
    pub fn length_time_s(&self) -> f64 {
        self.lpp_m / self.speed_m_s
    }

    /// Wetted surface, m2: Denny's formula `1.7 L T + V / T`.
    pub fn wetted_surface_m2(&self) -> f64 {
        1.7 * self.lpp_m * self.draught_m + self.volume_m3 / self.draught_m
    }

    /// All particulars by their names in vessel files.
    pub fn particulars(&self) -> Vec<(&'static str, f64)> {
        let mut all = vec![
            ("lpp_m", self.lpp_m),
            ("beam_m", self.beam_m),
            ("draught_m", self.draught_m),
            ("displacement_m3", self.volume_m3),
            ("x_g_m", self.x_g_m),
            ("yaw_gyradius_ratio", self.yaw_gyradius_ratio),
            ("service_speed_m_s", self.speed_m_s),
            ("water_density_kg_m3", self.density_kg_m3),
        ];
        all.extend(&self.further);
        all
    }
}
