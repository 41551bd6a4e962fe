//! Export as a Modelica model.

use sistership_formula::Function;

use crate::error::ExportError;
use crate::expression::{Language, function};
use crate::format::Format;
use crate::outside::Outside;
use crate::plan::{Coefficient, Plan, STATES};
use crate::{header, range, rates, wrapped};

/// Model file for Modelica 3.4, without any library.
#[derive(Debug)]
pub struct Modelica;

impl Format for Modelica {
    fn name(&self) -> &'static str {
        "modelica"
    }

    fn extension(&self) -> &'static str {
        "mo"
    }

    fn write(&self, plan: &Plan) -> Result<Vec<u8>, ExportError> {
        Ok(text(plan).into_bytes())
    }
}

/// Depth of deep water, m, as Modelica has no infinity.
const DEEP_M: f64 = 1e9;

impl Language for Modelica {
    fn number(&self, value: f64) -> String {
        // Infinity becomes the largest double.
        let value = value.clamp(-f64::MAX, f64::MAX);
        if value < 0.0 { format!("({value:?})") } else { format!("{value:?}") }
    }

    fn state(&self, place: usize) -> String {
        STATES[place].0.to_owned()
    }

    fn outside(&self, outside: &Outside) -> String {
        outside.identifier.clone()
    }

    fn coefficient(&self, coefficient: &Coefficient) -> String {
        coefficient.identifier.clone()
    }

    fn power(&self, a: &str, b: &str) -> String {
        format!("{a}^{b}")
    }

    /// Call of a function. Minimum, maximum and sign are written as conditional expressions, which
    /// every tool supports.
    fn call(&self, of: Function, arguments: &[&str]) -> String {
        match (of, arguments) {
            (Function::Sign, [a]) => {
                format!("if {a} > 0.0 then 1.0 elseif {a} < 0.0 then -1.0 else 0.0")
            }
            (Function::Min, [a, b]) => self.choice("<", [a, b, a, b]),
            (Function::Max, [a, b]) => self.choice(">", [a, b, a, b]),
            _ => format!("{}({})", function(of), arguments.join(", ")),
        }
    }

    /// Conditional expression without events: the compared values change smoothly at the switch.
    fn choice(&self, comparison: &str, [a, b, c, d]: [&str; 4]) -> String {
        format!("if noEvent({a} {comparison} {b}) then {c} else {d}")
    }

    fn assign(&self, name: &str, terms: &[String]) -> String {
        wrapped::sum(&format!("  {name} = "), terms, "\n     ") + ";"
    }

    fn solve(&self, mass: &[[String; 4]; 4], forces: &[String; 4]) -> Vec<String> {
        let unknown = ["a_u", "a_v", "a_p", "a_r"];
        let row = |(mass, force): (&[String; 4], &String)| {
            let terms: Vec<String> =
                mass.iter().zip(unknown).map(|(factor, name)| format!("{factor}*{name}")).collect();
            // Implicit equations F = M a; the tool solves them.
            self.assign(force, &terms)
        };
        mass.iter().zip(forces).map(row).collect()
    }

    fn rate(&self, place: usize) -> String {
        format!("der({})", STATES[place].0)
    }
}

/// Complete model file.
fn text(plan: &Plan) -> String {
    let comment: Vec<String> =
        header::lines(plan).iter().flat_map(|line| wrapped::comment("  //", line)).collect();
    let parts = [
        format!("model {} \"Ship manoeuvring model {}\"", plan.identifier, plan.name),
        comment.iter().map(|line| line.trim_end()).collect::<Vec<_>>().join("\n"),
        inputs(plan),
        parameters(plan),
        states(plan),
        output(plan),
        format!("protected\n{}", locals(plan)),
        "equation".to_owned(),
        rates::statements(plan, &Modelica).join("\n"),
        rudder(plan),
        range_equation(plan),
        format!("end {};\n", plan.identifier),
    ];
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("\n")
}

fn inputs(plan: &Plan) -> String {
    let one = |name: &str, unit: &str, start: f64, meaning: &str| {
        format!("  input Real {name}(unit = \"{unit}\", start = {start:?}) \"{meaning}\";")
    };
    let order = plan.gear.map(|_| one("delta_order", "rad", 0.0, "ordered rudder"));
    let outside = plan.outside.iter();
    let outside = outside.map(|o| one(&o.identifier, &o.unit, o.default.min(DEEP_M), &o.meaning));
    order.into_iter().chain(outside).collect::<Vec<_>>().join("\n")
}

fn parameters(plan: &Plan) -> String {
    let one = |c: &Coefficient| {
        let remark = header::remark(c).replace('"', "'");
        format!("  parameter Real {} = {:?} \"{remark}\";", c.identifier, c.value)
    };
    plan.coefficients.iter().map(one).collect::<Vec<_>>().join("\n")
}

fn states(plan: &Plan) -> String {
    let one = |(place, (name, unit, meaning)): (usize, (&str, &str, &str))| {
        let start = if place == 0 { plan.speed_m_s } else { 0.0 };
        format!("  Real {name}(unit = \"{unit}\", start = {start:?}, fixed = true) \"{meaning}\";")
    };
    STATES.into_iter().enumerate().map(one).collect::<Vec<_>>().join("\n")
}

fn output(plan: &Plan) -> String {
    let known = plan.listed().distance;
    known.map_or(String::new(), |_| {
        format!("  output Real {}(unit = \"1\") \"{}\";", range::NAME, range::MEANING)
    })
}

fn range_equation(plan: &Plan) -> String {
    let Some(range::Distance { mut statements, result }) = range::beside(plan, &Modelica) else {
        return String::new();
    };
    statements.push(format!("  {} = {result};", range::NAME));
    statements.join("\n")
}

/// Declarations of all names that an equation defines.
fn locals(plan: &Plan) -> String {
    let listed = plan.listed();
    let slots = 0..listed.tape.len() as u32;
    let mut names: Vec<String> = slots
        .filter(|slot| crate::expression::terms(plan, &Modelica, *slot).is_some())
        .map(|slot| format!("t{slot}"))
        .collect();
    if listed.mobility.is_none() {
        names.extend(["a_u", "a_v", "a_p", "a_r"].map(str::to_owned));
    }
    names
        .chunks(12)
        .map(|some| format!("  Real {};", some.join(", ")))
        .collect::<Vec<_>>()
        .join("\n")
}

/// Equation of the steering gear. A gear without time constant gets that of the simulation's step,
/// within which it reaches its order.
fn rudder(plan: &Plan) -> String {
    let Some(gear) = &plan.gear else { return "  der(delta) = 0.0;".to_owned() };
    let (limit, fastest) = (gear.limit_rad(), gear.rate_rad_s());
    let time = gear.time_constant_s().max(plan.step_s());
    let ordered = format!("max(-{limit:?}, min({limit:?}, delta_order))");
    let order = match plan.band_rad {
        0.0 => ordered,
        band => format!("min(max(delta, {ordered} - {band:?}), {ordered} + {band:?})"),
    };
    format!("  der(delta) = max(-{fastest:?}, min({fastest:?}, ({order} - delta)/{time:?}));")
}
