//! Formulas.

use sistership_formula::{Expr, Function, parse};
use sistership_simulation::tape::{NameBinding, TapeBuilder};

const INPUTS: [&str; 3] = ["u", "v", "r"];
const VALUES: [f64; 3] = [1.25, -0.5, 0.01];

/// A formula that is read is lowered to a tape of the same value.
pub fn run(data: &[u8]) {
    let Some(expr) = super::text(data).and_then(|text| parse(text).ok()) else { return };
    if expr
        .mentioned_names()
        .iter()
        .any(|name| !INPUTS.contains(name) && !matches!(*name, "pi" | "g"))
    {
        return;
    }
    let lookup = |name: &str| INPUTS.iter().position(|known| *known == name).map(|k| VALUES[k]);
    // Where some part of it is infinite, zero times it is anything: the tape leaves such products
    // out, and with them the sign of zero, by which alone an angle may turn about.
    if is_determined(&expr, &lookup) {
        lowered(&expr, expr.value(&lookup).expect("every name is known"));
    }
}

fn is_determined(expr: &Expr, lookup: &dyn Fn(&str) -> Option<f64>) -> bool {
    let is_finite = expr.value(lookup).is_some_and(f64::is_finite);
    is_finite
        && !is_angle_by_sign_of_zero(expr, lookup)
        && expr.children().into_iter().all(|child| is_determined(child, lookup))
}

fn is_angle_by_sign_of_zero(expr: &Expr, lookup: &dyn Fn(&str) -> Option<f64>) -> bool {
    let Expr::Call(Function::Atan2, arguments) = expr else { return false };
    let values: Vec<f64> = arguments.iter().filter_map(|argument| argument.value(lookup)).collect();
    values[0] == 0.0 && values[1] <= 0.0
}

fn lowered(expr: &Expr, value: f64) {
    let bind = |_: &str| None::<NameBinding>;
    let mut lowering = TapeBuilder::new(&INPUTS, bind);
    if lowering.add_output(expr).is_err() {
        return;
    }
    let of_tape = lowering.finish().evaluate_point(&VALUES)[0];
    let close = (of_tape - value).abs() <= 1e-9 * value.abs().max(1.0);
    assert!(
        close || !value.is_finite() || !of_tape.is_finite(),
        "{expr:?}: {value} by the tree, {of_tape} by the tape"
    );
}
