//! Formulas.

use sistership_dynamics::tape::{Binding, TapeBuilder};
use sistership_model::formula::{Expr, parse};

const INPUTS: [&str; 3] = ["u", "v", "r"];
const VALUES: [f64; 3] = [1.25, -0.5, 0.01];

/// A formula that is read is lowered to a tape of the same value.
pub fn run(data: &[u8]) {
    let Some(expr) = super::text(data).and_then(|text| parse(text).ok()) else { return };
    if expr.names().iter().any(|name| !INPUTS.contains(name) && !matches!(*name, "pi" | "g")) {
        return;
    }
    let lookup = |name: &str| INPUTS.iter().position(|known| *known == name).map(|k| VALUES[k]);
    let value = expr.value(&lookup).expect("every name is known");
    lowered(&expr, value);
}

fn lowered(expr: &Expr, value: f64) {
    let bind = |_: &str| None::<Binding>;
    let mut lowering = TapeBuilder::new(&INPUTS, &bind);
    if lowering.output(expr).is_err() {
        return;
    }
    let of_tape = lowering.finish().values(&VALUES)[0];
    let close = (of_tape - value).abs() <= 1e-9 * value.abs().max(1.0);
    assert!(close || !value.is_finite() || !of_tape.is_finite(), "{expr:?}: {value} by the tree, {of_tape} by the tape");
}
