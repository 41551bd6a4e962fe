//! Export as one file of plain C: no allocation, no input or output, no state of its own.

use sistership_formula::Function;

use crate::coefficients::ExportCoefficient;
use crate::error::ExportError;
use crate::export_plan::ExportPlan;
use crate::expression::{TargetLanguage, function_name};
use crate::external_input::ExternalInput;
use crate::format::ModelFormat;
use crate::quoting::escape_c_comment;
use crate::states::STATES;
use crate::{header, line_wrapping, range, rates};

/// C99 source file.
#[derive(Debug)]
pub struct CFormat;

impl ModelFormat for CFormat {
    fn name(&self) -> &'static str {
        "c"
    }

    fn extension(&self) -> &'static str {
        "c"
    }

    fn write(&self, plan: &ExportPlan) -> Result<Vec<u8>, ExportError> {
        Ok(source_text(plan).into_bytes())
    }
}

impl TargetLanguage for CFormat {
    fn number_literal(&self, value: f64) -> String {
        if value.is_infinite() {
            return if value > 0.0 { "INFINITY" } else { "(-INFINITY)" }.to_owned();
        }
        // Brackets, so that a sign never follows another operator; `{:?}` is exact to the last bit.
        if value < 0.0 { format!("({value:?})") } else { format!("{value:?}") }
    }

    fn state_name(&self, place: usize) -> String {
        format!("s->{}", STATES[place].0)
    }

    fn input_name(&self, outside: &ExternalInput) -> String {
        format!("in->{}", outside.identifier)
    }

    fn coefficient_name(&self, coefficient: &ExportCoefficient) -> String {
        format!("c->{}", coefficient.identifier)
    }

    fn write_power(&self, a: &str, b: &str) -> String {
        format!("pow({a}, {b})")
    }

    fn write_call(&self, of: Function, arguments: &[&str]) -> String {
        let name = match of {
            // C has no sign function.
            Function::Sign => return format!("(({0} > 0.0) - ({0} < 0.0))", arguments[0]),
            Function::Abs => "fabs",
            Function::Min => "fmin",
            Function::Max => "fmax",
            other => function_name(other),
        };
        format!("{name}({})", arguments.join(", "))
    }

    fn write_conditional(&self, comparison: &str, [a, b, c, d]: [&str; 4]) -> String {
        format!("{a} {comparison} {b} ? {c} : {d}")
    }

    fn write_assignment(&self, name: &str, terms: &[String]) -> String {
        // Rates are members of a structure; all other names are defined here.
        let kind = if name.starts_with("rate->") { "" } else { "const double " };
        line_wrapping::wrap_sum(&format!("    {kind}{name} = "), terms, "\n       ") + ";"
    }

    fn write_solution(&self, mass: &[[String; 4]; 4], forces: &[String; 4]) -> Vec<String> {
        let row = |(mass, force): (&[String; 4], &String)| {
            format!("        {{{}, {force}}}", mass.join(", "))
        };
        let rows: Vec<String> = mass.iter().zip(forces).map(row).collect();
        let mut lines = vec![
            format!("    double m[4][5] = {{\n{}}};", rows.join(",\n")),
            "    double a[4];".to_owned(),
            "    solve(m, a);".to_owned(),
        ];
        let names = ["a_u", "a_v", "a_p", "a_r"].into_iter().enumerate();
        lines.extend(names.map(|(k, name)| format!("    const double {name} = a[{k}];")));
        lines
    }

    fn rate_target(&self, place: usize) -> String {
        format!("rate->{}", STATES[place].0)
    }
}

/// Gaussian elimination with row exchanges.
const SOLVE: &str = include_str!("../templates/solve.c");
const STEP: &str = include_str!("../templates/step.c");

/// Complete source file.
fn source_text(plan: &ExportPlan) -> String {
    let lines = header::header_lines(plan);
    // The end mark of a comment inside the text would end the comment.
    let comment =
        lines.iter().flat_map(|line| line_wrapping::wrap_comment(" *", &escape_c_comment(line)));
    let mut text =
        format!("/*\n{}\n */\n#include <math.h>\n\n", comment.collect::<Vec<_>>().join("\n"));
    text.push_str(&type_definitions(plan));
    text.push_str(&initial_values(plan));
    // The solver is only needed if the mass matrix changes with the motion.
    if plan.listed_operations().mobility.is_none() {
        text.push_str(SOLVE);
    }
    text.push_str(&rates_function(plan));
    text.push_str(&range_function(plan));
    text.push_str(STEP);
    // Marks also occur in the generated parts, so they are replaced at the end.
    for (mark, by) in template_marks(plan) {
        text = text.replace(mark, &by);
    }
    text
}

/// Type definitions of states, inputs and coefficients.
fn type_definitions(plan: &ExportPlan) -> String {
    let member = |name: &str, remark: &str| {
        format!("    double {name}; /* {} */\n", escape_c_comment(remark))
    };
    let states: String = STATES
        .iter()
        .map(|(name, unit, meaning)| member(name, &format!("{meaning}, {unit}")))
        .collect();
    // The ordered rudder comes first among the inputs.
    let order = plan.gear.map(|_| member("delta_order", "ordered rudder, rad"));
    let outside = plan.outside.iter();
    let inputs: String = order
        .into_iter()
        .chain(outside.map(|o| member(&o.identifier, &format!("{}, {}", o.meaning, o.unit))))
        .collect();
    let coefficients: String = plan
        .coefficients
        .iter()
        .map(|c| member(&c.identifier, &header::coefficient_remark(c)))
        .collect();
    format!(
        "typedef struct {{\n{states}}} @_state;\n\ntypedef struct {{\n{inputs}}} @_inputs;\n\n\
         typedef struct {{\n{coefficients}}} @_coefficients;\n\n"
    )
}

/// Values of the coefficients, and inputs and state of the approach.
fn initial_values(plan: &ExportPlan) -> String {
    let value = |c: &ExportCoefficient| format!("    {:?}, /* {} */\n", c.value, c.identifier);
    let values: String = plan.coefficients.iter().map(value).collect();
    // Every input has its default value at the approach.
    let default = |o: &ExternalInput| {
        format!("    in.{} = {};\n", o.identifier, CFormat.number_literal(o.default))
    };
    let order = plan.gear.map(|_| "    in.delta_order = 0.0;\n".to_owned());
    let inputs: String = order.into_iter().chain(plan.outside.iter().map(default)).collect();
    format!(
        "/* The model's own coefficients. */\nconst @_coefficients @_values = {{\n{values}}};\n\n\
         /* Straight running at the approach speed, rudder amidships. */\n\
         @_inputs @_approach_inputs(void)\n{{\n    @_inputs in;\n{inputs}    return in;\n}}\n\n\
         @_state @_approach_state(void)\n{{\n    @_state s = {{0}};\n    s.u = {:?};\n    return \
         s;\n}}\n\n",
        plan.speed_m_s
    )
}

/// Function of the rates of the states, with the steering gear.
fn rates_function(plan: &ExportPlan) -> String {
    let rudder = match &plan.gear {
        None => "    rate->delta = 0.0;".to_owned(),
        Some(gear) => format!(
            "    const double limit = {:?}, fastest = {:?};\n    \
             const double time = fmax({:?}, step_s);\n    \
             const double ordered = fmin(fmax(in->delta_order, -limit), limit);\n    \
             const double order = {};\n    \
             rate->delta = fmin(fmax((order - s->delta)/time, -fastest), fastest);",
            gear.limit_rad(),
            gear.rate_rad_s(),
            gear.time_constant_s(),
            match plan.band_rad {
                0.0 => "ordered".to_owned(),
                band => format!("fmin(fmax(s->delta, ordered - {band:?}), ordered + {band:?})"),
            }
        ),
    };
    let statements = rates::rate_statements(plan, &CFormat).join("\n");
    format!(
        "/* The rates of the states. A gear without a time constant goes to its order within \
         step_s,\n * the step with which the rates are integrated. */\n\
         void @_rates(const @_state *s, const @_inputs *in, const @_coefficients *c, double \
         step_s,\n    @_state *rate)\n{{\n    (void)in;\n    (void)c;\n    \
         (void)step_s;\n{statements}\n{rudder}\n}}\n\n"
    )
}

/// Function of the distance outside the range covered by trials.
fn range_function(plan: &ExportPlan) -> String {
    let Some(range::RangeDistance { statements, result }) =
        range::standalone_distance(plan, &CFormat)
    else {
        return String::new();
    };
    let meaning = line_wrapping::wrap_comment(" *", range::MEANING).join("\n");
    format!(
        "/* As a number:\n{meaning} */\ndouble @_{name}(const @_state *s, const @_inputs *in)\n{{\n    \
         (void)in;\n{statements}\n    return {result};\n}}\n\n",
        name = range::NAME,
        statements = statements.join("\n")
    )
}

/// Marks of the templates with their replacements.
fn template_marks(plan: &ExportPlan) -> [(&'static str, String); 7] {
    let figure = |value: f64| format!("{value:?}");
    let order = match plan.gear {
        Some(_) => "in.delta_order = rudder_deg*3.14159265358979323846/180.0;",
        None => "(void)rudder_deg; /* the law has no single rudder */",
    };
    [
        ("@@order", order.to_owned()),
        ("@@speed", figure(plan.envelope.speed_m_s())),
        ("@@yaw", figure(plan.envelope.yaw_rate_rad_s())),
        ("@@roll", figure(plan.envelope.roll_rad())),
        // Sixty ship lengths at the approach speed.
        ("@@duration", figure((60.0 * plan.lpp_m / plan.speed_m_s).ceil())),
        ("@@step", figure(plan.step_s())),
        // Prefix of all names; the generated parts contain this mark, too.
        ("@_", format!("{}_", plan.identifier)),
    ]
}
