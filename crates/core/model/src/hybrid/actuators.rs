//! Inputs of the law and variables of the expansion for the declared actuators: Miyauchi 2024, Eqs.
//! 5 and 6.

use super::file::{ActuatorFile, ActuatorKind, AngleFeature, Coupling, HybridFile, Symmetry};
use crate::coefficient::{Axis, STANDARD_FACTORS};
use crate::law::STATES;

/// Variable of the expansion.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpansionVariable {
    /// Symbol in the names of coefficients.
    pub symbol: String,
    /// Formula of its value, SI.
    pub formula: String,
    /// Unit by which it is divided to be a pure number.
    pub unit: VariableUnit,
    /// True if it changes sign in the mirror.
    pub odd: bool,
    /// True for a sine or a cosine.
    pub trigonometric: bool,
    /// Actuator to which it belongs, and its couplings; `None` for the ship's motion.
    pub actuator: Option<ActuatorReach>,
    /// Symbol of the variable with which it exchanges places in the mirror; its own if it has no
    /// twin.
    pub twin: String,
}

/// Unit of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VariableUnit {
    /// A pure number.
    Number,
    /// A velocity.
    Speed,
    /// A rate.
    Rate,
}

/// Couplings of an actuator.
#[derive(Debug, Clone, PartialEq)]
pub struct ActuatorReach {
    /// Its name.
    pub name: String,
    /// Variables by which its terms are multiplied.
    pub couples: Coupling,
    /// Axes on which it acts; default: all.
    pub axes: Option<Vec<Axis>>,
}

/// Input of the law.
#[derive(Debug, Clone, PartialEq)]
pub struct ActuatorInput {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// Its transformation in the mirror; `None` for an input that every law has.
    pub mirror: Option<String>,
}

/// Returns the inputs in order, and the variables in the order of coefficients' names.
pub fn inputs_and_variables(file: &HybridFile) -> (Vec<ActuatorInput>, Vec<ExpansionVariable>) {
    let mut inputs = Vec::new();
    let mut variables = motion_variables();
    for (name, actuator) in &file.actuators {
        for side in side_suffixes(actuator) {
            let one = ActuatorSide {
                name,
                side,
                actuator,
                exchanges: file.rules.symmetry == Symmetry::Mirror,
            };
            inputs.extend(one.list_inputs());
            variables.extend(one.list_variables());
        }
    }
    let rank = |v: &ExpansionVariable| {
        STANDARD_FACTORS.iter().position(|f| *f == v.symbol).unwrap_or(STANDARD_FACTORS.len())
    };
    variables.sort_by_key(rank);
    (inputs, variables)
}

/// Returns the suffixes of the sides on which an actuator has a twin.
pub fn side_suffixes(actuator: &ActuatorFile) -> &'static [&'static str] {
    if actuator.pair || actuator.kind == ActuatorKind::Vectwin { &["_s", "_p"] } else { &[""] }
}

fn motion_variables() -> Vec<ExpansionVariable> {
    let one = |symbol: &str, unit, odd| ExpansionVariable {
        symbol: symbol.into(),
        formula: symbol.into(),
        unit,
        odd,
        trigonometric: false,
        actuator: None,
        twin: symbol.into(),
    };
    vec![
        one("u", VariableUnit::Speed, false),
        one("v", VariableUnit::Speed, true),
        one("r", VariableUnit::Rate, true),
    ]
}

/// One actuator, or one side of a pair.
struct ActuatorSide<'a> {
    name: &'a str,
    side: &'a str,
    actuator: &'a ActuatorFile,
    exchanges: bool,
}

impl ActuatorSide<'_> {
    /// Returns its input with a prefix, and the input that it becomes in the mirror.
    fn input_names(&self, prefix: &str) -> (String, String) {
        let other = match self.side {
            "_s" => "_p",
            "_p" => "_s",
            alone => alone,
        };
        (format!("{prefix}{}{}", self.name, self.side), format!("{prefix}{}{other}", self.name))
    }

    fn list_inputs(&self) -> Vec<ActuatorInput> {
        let revolutions = |prefix: &str, odd| self.declare_input(prefix, "rps", odd);
        match self.actuator.kind {
            ActuatorKind::Propeller => vec![revolutions("", false)],
            ActuatorKind::TunnelThruster => vec![revolutions("", true)],
            ActuatorKind::Rudder | ActuatorKind::Vectwin => {
                vec![self.declare_input("", "rad", true)]
            }
            ActuatorKind::Azimuth => {
                vec![revolutions("n_", false), self.declare_input("", "rad", true)]
            }
        }
    }

    fn declare_input(&self, prefix: &str, unit: &'static str, odd: bool) -> ActuatorInput {
        let (name, other) = self.input_names(prefix);
        let known = STATES.iter().any(|(state, _)| *state == name) || name == "delta";
        let becomes = if self.exchanges { other } else { name.clone() };
        // One mirror entry serves both sides of a pair.
        let says = !known && (odd || becomes != name) && !(self.exchanges && self.side == "_p");
        let mirror = says.then(|| format!("{}{becomes}", if odd { "-" } else { "" }));
        ActuatorInput { name, unit, mirror }
    }

    fn list_variables(&self) -> Vec<ExpansionVariable> {
        let revolutions = |prefix: &str, odd| {
            self.build_variable("", prefix, VariableUnit::Rate, odd, |input| input.to_owned())
        };
        match self.actuator.kind {
            ActuatorKind::Propeller => vec![revolutions("", false)],
            ActuatorKind::TunnelThruster => vec![revolutions("", true)],
            ActuatorKind::Rudder | ActuatorKind::Vectwin => self.angle_variables(),
            ActuatorKind::Azimuth => {
                std::iter::once(revolutions("n_", false)).chain(self.angle_variables()).collect()
            }
        }
    }

    fn angle_variables(&self) -> Vec<ExpansionVariable> {
        let trigonometric = |function: &str, odd, formula: fn(&str) -> String| {
            let variable = self.build_variable(function, "", VariableUnit::Number, odd, formula);
            ExpansionVariable { trigonometric: true, ..variable }
        };
        let sine = trigonometric("sin", true, |input| format!("sin({input})"));
        match self.actuator.angle {
            AngleFeature::SineCosine => {
                vec![sine, trigonometric("cos", false, |input| format!("cos({input})"))]
            }
            AngleFeature::SineVersine => {
                vec![sine, trigonometric("cos", false, |input| format!("1 - cos({input})"))]
            }
            AngleFeature::Plain => {
                vec![
                    self.build_variable("", "", VariableUnit::Number, true, |input| {
                        input.to_owned()
                    }),
                ]
            }
        }
    }

    fn build_variable(
        &self,
        function: &str,
        prefix: &str,
        unit: VariableUnit,
        odd: bool,
        formula: impl Fn(&str) -> String,
    ) -> ExpansionVariable {
        let (name, other) = self.input_names(prefix);
        let ActuatorFile { couples, axes, .. } = self.actuator;
        ExpansionVariable {
            symbol: format!("{function}{name}"),
            formula: formula(&name),
            unit,
            odd,
            trigonometric: false,
            actuator: Some(ActuatorReach {
                name: self.name.into(),
                couples: *couples,
                axes: axes.clone(),
            }),
            twin: format!("{function}{other}"),
        }
    }
}
