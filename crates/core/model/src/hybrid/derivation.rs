//! Derivation of the law from a declaration, rule by rule.

use super::actuators::{Variable, inputs_and_variables};
use super::file::HybridFile;
use super::law_file::Writer;
use super::rules::{Step, Term};
use super::{check, monomial, rules, submodels};
use crate::coefficient::{Axis, CoefficientName, STANDARD_FACTORS};
use crate::error::{Blame, FileError};
use crate::law::{Law, LawFile};

/// Derived law and the steps of its derivation.
#[derive(Debug, Clone)]
pub struct Derivation {
    /// The declaration.
    pub file: HybridFile,
    /// Number of terms after each rule.
    pub steps: Vec<Step>,
    /// The law in the form of a file.
    pub law_file: LawFile,
    /// Text of that file.
    pub text: String,
    /// The law, read from that text and checked like any other.
    pub law: Law,
}

/// Derives the law of a declaration; `file` is the name of the declaration in errors.
///
/// # Errors
/// Returns an error with file, line and field of the first fault.
pub fn derive(file: &str, text: &str) -> Result<Derivation, FileError> {
    let blame = Blame::new(file, text);
    let declared: HybridFile = blame.read()?;
    let at = |(field, message): (String, String)| blame.at(&field, message);
    check::check(&declared).map_err(at)?;
    let (inputs, variables) = inputs_and_variables(&declared);
    let submodels = submodels::submodels(&declared).map_err(|e| blame.at("submodels", e))?;
    let expansion = monomial::expand(variables.len(), declared.order);
    let setting = format!("order {} in {} variables", declared.order, variables.len());
    let (terms, steps) = rules::select(&expansion, &declared.rules, &variables, &setting);
    check_names(&terms, &variables).map_err(|e| blame.at("actuators", e))?;
    let writer = Writer {
        file: &declared,
        inputs: &inputs,
        variables: &variables,
        terms: &terms,
        submodels,
    };
    let law_file = writer.law();
    let text = write(&law_file).map_err(|e| blame.at("", e))?;
    // An error of the reader of laws concerns a part of the declaration with the same field name.
    let law = Law::parse(file, &text).map_err(|error| blame.at(&error.field, error.message))?;
    Ok(Derivation { file: declared, steps, law_file, text, law })
}

fn write(law: &LawFile) -> Result<String, String> {
    let yaml = serde_yaml::to_string(law).map_err(|error| error.to_string())?;
    Ok(format!(
        "# Derived by `sistership derive` from the declaration of the same name: change that, not \
         this.\n{yaml}"
    ))
}

/// Checks that names are read factor by factor as they were spelled: with factors `n` and `nn`,
/// `X_nn` would be ambiguous.
fn check_names(terms: &[Vec<Term>; 3], variables: &[Variable]) -> Result<(), String> {
    let symbols: Vec<&str> = variables.iter().map(|variable| variable.symbol.as_str()).collect();
    let extra: Vec<&str> =
        symbols.iter().copied().filter(|symbol| !STANDARD_FACTORS.contains(symbol)).collect();
    for monomial in terms.iter().flatten().map(|term| &term.monomial) {
        let name = monomial.name(Axis::X, variables);
        let spelled: Vec<&str> = monomial
            .powers
            .iter()
            .flat_map(|&(place, power)| std::iter::repeat_n(symbols[place], power as usize))
            .collect();
        let read = CoefficientName::parse(&name, &extra).ok();
        if !read
            .is_some_and(|read| spelled.iter().eq(read.factors.iter().map(|factor| &factor.symbol)))
        {
            return Err(format!("their names make `{name}` ambiguous: rename one of them"));
        }
    }
    Ok(())
}
