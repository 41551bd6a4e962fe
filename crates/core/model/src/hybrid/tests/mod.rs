#![allow(clippy::unwrap_used)]

mod counts;
mod equations;
mod faults;
mod mirror;
mod switches;

use std::collections::BTreeSet;

use super::{LawDerivation, derive_law};
use crate::coefficient::Axis;

/// The ship of the paper: one propeller, VecTwin rudders; `more` is further YAML.
fn vectwin(order: u32, more: &str) -> LawDerivation {
    declared(&format!(
        "order: {order}\nscaling: dimensional\nactuators:\n  n: {{ kind: propeller }}\n  \
         delta: {{ kind: vectwin, stall_deg: {{ starboard: 50, port: 55 }} }}\n{more}"
    ))
}

fn declared(body: &str) -> LawDerivation {
    derive_law("test.yaml", &with_head(body)).unwrap_or_else(|error| panic!("{error}"))
}

fn with_head(body: &str) -> String {
    format!("kind: hybrid\nname: test\ntitle: A declaration of the test\n{body}")
}

/// The rules as the equations print them.
const PRINTED: &str = "
rules:
  squares: as_printed
  trigonometric_exceptions: [{ factor: cosdelta_s, axes: [Y, N] }]
";

/// The terms of an axis by what their names spell.
fn names(derivation: &LawDerivation, axis: Axis) -> BTreeSet<String> {
    let spelled = |name: &String| {
        name.split_once('_').map_or(name.clone(), |(_, factors)| factors.to_owned())
    };
    derivation.law.axes[&axis].terms.keys().map(spelled).collect()
}
