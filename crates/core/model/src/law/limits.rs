//! Limits of the size of a law, so that it can be read, simulated, refined and diagnosed in bounded
//! time and stack.

use std::cell::RefCell;
use std::collections::HashMap;

use super::definition::Law;
use super::file::LawFile;
use sistership_formula::{Expr, MAX_DEPTH};

/// Largest number of terms of all axes; with the deviations of submodels, see [`MAX_COEFFICIENTS`].
/// The largest law of the zoo has 189 terms, and none has more than 189 coefficients.
pub const MAX_TERMS: usize = 1500;

/// Largest number of coefficients of a law, shared ones and deviations, or of a model.
pub const MAX_COEFFICIENTS: usize = 3000;

/// Largest number of effects of a model.
pub const MAX_EFFECTS: usize = 64;

/// Largest number of numbers, names and operators of all formulas of a law, or of a form of an
/// effect.
pub const MAX_SIZE: usize = 50_000;

/// Largest number of values, parameters, inputs, factors or submodels, each.
const MAX_NAMES: usize = 500;

/// Largest number of comparisons of one submodel.
const MAX_COMPARISONS: usize = 16;

type FieldFault = (String, String);

/// Refuses a law whose file lists too much, before any of it is read.
pub fn check_counts(raw: &LawFile) -> Result<(), FieldFault> {
    let names = [
        ("inputs", raw.inputs.len()),
        ("parameters", raw.parameters.len()),
        ("values", raw.values.len()),
        ("factors", raw.factors.len()),
        ("mirrors", raw.mirrors.len()),
        ("submodels", raw.submodels.len()),
        ("typical", raw.typical.len()),
    ];
    names.into_iter().try_for_each(|(field, count)| check_count(field, count, MAX_NAMES))?;
    for (name, submodel) in &raw.submodels {
        check_count(&format!("submodels.{name}.when"), submodel.when.len(), MAX_COMPARISONS)?;
    }
    let terms = raw.axes.values().map(|axis| axis.terms.len()).sum::<usize>();
    check_count("axes", terms, MAX_TERMS)
        .map_err(|(field, message)| (field, format!("terms: {message}")))?;
    // Each submodel has a deviation of every term.
    let coefficients = terms * (1 + raw.submodels.len());
    let told =
        |(field, message)| (field, format!("coefficients, {terms} for each condition: {message}"));
    check_count("submodels", coefficients, MAX_COEFFICIENTS).map_err(told)
}

/// Refuses a field that lists more than some number of items.
pub(crate) fn check_count(field: &str, found: usize, most: usize) -> Result<(), FieldFault> {
    if found > most {
        Err((field.to_owned(), format!("there are {found}; the limit is {most}")))
    } else {
        Ok(())
    }
}

/// Refuses a law whose formulas are too many, or too deep through the values that they mention.
pub fn check_size(law: &Law) -> Result<(), FieldFault> {
    let formulas = named_formulas(law);
    check_count("axes", formulas.iter().map(|(_, expr)| expr.node_count()).sum(), MAX_SIZE)
        .map_err(|(_, message)| {
            (String::new(), format!("numbers, names and operators of all formulas: {message}"))
        })?;
    let depths = FormulaDepths::new(&law.values);
    formulas.into_iter().try_for_each(|(field, expr)| depths.check(&field, expr, MAX_DEPTH))
}

impl Law {
    /// Refuses a law that effects have made too deep.
    pub(crate) fn check_depth(&self) -> Result<(), String> {
        let depths = FormulaDepths::new(&self.values);
        // Twice the depth of a file's law leaves room for the formulas of effects.
        let more = self.dressing.all_formulas().map(|expr| ("effects".to_owned(), expr));
        let mut all = named_formulas(self).into_iter().chain(more);
        all.try_for_each(|(field, expr)| depths.check(&field, expr, 2 * MAX_DEPTH))
            .map_err(|(_, message)| message)
    }
}

/// Returns every formula of a law with its field.
fn named_formulas(law: &Law) -> Vec<(String, &Expr)> {
    let mut all: Vec<(String, &Expr)> =
        law.values.iter().map(|(name, expr)| (format!("values.{name}"), expr)).collect();
    all.extend(law.factors.iter().map(|(name, expr)| (format!("factors.{name}"), expr)));
    for (axis, of_axis) in &law.axes {
        all.push((format!("axes.{axis}.scale"), &of_axis.scale));
        all.push((format!("axes.{axis}.rest"), &of_axis.rest));
        all.extend(
            of_axis.terms.iter().map(|(name, expr)| (format!("axes.{axis}.terms.{name}"), expr)),
        );
    }
    all.extend(law.mass.iter().map(|((row, column), expr)| (format!("mass.{row}.{column}"), expr)));
    all.extend(law.kinematics.iter().map(|(name, expr)| (format!("kinematics.{name}"), expr)));
    all.extend(
        law.parameters
            .iter()
            .filter_map(|(name, p)| Some((format!("parameters.{name}"), p.from.as_ref()?))),
    );
    all
}

/// Depths of formulas through values, each of which is examined once.
pub(crate) struct FormulaDepths<'a> {
    values: &'a indexmap::IndexMap<String, Expr>,
    known: RefCell<HashMap<String, usize>>,
}

impl<'a> FormulaDepths<'a> {
    pub(crate) fn new(values: &'a indexmap::IndexMap<String, Expr>) -> Self {
        Self { values, known: RefCell::default() }
    }

    /// Refuses a formula that is deeper than `most`.
    pub(crate) fn check(&self, field: &str, expr: &Expr, most: usize) -> Result<(), FieldFault> {
        match expr.depth_within(most, &|name, left| self.name_depth(name, left)) {
            Some(_) => Ok(()),
            None => {
                let message = format!(
                    "operators, through the values that it mentions, nest more than {most} deep"
                );
                Err((field.to_owned(), message))
            }
        }
    }

    fn name_depth(&self, name: &str, left: usize) -> Option<usize> {
        let Some(expr) = self.values.get(name) else { return Some(0) };
        if let Some(depth) = self.known.borrow().get(name) {
            return Some(*depth);
        }
        // One level less is left below the value; an exhausted depth ends the search.
        let depth = 1 + expr
            .depth_within(left.checked_sub(1)?, &|name, left| self.name_depth(name, left))?;
        self.known.borrow_mut().insert(name.to_owned(), depth);
        Some(depth)
    }
}

#[cfg(test)]
mod tests;
