//! Export as one function of MATLAB (and Octave) in the style of the Marine Systems Simulator: a
//! structure of the model, and the rates of the states.

use sistership_formula::Function;

use crate::coefficients::ExportCoefficient;
use crate::error::ExportError;
use crate::export_plan::ExportPlan;
use crate::expression::{TargetLanguage, function_name};
use crate::external_input::ExternalInput;
use crate::format::ModelFormat;
use crate::quoting::escape_matlab;
use crate::states::STATES;
use crate::{header, line_wrapping, range, rates};

/// Function file for MATLAB R2016b and later, Octave 6 and later.
#[derive(Debug)]
pub struct MatlabFormat;

impl ModelFormat for MatlabFormat {
    fn name(&self) -> &'static str {
        "matlab"
    }

    fn extension(&self) -> &'static str {
        "m"
    }

    fn write(&self, plan: &ExportPlan) -> Result<Vec<u8>, ExportError> {
        Ok(source_text(plan).into_bytes())
    }
}

impl TargetLanguage for MatlabFormat {
    fn number_literal(&self, value: f64) -> String {
        if value.is_infinite() {
            return if value > 0.0 { "Inf" } else { "(-Inf)" }.to_owned();
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
        format!("c.{}", coefficient.identifier)
    }

    fn write_power(&self, a: &str, b: &str) -> String {
        format!("{a}^{b}")
    }

    fn write_call(&self, of: Function, arguments: &[&str]) -> String {
        format!("{}({})", function_name(of), arguments.join(", "))
    }

    fn write_conditional(&self, comparison: &str, [a, b, c, d]: [&str; 4]) -> String {
        // MATLAB has no conditional expression; the template defines the function `choice`.
        format!("choice({a} {comparison} {b}, {c}, {d})")
    }

    fn write_assignment(&self, name: &str, terms: &[String]) -> String {
        line_wrapping::wrap_sum(&format!("{name} = "), terms, " ...\n   ") + ";"
    }

    fn write_solution(&self, mass: &[[String; 4]; 4], forces: &[String; 4]) -> Vec<String> {
        let rows: Vec<String> = mass.iter().map(|row| row.join(", ")).collect();
        let mut lines =
            vec![format!("a = [{}] \\ [{}];", rows.join("; ...\n    "), forces.join("; "))];
        // Indices of MATLAB start at 1.
        let names = ["a_u", "a_v", "a_p", "a_r"].into_iter().enumerate();
        lines.extend(names.map(|(k, name)| format!("{name} = a({});", k + 1)));
        lines
    }

    fn rate_target(&self, place: usize) -> String {
        format!("xdot({})", place + 1)
    }
}

const TEMPLATE: &str = include_str!("../templates/model.m");

/// Complete function file.
fn source_text(plan: &ExportPlan) -> String {
    let mut help = vec!["Time derivative of the state of a ship manoeuvring model.".to_owned()];
    help.extend(header::header_lines(plan));
    help.push(format!("{}: {}", range::NAME, range::MEANING));
    let help: Vec<String> = help
        .iter()
        .flat_map(|line| line_wrapping::wrap_comment("%", line))
        .map(|line| line.trim_end().to_owned())
        .collect();
    TEMPLATE
        .replace("@@help", &help.join("\n"))
        .replace("@@order_of_inputs", &input_names(plan).join(", "))
        .replace("@@unpack", &input_statements(plan))
        .replace("@@statements", &rates::rate_statements(plan, &MatlabFormat).join("\n"))
        .replace("@@rudder", gear_statements(plan))
        .replace("@@range", &range_statements(plan))
        .replace("@@structure", &structure_statements(plan))
        .replace("@@model", &plan.identifier)
}

/// Statements of the distance outside the range covered by trials; NaN if that range is not known.
fn range_statements(plan: &ExportPlan) -> String {
    let Some(range::RangeDistance { mut statements, result }) =
        range::distance_after_rates(plan, &MatlabFormat)
    else {
        return format!("{} = NaN;", range::NAME);
    };
    statements.push(format!("{} = {result};", range::NAME));
    statements.join("\n")
}

/// Names of the inputs, in the order of the input vector.
fn input_names(plan: &ExportPlan) -> Vec<String> {
    let order = plan.gear.map(|_| "delta_order".to_owned());
    order.into_iter().chain(plan.outside.iter().map(|o| o.identifier.clone())).collect()
}

/// Statements that assign the input vector to names.
fn input_statements(plan: &ExportPlan) -> String {
    let one = |(k, name): (usize, String)| format!("{name} = ui({});", k + 1);
    input_names(plan).into_iter().enumerate().map(one).collect::<Vec<_>>().join("\n")
}

/// Statements of the steering gear; element 9 of the state is the rudder.
fn gear_statements(plan: &ExportPlan) -> &'static str {
    match plan.gear {
        None => "xdot(9) = 0;",
        Some(_) => {
            "order = min(max(delta_order, -model.gear.limit_rad), model.gear.limit_rad);\n\
             order = min(max(delta, order - model.gear.band_rad), order + model.gear.band_rad);\n\
             xdot(9) = (order - delta)/max(model.gear.time_constant_s, model.step_s);\n\
             xdot(9) = min(max(xdot(9), -model.gear.rate_rad_s), model.gear.rate_rad_s);"
        }
    }
}

/// Statements that fill the structure of the model.
fn structure_statements(plan: &ExportPlan) -> String {
    let mut lines = vec![
        format!("model.name = '{}';", escape_matlab(&plan.name)),
        format!("model.sha256 = '{}';", plan.sha256),
        format!("model.lpp_m = {:?};", plan.lpp_m),
        format!("model.speed_m_s = {:?};", plan.speed_m_s),
        format!(
            "model.step_s = {:?}; % a gear without time constant moves within this",
            plan.step_s()
        ),
        format!("model.x = [{:?}; zeros(8, 1)]; % straight running", plan.speed_m_s),
    ];
    let inputs: Vec<String> =
        plan.outside.iter().map(|o| MatlabFormat.number_literal(o.default)).collect();
    // The ordered rudder comes first among the inputs, as in the list of names.
    let order = plan.gear.map(|_| "0".to_owned());
    let inputs: Vec<String> = order.into_iter().chain(inputs).collect();
    lines.push(format!("model.ui = [{}]; % {}", inputs.join("; "), input_names(plan).join(", ")));
    if let Some(gear) = &plan.gear {
        lines.push(format!("model.gear.limit_rad = {:?};", gear.limit_rad()));
        lines.push(format!("model.gear.rate_rad_s = {:?};", gear.rate_rad_s()));
        lines.push(format!("model.gear.time_constant_s = {:?};", gear.time_constant_s()));
        lines.push(format!("model.gear.band_rad = {:?};", plan.band_rad));
    }
    lines.push("model.c = struct();".to_owned());
    lines.extend(plan.coefficients.iter().map(|c| {
        format!("model.c.{} = {:?}; % {}", c.identifier, c.value, header::coefficient_remark(c))
    }));
    lines.push(format!("model.most.speed_m_s = {:?};", plan.envelope.speed_m_s()));
    lines.push(format!("model.most.yaw_rate_rad_s = {:?};", plan.envelope.yaw_rate_rad_s()));
    lines.push(format!("model.most.roll_rad = {:?};", plan.envelope.roll_rad()));
    lines.join("\n")
}
