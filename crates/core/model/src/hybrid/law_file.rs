//! The derived law as a file: forces from the terms, the rest from the equations of motion
//! (Miyauchi 2024, Eq. 1).

use std::collections::BTreeMap;

use indexmap::IndexMap;

use super::actuators::{ActuatorInput, ExpansionVariable, VariableUnit};
use super::file::{HybridFile, Scaling};
use super::rules::{HYBRID_AXES, HybridTerm};
use crate::coefficient::Axis;
use crate::law::{AxisFile, InputFile, LawFile, LawKind, ParameterFile, SubmodelFile, TermFile};
use crate::source::Source;

/// Writer of the derived law.
pub struct LawWriter<'a> {
    pub file: &'a HybridFile,
    pub inputs: &'a [ActuatorInput],
    pub variables: &'a [ExpansionVariable],
    pub terms: &'a [Vec<HybridTerm>; 3],
    pub submodels: IndexMap<String, SubmodelFile>,
}

impl LawWriter<'_> {
    pub fn write_law(self) -> LawFile {
        let inertia = InertiaFormulas::from_scaling(self.file.scaling);
        let input = |input: &ActuatorInput| {
            (
                input.name.clone(),
                InputFile { unit: input.unit.into(), default: None, helm: side_helm(&input.name) },
            )
        };
        let mirror = |input: &ActuatorInput| Some((input.name.clone(), input.mirror.clone()?));
        let factor =
            |place: usize| (self.variables[place].symbol.clone(), self.formula_name(place));
        LawFile {
            kind: LawKind::Law,
            name: self.file.name.clone(),
            title: self.file.title.clone(),
            sources: self.list_sources(),
            inputs: self.inputs.iter().map(input).collect(),
            parameters: inertia.parameter_files(),
            values: self.list_values(),
            factors: (0..self.variables.len()).map(factor).collect(),
            axes: HYBRID_AXES
                .into_iter()
                .zip(self.terms)
                .map(|(axis, terms)| (axis, self.axis_file(axis, terms, &inertia)))
                .collect(),
            mass: inertia.mass_matrix(),
            kinematics: BTreeMap::new(),
            typical: Default::default(),
            mirrors: self.inputs.iter().filter_map(mirror).collect(),
            submodels: self.submodels,
        }
    }

    fn list_sources(&self) -> BTreeMap<String, Source> {
        let citation = "Miyauchi, Y., Akimoto, Y. and Maki, A. (2024). Development of a \
                        mathematical model for harbor maneuvers to realize modeling automation. J \
                        Mar Sci Technol 29, 975-999, sec. 2.2";
        let hybrid = Source { citation: citation.into(), doi: None, note: None };
        let mut sources = self.file.sources.clone();
        // A declaration may list this publication itself.
        sources.entry("miyauchi-2024".into()).or_insert(hybrid);
        sources
    }

    fn is_scaled(&self, variable: &ExpansionVariable) -> bool {
        self.file.scaling == Scaling::Bis && variable.unit != VariableUnit::Number
    }

    /// Name of a variable in formulas.
    fn formula_name(&self, place: usize) -> String {
        let variable = &self.variables[place];
        if self.is_scaled(variable) {
            format!("{}_bis", variable.symbol)
        } else {
            variable.symbol.clone()
        }
    }

    fn list_values(&self) -> IndexMap<String, String> {
        let mut values = IndexMap::new();
        // Units of the bis system: sqrt(g L) for speed, sqrt(L / g) for time.
        if self.file.scaling == Scaling::Bis {
            values.insert("speed_unit".to_owned(), "sqrt(g*lpp_m)".to_owned());
            values.insert("time_unit".to_owned(), "sqrt(lpp_m/g)".to_owned());
        }
        for (place, variable) in self.variables.iter().enumerate() {
            let formula = match variable.unit {
                VariableUnit::Speed if self.is_scaled(variable) => {
                    format!("{}/speed_unit", variable.formula)
                }
                VariableUnit::Rate if self.is_scaled(variable) => {
                    format!("{}*time_unit", variable.formula)
                }
                _ => variable.formula.clone(),
            };
            // A variable that equals its symbol needs no value.
            if formula != variable.symbol {
                values.insert(self.formula_name(place), formula);
            }
        }
        values
    }

    fn axis_file(&self, axis: Axis, terms: &[HybridTerm], inertia: &InertiaFormulas) -> AxisFile {
        AxisFile {
            scale: inertia.axis_scale(axis),
            terms: terms.iter().map(|term| self.term_file(axis, term)).collect(),
            rest: Some(inertia.centripetal_terms(axis)),
            open: false,
        }
    }

    fn term_file(&self, axis: Axis, term: &HybridTerm) -> TermFile {
        let name = term.monomial.coefficient_name(axis, self.variables);
        let formula = |monomial: &super::monomial::Monomial| {
            monomial.to_formula(&|place| self.formula_name(place))
        };
        match &term.image {
            // The constant term has no factors in its name, so that its formula is written out.
            None if term.monomial.degree() == 0 => {
                TermFile::Formula(BTreeMap::from([(name, "1".into())]))
            }
            None => TermFile::Name(name),
            Some((image, subtracted)) => {
                // Mirror images with opposite effect on the axis are subtracted.
                let sign = if *subtracted { '-' } else { '+' };
                TermFile::Formula(BTreeMap::from([(
                    name,
                    format!("{} {sign} {}", formula(&term.monomial), formula(image)),
                )]))
            }
        }
    }
}

/// Inertial side of Eq. 1 in one scaling.
struct InertiaFormulas {
    scaling: Scaling,
    /// Mass with the added mass in surge and in sway, kg.
    surge: &'static str,
    sway: &'static str,
    /// Moment of inertia with added moment about midship, kg m2.
    yaw: &'static str,
    /// Static moment about midship, kg m.
    moment: &'static str,
}

impl InertiaFormulas {
    fn from_scaling(scaling: Scaling) -> Self {
        match scaling {
            // In the bis system parameters are divided by mass and length.
            Scaling::Bis => Self {
                scaling,
                surge: "m*(1 + m_x)",
                sway: "m*(1 + m_y)",
                yaw: "m*lpp_m^2*(I_zz_plus_J_zz + x_G^2)",
                moment: "m*lpp_m*x_G",
            },
            Scaling::Dimensional => Self {
                scaling,
                surge: "(m + m_x)",
                sway: "(m + m_y)",
                yaw: "(I_zz_plus_J_zz + m*x_G^2)",
                moment: "m*x_G",
            },
        }
    }

    fn parameter_files(&self) -> IndexMap<String, ParameterFile> {
        let bis = self.scaling == Scaling::Bis;
        let one = |name: &str, unit: &str, of: &str, by: &str, from: Option<&str>| {
            let meaning =
                if bis && !by.is_empty() { format!("{of} by {by}") } else { of.to_owned() };
            let unit = if bis && !by.is_empty() { "1" } else { unit };
            let from = from.map(str::to_owned);
            (
                name.to_owned(),
                ParameterFile { unit: unit.into(), meaning, from, role: None, prior: None },
            )
        };
        let x_g = if bis { "x_g_m/lpp_m" } else { "x_g_m" };
        IndexMap::from([
            one("m", "kg", "mass", "", Some("mass_kg")),
            one("x_G", "m", "centre of gravity forward of midship", "L", Some(x_g)),
            one("m_x", "kg", "added mass in surge", "m", None),
            one("m_y", "kg", "added mass in sway", "m", None),
            one(
                "I_zz_plus_J_zz",
                "kg m2",
                "yaw moment of inertia about the centre of gravity with the added one",
                "m L^2",
                None,
            ),
        ])
    }

    fn axis_scale(&self, axis: Axis) -> Option<String> {
        let bis = if axis == Axis::N { "m*g*lpp_m" } else { "m*g" };
        (self.scaling == Scaling::Bis).then(|| bis.to_owned())
    }

    /// Products of velocities that remain on the right-hand side of Eq. 1.
    fn centripetal_terms(&self, axis: Axis) -> String {
        match axis {
            Axis::X => format!("{}*v*r + {}*r^2", self.sway, self.moment),
            Axis::Y => format!("-{}*u*r", self.surge),
            Axis::K | Axis::N => format!("-{}*u*r", self.moment),
        }
    }

    fn mass_matrix(&self) -> BTreeMap<Axis, BTreeMap<Axis, String>> {
        let row = |entries: &[(Axis, &str)]| {
            entries.iter().map(|(axis, formula)| (*axis, (*formula).to_owned())).collect()
        };
        BTreeMap::from([
            (Axis::X, row(&[(Axis::X, self.surge)])),
            (Axis::Y, row(&[(Axis::Y, self.sway), (Axis::N, self.moment)])),
            (Axis::N, row(&[(Axis::Y, self.moment), (Axis::N, self.yaw)])),
        ])
    }
}

/// Formula of an actuator of one side that follows the same order as that of the other.
fn side_helm(name: &str) -> Option<String> {
    let of_pair = name.strip_suffix("_s").or_else(|| name.strip_suffix("_p"))?;
    ["delta", "n"].contains(&of_pair).then(|| of_pair.to_owned())
}
