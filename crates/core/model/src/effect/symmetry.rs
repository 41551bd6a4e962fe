//! Port/starboard symmetry of effects, and their absence.

use std::cell::RefCell;

use indexmap::IndexMap;

use super::form::{EffectForm, EffectParameter};
use super::probe::{FormulaProbe, SEEDS, is_odd};
use sistership_formula::Expr;

/// Formula that acts: its field, its parity in the mirror, and its value while the effect is
/// absent.
struct FormulaAction<'a> {
    field: String,
    formula: &'a Expr,
    odd: bool,
    absent: Expr,
}

/// Checks that mirrored motion with mirrored parameters gives mirrored results, and that an absent
/// effect does nothing.
pub fn check_form(form: &EffectForm) -> Result<(), (String, String)> {
    for action in list_actions(form) {
        let FormulaAction { field, formula, .. } = &action;
        check_finite(form, &action).map_err(|e| (field.clone(), e))?;
        check_absence(form, &action).map_err(|e| (field.clone(), e))?;
        if !has_parity(&form.parameters, &form.values, formula, action.odd) {
            return Err((action.field, symmetry_message(action.odd)));
        }
    }
    Ok(())
}

fn list_actions(form: &EffectForm) -> Vec<FormulaAction<'_>> {
    let mut actions = Vec::new();
    let mut add = |section: &str, key: &str, formula, odd, absent| {
        actions.push(FormulaAction { field: format!("{section}.{key}"), formula, odd, absent });
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

fn check_finite(form: &EffectForm, action: &FormulaAction<'_>) -> Result<(), String> {
    let finite = |seed: u32| probe_at(form, seed, false).evaluate_formula(action.formula).is_some();
    if SEEDS.into_iter().all(finite) {
        Ok(())
    } else {
        Err("has no finite value in an ordinary state".into())
    }
}

fn check_absence(form: &EffectForm, action: &FormulaAction<'_>) -> Result<(), String> {
    let harmless = |seed: u32| {
        let absent = probe_at(form, seed, true);
        let present =
            probe_at(form, seed, false).evaluate_formula(action.formula).map_or(0.0, f64::abs);
        let pair =
            absent.evaluate_formula(action.formula).zip(absent.evaluate_formula(&action.absent));
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

fn probe_at(form: &EffectForm, seed: u32, absent: bool) -> FormulaProbe<'_> {
    FormulaProbe {
        parameters: &form.parameters,
        values: &form.values,
        seed,
        mirrored: false,
        absent,
        known: RefCell::default(),
    }
}

/// Message for a formula that is not odd (or even) as it should be.
pub fn symmetry_message(odd: bool) -> String {
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
            FormulaProbe {
                parameters,
                values,
                seed,
                mirrored,
                absent: false,
                known: RefCell::default(),
            }
            .evaluate_formula(formula)
        };
        let pair = at(false).zip(at(true));
        pair.is_some_and(|(here, there)| {
            (here - sign * there).abs() <= 1e-9 * (here.abs() + there.abs())
        })
    })
}
