//! Port/starboard symmetry of effects, and their absence.

use std::cell::RefCell;

use indexmap::IndexMap;

use super::form::{EffectParameter, Form};
use super::probe::{Probe, SEEDS, is_odd};
use sistership_formula::Expr;

/// Formula that acts: its field, its parity in the mirror, and its value while the effect is
/// absent.
struct Action<'a> {
    field: String,
    formula: &'a Expr,
    odd: bool,
    absent: Expr,
}

/// Checks that mirrored motion with mirrored parameters gives mirrored results, and that an absent
/// effect does nothing.
pub fn check(form: &Form) -> Result<(), (String, String)> {
    for action in actions(form) {
        let Action { field, formula, .. } = &action;
        check_finite(form, &action).map_err(|e| (field.clone(), e))?;
        check_absence(form, &action).map_err(|e| (field.clone(), e))?;
        if !has_parity(&form.parameters, &form.values, formula, action.odd) {
            return Err((action.field, broken(action.odd)));
        }
    }
    Ok(())
}

fn actions(form: &Form) -> Vec<Action<'_>> {
    let mut actions = Vec::new();
    let mut add = |section: &str, key: &str, formula, odd, absent| {
        actions.push(Action { field: format!("{section}.{key}"), formula, odd, absent });
    };
    // A replaced state or a reading without the effect is the quantity itself.
    let itself = |name: &str| Expr::Name(name.to_owned());
    form.sees.iter().for_each(|(name, e)| add("sees", name, e, is_odd(name), itself(name)));
    form.measures
        .iter()
        .for_each(|(c, e)| add("measures", c.name(), e, is_odd(c.name()), itself(c.name())));
    form.forces.iter().for_each(|(axis, e)| {
        add("forces", &axis.to_string(), e, axis.is_odd(), Expr::Number(0.0))
    });
    form.accelerates.iter().for_each(|(axis, e)| {
        add("accelerates", &axis.to_string(), e, axis.is_odd(), Expr::Number(0.0))
    });
    // Without the effect, factors on coefficients are 1, lags and bands 0.
    form.coefficients
        .iter()
        .for_each(|(name, e)| add("coefficients", name, e, false, Expr::Number(1.0)));
    for (section, widths) in [("lags", &form.lags), ("bands", &form.bands)] {
        widths.iter().for_each(|(name, e)| add(section, name, e, false, Expr::Number(0.0)));
    }
    actions
}

fn check_finite(form: &Form, action: &Action<'_>) -> Result<(), String> {
    let finite = |seed: u32| probe(form, seed, false).of(action.formula).is_some();
    if SEEDS.into_iter().all(finite) {
        Ok(())
    } else {
        Err("has no finite value at an ordinary state".into())
    }
}

fn check_absence(form: &Form, action: &Action<'_>) -> Result<(), String> {
    let harmless = |seed: u32| {
        let absent = probe(form, seed, true);
        let present = probe(form, seed, false).of(action.formula).map_or(0.0, f64::abs);
        let pair = absent.of(action.formula).zip(absent.of(&action.absent));
        // Rounding errors scale with the present effect, and so does the tolerance.
        pair.is_some_and(|(found, wanted)| {
            (found - wanted).abs() <= 1e-9 * (wanted.abs() + present)
        })
    };
    if SEEDS.into_iter().all(harmless) {
        return Ok(());
    }
    let wanted = match &action.absent {
        Expr::Name(name) => format!("`{name}` itself"),
        Expr::Number(number) => number.to_string(),
        _ => String::new(),
    };
    Err(format!(
        "does not vanish with the effect: with every parameter at `absent` it should be {wanted}"
    ))
}

fn probe(form: &Form, seed: u32, absent: bool) -> Probe<'_> {
    Probe {
        parameters: &form.parameters,
        values: &form.values,
        seed,
        mirrored: false,
        absent,
        known: RefCell::default(),
    }
}

/// Message for a formula that is not odd (or even) as it should be.
pub fn broken(odd: bool) -> String {
    let wanted = if odd { "change its sign" } else { "stay as it is" };
    format!(
        "breaks the port/starboard symmetry: mirrored (v, r, p, phi, psi, delta and `mirror: \
         opposite`) it should {wanted}"
    )
}

/// Returns true if the formula changes its sign (`odd`) or keeps its value (not `odd`) in the
/// mirror.
pub fn has_parity(
    parameters: &IndexMap<String, EffectParameter>,
    values: &IndexMap<String, Expr>,
    formula: &Expr,
    odd: bool,
) -> bool {
    let sign = if odd { -1.0 } else { 1.0 };
    SEEDS.into_iter().all(|seed| {
        let at = |mirrored| {
            Probe { parameters, values, seed, mirrored, absent: false, known: RefCell::default() }
                .of(formula)
        };
        let pair = at(false).zip(at(true));
        pair.is_some_and(|(here, there)| {
            (here - sign * there).abs() <= 1e-9 * (here.abs() + there.abs())
        })
    })
}
