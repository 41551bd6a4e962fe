//! A hull by sections: slender-body theory with incomplete recovery at the downstream end, viscous
//! lift and cross-flow drag, summed over the length.
//!
//! A section at `x` of added mass `a` moves across the water at `w = v + x r`. Ahead, the flow
//! passes it at `u` and its force is `u d(a w)/dx` (Newman 1977, Marine Hydrodynamics, chapter 7);
//! downstream of midship a share of it is lost to separation, and more the larger `w` is by `u`.
//! Cross-flow drag is `rho/2 T C_D w |w|`, `C_D` after Hooft (1994), Ocean Engineering 21.

use std::f64::consts::PI;

use super::resistance::Resistance;
use super::size::Size;

/// Sections of equal length.
const SECTIONS: usize = 24;
/// Drift of a section, by the speed ahead, at which three quarters of the recovery are lost.
const SEPARATED: f64 = 0.35;

/// Form of a hull.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Form {
    /// Added mass at midship by that of a plate of the draught.
    pub section: f64,
    /// Fullness of the bow: exponent with which sections vanish, 2 to 6.
    pub bow: f64,
    /// Added mass at the stern, with its skeg, by that at midship.
    pub stern: f64,
    /// Share of the recovery that is lost at small drift.
    pub lost: f64,
    /// Viscous lift by lateral area.
    pub lift: f64,
    /// Cross-flow drag at midship, and how much more the ends have.
    pub drag: [f64; 2],
    /// Share of the centripetal force of the added mass that acts in surge.
    pub centripetal: f64,
    /// Sway and yaw by heel, by lateral area.
    pub by_heel: [f64; 2],
}

/// Section of a hull.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Section {
    x_m: f64,
    /// Added mass by length, kg/m, and its slope.
    added: f64,
    slope: f64,
    drag: f64,
}

/// A hull, or one of two.
#[derive(Debug, Clone, PartialEq)]
pub struct Hull {
    /// Off the centre plane to starboard, m.
    pub y_m: f64,
    length_m: f64,
    draught_m: f64,
    density: f64,
    form: Form,
    resistance: Resistance,
    sections: Vec<Section>,
    stern_added: f64,
}

/// Integrals of the added mass over the length: itself, first and second moment.
pub type AddedMass = [f64; 3];

impl Hull {
    /// A hull of the length and draught of a craft.
    pub fn new(size: &Size, form: Form, resistance: Resistance) -> Self {
        let midship = 0.5 * PI * size.density_kg_m3 * size.draught_m.powi(2) * form.section;
        let sections = (0..SECTIONS).map(|k| section(k, size.lpp_m, midship, &form)).collect();
        Self {
            y_m: 0.0,
            length_m: size.lpp_m,
            draught_m: size.draught_m,
            density: size.density_kg_m3,
            form,
            resistance,
            sections,
            stern_added: midship * form.stern,
        }
    }

    /// The same off the centre plane.
    pub fn at(self, y_m: f64) -> Self {
        Self { y_m, ..self }
    }

    /// Integrals of the added mass.
    pub fn added_mass(&self) -> AddedMass {
        let width = self.length_m / SECTIONS as f64;
        let integral = |power: i32| -> f64 {
            self.sections.iter().map(|s| s.added * s.x_m.powi(power) * width).sum()
        };
        [integral(0), integral(1), integral(2)]
    }

    /// Surge, sway (N) and yaw (N m) at velocities of the craft and heel.
    pub fn forces(&self, [u, v, r]: [f64; 3], heel_rad: f64) -> [f64; 3] {
        let ahead = u - self.y_m * r;
        let immersion = self.resistance.immersion(ahead);
        let width = self.length_m / SECTIONS as f64;
        let (mut y, mut n) = self.stern_edge(ahead, v, r);
        for section in &self.sections {
            let force = width * immersion * self.section_force(section, ahead, v, r);
            y += force;
            n += section.x_m * force;
        }
        let head = 0.5 * self.density * self.length_m * self.draught_m * ahead * ahead.abs();
        let heel = head * heel_rad.sin();
        y += self.form.by_heel[0] * heel;
        n += self.form.by_heel[1] * heel * self.length_m;
        let [added, first, _] = self.added_mass();
        let drawn = self.form.centripetal * immersion * (added * v + first * r) * r;
        let x = self.resistance.force_n(self.density, self.length_m, ahead) + drawn;
        [x, y, n - self.y_m * x]
    }

    /// Force by length, N/m.
    fn section_force(&self, section: &Section, u: f64, v: f64, r: f64) -> f64 {
        let w = v + section.x_m * r;
        let recovered = if section.x_m * u < 0.0 { 1.0 - self.lost(w, u) } else { 1.0 };
        let ideal = u * (section.slope * w + section.added * r);
        let half = 0.5 * self.density * self.draught_m;
        recovered * ideal - half * (self.form.lift * u.abs() + section.drag * w.abs()) * w
    }

    fn lost(&self, w: f64, u: f64) -> f64 {
        let drift = w.abs() / u.abs().max(1e-6);
        let rest = 1.0 - self.form.lost;
        self.form.lost + rest * (drift / SEPARATED).tanh().powi(2)
    }

    /// Astern the stern is the leading edge, and its section is set in motion there.
    fn stern_edge(&self, u: f64, v: f64, r: f64) -> (f64, f64) {
        let x = -0.5 * self.length_m;
        let y = u.min(0.0) * self.stern_added * (v + x * r);
        (y, x * y)
    }
}

/// Added mass falls to nothing at the bow and to that of the skeg at the stern.
fn section(index: usize, length_m: f64, midship: f64, form: &Form) -> Section {
    let xi = (2.0 * index as f64 + 1.0) / SECTIONS as f64 - 1.0;
    let (power, fall) = if xi > 0.0 { (form.bow, 1.0) } else { (2.0, 1.0 - form.stern) };
    let size = xi.abs();
    Section {
        x_m: 0.5 * length_m * xi,
        added: midship * (1.0 - fall * size.powf(power)),
        slope: -xi.signum() * midship * fall * power * size.powf(power - 1.0) * 2.0 / length_m,
        drag: form.drag[0] * (1.0 + form.drag[1] * size * size),
    }
}
