//! Export as one file of Python: the equations with plain floats, and numpy for the results of a
//! simulation.

use sistership_formula::Function;

use crate::coefficients::ExportCoefficient;
use crate::error::ExportError;
use crate::export_plan::ExportPlan;
use crate::expression::{TargetLanguage, function_name};
use crate::external_input::ExternalInput;
use crate::format::ModelFormat;
use crate::states::STATES;
use crate::{header, line_wrapping, range, rates};

/// Module for Python 3.8 and later.
#[derive(Debug)]
pub struct PythonFormat;

impl ModelFormat for PythonFormat {
    fn name(&self) -> &'static str {
        "python"
    }

    fn extension(&self) -> &'static str {
        "py"
    }

    fn write(&self, plan: &ExportPlan) -> Result<Vec<u8>, ExportError> {
        Ok(source_text(plan).into_bytes())
    }
}

impl TargetLanguage for PythonFormat {
    fn number_literal(&self, value: f64) -> String {
        if value.is_infinite() {
            return if value > 0.0 { "math.inf" } else { "(-math.inf)" }.to_owned();
        }
        if value < 0.0 { format!("({value:?})") } else { format!("{value:?}") }
    }

    fn state_name(&self, place: usize) -> String {
        STATES[place].0.to_owned()
    }

    fn input_name(&self, outside: &ExternalInput) -> String {
        outside.identifier.clone()
    }

    fn coefficient_name(&self, coefficient: &ExportCoefficient) -> String {
        coefficient.identifier.clone()
    }

    /// Quotient. Python raises an error where other languages give an infinity; a non-zero number
    /// as divisor is safe.
    fn write_quotient(&self, a: &str, b: &str) -> String {
        // Negative literals are in brackets.
        let safe = b.trim_matches(['(', ')']).parse::<f64>().is_ok_and(|number| number != 0.0);
        if safe { format!("{a}/{b}") } else { format!("_quotient({a}, {b})") }
    }

    fn write_power(&self, a: &str, b: &str) -> String {
        format!("_safe(math.pow, {a}, {b})")
    }

    fn write_call(&self, of: Function, arguments: &[&str]) -> String {
        let all = arguments.join(", ");
        match of {
            Function::Abs | Function::Min | Function::Max => {
                format!("{}({all})", function_name(of))
            }
            Function::Sign => format!("float(({all} > 0.0) - ({all} < 0.0))"),
            // These raise an error outside their domain, where other languages return NaN or
            // infinity.
            Function::Sqrt | Function::Log | Function::Exp => {
                format!("_safe(math.{}, {all})", function_name(of))
            }
            other => format!("math.{}({all})", function_name(other)),
        }
    }

    fn write_conditional(&self, comparison: &str, [a, b, c, d]: [&str; 4]) -> String {
        format!("{c} if {a} {comparison} {b} else {d}")
    }

    fn write_assignment(&self, name: &str, terms: &[String]) -> String {
        let one = line_wrapping::wrap_sum(&format!("    {name} = "), terms, "");
        // Brackets are only needed to continue a line.
        if one.len() <= 96 {
            return one;
        }
        line_wrapping::wrap_sum(&format!("    {name} = ("), terms, "\n       ") + ")"
    }

    fn write_solution(&self, mass: &[[String; 4]; 4], forces: &[String; 4]) -> Vec<String> {
        let row = |(mass, force): (&[String; 4], &String)| {
            format!("        [{}, {force}],", mass.join(", "))
        };
        let rows: Vec<String> = mass.iter().zip(forces).map(row).collect();
        vec![format!("    a_u, a_v, a_p, a_r = _solve([\n{}\n    ])", rows.join("\n"))]
    }

    fn rate_target(&self, place: usize) -> String {
        format!("{}_dot", STATES[place].0)
    }
}

const TEMPLATE: &str = include_str!("../templates/model.py");

/// Complete module.
fn source_text(plan: &ExportPlan) -> String {
    let lines = header::header_lines(plan);
    let lines: Vec<String> = lines
        .iter()
        .flat_map(|line| line_wrapping::wrap_comment("#", line))
        .map(|l| l.trim_end().to_owned())
        .collect();
    let body = TEMPLATE
        .replace("@@coefficients", &coefficient_entries(plan))
        .replace("@@inputs", &input_entries(plan))
        .replace("@@unpack", &unpack_statements(plan))
        .replace("@@statements", &rates::rate_statements(plan, &PythonFormat).join("\n"))
        .replace("@@rudder", &rudder_statements(plan))
        .replace("@@range", &range_function(plan))
        .replace(
            "@@order",
            if plan.gear.is_some() { "delta_order=math.radians(rudder_deg)" } else { "" },
        )
        .replace("@@speed_m_s", &format!("{:?}", plan.speed_m_s))
        .replace("@@most_speed", &format!("{:?}", plan.envelope.speed_m_s()))
        .replace("@@most_yaw", &format!("{:?}", plan.envelope.yaw_rate_rad_s()))
        .replace("@@most_roll", &format!("{:?}", plan.envelope.roll_rad()))
        .replace("@@duration", &format!("{:?}", (60.0 * plan.lpp_m / plan.speed_m_s).ceil()))
        .replace("@@step", &format!("{:?}", plan.step_s()));
    format!("{}\n{body}", lines.join("\n"))
}

/// Function of the distance outside the range covered by trials.
fn range_function(plan: &ExportPlan) -> String {
    let Some(range::RangeDistance { statements, result }) =
        range::standalone_distance(plan, &PythonFormat)
    else {
        return String::new();
    };
    let meaning = line_wrapping::wrap_comment("    #", range::MEANING).join("\n");
    format!(
        "def {name}(state, inputs=INPUTS, coefficients=COEFFICIENTS):\n{meaning}\n    \
         u, v, r, p, phi, psi, x, y, delta = state\n{unpack}\n{statements}\n    \
         return {result}\n\n\n",
        name = range::NAME,
        unpack = unpack_statements(plan),
        statements = statements.join("\n")
    )
}

fn coefficient_entries(plan: &ExportPlan) -> String {
    let one = |c: &ExportCoefficient| {
        format!("    \"{}\": {:?},  # {}\n", c.identifier, c.value, header::coefficient_remark(c))
    };
    plan.coefficients.iter().map(one).collect()
}

fn input_entries(plan: &ExportPlan) -> String {
    let one = |o: &ExternalInput| {
        format!(
            "    \"{}\": {},  # {}, {}\n",
            o.identifier,
            PythonFormat.number_literal(o.default),
            o.meaning,
            o.unit
        )
    };
    let order = plan.gear.map(|_| "    \"delta_order\": 0.0,  # ordered rudder, rad\n".to_owned());
    order.into_iter().chain(plan.outside.iter().map(one)).collect()
}

fn unpack_statements(plan: &ExportPlan) -> String {
    let from = |what: &str, name: &str| format!("    {name} = {what}[\"{name}\"]");
    let order = plan.gear.map(|_| from("inputs", "delta_order"));
    let outside = plan.outside.iter().map(|o| from("inputs", &o.identifier));
    let coefficients = plan.coefficients.iter().map(|c| from("coefficients", &c.identifier));
    order.into_iter().chain(outside).chain(coefficients).collect::<Vec<_>>().join("\n")
}

fn rudder_statements(plan: &ExportPlan) -> String {
    let Some(gear) = &plan.gear else { return "    delta_dot = 0.0".to_owned() };
    let band = match plan.band_rad {
        0.0 => String::new(),
        band => format!("    order = min(max(delta, order - {band:?}), order + {band:?})\n"),
    };
    format!(
        "    limit, fastest = {:?}, {:?}\n    order = min(max(delta_order, -limit), limit)\n{band}\
         \u{20}   delta_dot = min(max((order - delta)/max({:?}, step_s), -fastest), fastest)",
        gear.limit_rad(),
        gear.rate_rad_s(),
        gear.time_constant_s()
    )
}
