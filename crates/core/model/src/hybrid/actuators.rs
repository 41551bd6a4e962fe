//! Inputs of the law and variables of the expansion for the declared actuators: Miyauchi 2024, Eqs.
//! 5 and 6.

use super::file::{ActuatorFile, ActuatorKind, AngleFeature, Coupling, HybridFile, Symmetry};
use crate::coefficient::{Axis, STANDARD_FACTORS};
use crate::law::STATES;

/// Variable of the expansion.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Symbol in the names of coefficients.
    pub symbol: String,
    /// Formula of its value, SI.
    pub formula: String,
    /// Unit by which it is divided to be a pure number.
    pub unit: Unit,
    /// True if it changes sign in the mirror.
    pub odd: bool,
    /// True for a sine or a cosine.
    pub trigonometric: bool,
    /// Actuator to which it belongs, and its couplings; `None` for the ship's motion.
    pub actuator: Option<Reach>,
    /// Symbol of the variable with which it exchanges places in the mirror; its own if it has no
    /// twin.
    pub twin: String,
}

/// Unit of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// A pure number.
    Number,
    /// A velocity.
    Speed,
    /// A rate.
    Rate,
}

/// Couplings of an actuator.
#[derive(Debug, Clone, PartialEq)]
pub struct Reach {
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
pub fn inputs_and_variables(file: &HybridFile) -> (Vec<ActuatorInput>, Vec<Variable>) {
    let mut inputs = Vec::new();
    let mut variables = motion();
    for (name, actuator) in &file.actuators {
        for side in sides(actuator) {
            let one =
                One { name, side, actuator, exchanges: file.rules.symmetry == Symmetry::Mirror };
            inputs.extend(one.inputs());
            variables.extend(one.variables());
        }
    }
    let rank = |v: &Variable| {
        STANDARD_FACTORS.iter().position(|f| *f == v.symbol).unwrap_or(STANDARD_FACTORS.len())
    };
    variables.sort_by_key(rank);
    (inputs, variables)
}

/// Returns the suffixes of the sides on which an actuator has a twin.
pub fn sides(actuator: &ActuatorFile) -> &'static [&'static str] {
    if actuator.pair || actuator.kind == ActuatorKind::Vectwin { &["_s", "_p"] } else { &[""] }
}

fn motion() -> Vec<Variable> {
    let one = |symbol: &str, unit, odd| Variable {
        symbol: symbol.into(),
        formula: symbol.into(),
        unit,
        odd,
        trigonometric: false,
        actuator: None,
        twin: symbol.into(),
    };
    vec![one("u", Unit::Speed, false), one("v", Unit::Speed, true), one("r", Unit::Rate, true)]
}

/// One actuator, or one side of a pair.
struct One<'a> {
    name: &'a str,
    side: &'a str,
    actuator: &'a ActuatorFile,
    exchanges: bool,
}

impl One<'_> {
    /// Returns its input with a prefix, and the input that it becomes in the mirror.
    fn input(&self, prefix: &str) -> (String, String) {
        let other = match self.side {
            "_s" => "_p",
            "_p" => "_s",
            alone => alone,
        };
        (format!("{prefix}{}{}", self.name, self.side), format!("{prefix}{}{other}", self.name))
    }

    fn inputs(&self) -> Vec<ActuatorInput> {
        let revolutions = |prefix: &str, odd| self.declared(prefix, "rps", odd);
        match self.actuator.kind {
            ActuatorKind::Propeller => vec![revolutions("", false)],
            ActuatorKind::TunnelThruster => vec![revolutions("", true)],
            ActuatorKind::Rudder | ActuatorKind::Vectwin => vec![self.declared("", "rad", true)],
            ActuatorKind::Azimuth => vec![revolutions("n_", false), self.declared("", "rad", true)],
        }
    }

    fn declared(&self, prefix: &str, unit: &'static str, odd: bool) -> ActuatorInput {
        let (name, other) = self.input(prefix);
        let known = STATES.iter().any(|(state, _)| *state == name) || name == "delta";
        let becomes = if self.exchanges { other } else { name.clone() };
        // One mirror entry serves both sides of a pair.
        let says = !known && (odd || becomes != name) && !(self.exchanges && self.side == "_p");
        let mirror = says.then(|| format!("{}{becomes}", if odd { "-" } else { "" }));
        ActuatorInput { name, unit, mirror }
    }

    fn variables(&self) -> Vec<Variable> {
        let revolutions = |prefix: &str, odd| {
            self.variable("", prefix, Unit::Rate, odd, |input| input.to_owned())
        };
        match self.actuator.kind {
            ActuatorKind::Propeller => vec![revolutions("", false)],
            ActuatorKind::TunnelThruster => vec![revolutions("", true)],
            ActuatorKind::Rudder | ActuatorKind::Vectwin => self.angle(),
            ActuatorKind::Azimuth => {
                std::iter::once(revolutions("n_", false)).chain(self.angle()).collect()
            }
        }
    }

    fn angle(&self) -> Vec<Variable> {
        let trigonometric = |function: &str, odd, formula: fn(&str) -> String| {
            let variable = self.variable(function, "", Unit::Number, odd, formula);
            Variable { trigonometric: true, ..variable }
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
                vec![self.variable("", "", Unit::Number, true, |input| input.to_owned())]
            }
        }
    }

    fn variable(
        &self,
        function: &str,
        prefix: &str,
        unit: Unit,
        odd: bool,
        formula: impl Fn(&str) -> String,
    ) -> Variable {
        let (name, other) = self.input(prefix);
        let ActuatorFile { couples, axes, .. } = self.actuator;
        Variable {
            symbol: format!("{function}{name}"),
            formula: formula(&name),
            unit,
            odd,
            trigonometric: false,
            actuator: Some(Reach { name: self.name.into(), couples: *couples, axes: axes.clone() }),
            twin: format!("{function}{other}"),
        }
    }
}
