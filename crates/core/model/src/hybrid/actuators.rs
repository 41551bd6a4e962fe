//! From actuators to the inputs of the law and the variables of the expansion: Miyauchi 2024, Eqs.
//! 5 and 6.

use super::file::{ActuatorFile, ActuatorKind, AngleFeature, Coupling, HybridFile, Symmetry};
use crate::coefficient::{Axis, STANDARD_FACTORS};
use crate::law::STATES;

/// A variable of the expansion.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// How a coefficient's name spells it.
    pub symbol: String,
    /// What it is, in SI.
    pub formula: String,
    /// What makes it a pure number; nothing where it is one.
    pub unit: Unit,
    /// Whether it changes sign in the mirror.
    pub odd: bool,
    /// Whether it is a sine or a cosine.
    pub trigonometric: bool,
    /// The actuator it belongs to, and how far that reaches; none for the ship's motion.
    pub actuator: Option<Reach>,
    /// The symbol it exchanges places with in the mirror; its own where it stands alone.
    pub twin: String,
}

/// What makes a variable a pure number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// It is one.
    Number,
    /// A velocity.
    Speed,
    /// A rate.
    Rate,
}

/// An actuator as its variables know it.
#[derive(Debug, Clone, PartialEq)]
pub struct Reach {
    /// Its name.
    pub name: String,
    /// With what its terms are multiplied.
    pub couples: Coupling,
    /// Axes on which it acts; all of them where absent.
    pub axes: Option<Vec<Axis>>,
}

/// An input of the law.
#[derive(Debug, Clone, PartialEq)]
pub struct ActuatorInput {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// What it becomes in the mirror; nothing for what every law knows.
    pub mirror: Option<String>,
}

/// The inputs in their order, and the variables in the order of coefficients' names.
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

/// Suffixes of the sides on which an actuator has a twin.
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
    /// The input it has with a prefix, and the one it becomes in the mirror.
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
        // One entry serves both sides of a pair.
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
