//! Derivation of the law from a declaration, rule by rule.

use super::actuators::{ExpansionVariable, inputs_and_variables};
use super::file::HybridFile;
use super::law_file::LawWriter;
use super::rules::{HybridTerm, SelectionStep};
use super::{check, monomial, rules, submodels};
use crate::coefficient::{Axis, CoefficientName, STANDARD_FACTORS};
use crate::error::{ErrorContext, FileError};
use crate::law::{Law, LawFile};

/// Derived law and the steps of its derivation.
#[derive(Debug, Clone)]
pub struct LawDerivation {
    /// The declaration.
    pub file: HybridFile,
    /// Number of terms after each rule.
    pub steps: Vec<SelectionStep>,
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
pub fn derive_law(file: &str, text: &str) -> Result<LawDerivation, FileError> {
    let blame = ErrorContext::new(file, text);
    let declared: HybridFile = blame.deserialize()?;
    let at = |(field, message): (String, String)| blame.field_error(&field, message);
    check::check_declaration(&declared).map_err(at)?;
    let (inputs, variables) = inputs_and_variables(&declared);
    let submodels =
        submodels::build_submodels(&declared).map_err(|e| blame.field_error("submodels", e))?;
    let expansion = monomial::expand_monomials(variables.len(), declared.order);
    let setting = format!("order {} in {} variables", declared.order, variables.len());
    let (terms, steps) = rules::select_terms(&expansion, &declared.rules, &variables, &setting);
    check_names(&terms, &variables).map_err(|e| blame.field_error("actuators", e))?;
    let writer = LawWriter {
        file: &declared,
        inputs: &inputs,
        variables: &variables,
        terms: &terms,
        submodels,
    };
    let law_file = writer.write_law();
    let text = write_yaml(&law_file).map_err(|e| blame.field_error("", e))?;
    // An error of the reader of laws concerns a part of the declaration with the same field name.
    let law =
        Law::parse(file, &text).map_err(|error| blame.field_error(&error.field, error.message))?;
    Ok(LawDerivation { file: declared, steps, law_file, text, law })
}

fn write_yaml(law: &LawFile) -> Result<String, String> {
    let yaml = serde_yaml::to_string(law).map_err(|error| error.to_string())?;
    Ok(format!(
        "# Derived by `sistership derive` from the declaration of the same name: edit the \
         declaration instead.\n{yaml}"
    ))
}

/// Checks that names are read factor by factor as they were spelled: with factors `n` and `nn`,
/// `X_nn` would be ambiguous.
fn check_names(
    terms: &[Vec<HybridTerm>; 3],
    variables: &[ExpansionVariable],
) -> Result<(), String> {
    let symbols: Vec<&str> = variables.iter().map(|variable| variable.symbol.as_str()).collect();
    let extra: Vec<&str> =
        symbols.iter().copied().filter(|symbol| !STANDARD_FACTORS.contains(symbol)).collect();
    for monomial in terms.iter().flatten().map(|term| &term.monomial) {
        let name = monomial.coefficient_name(Axis::X, variables);
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
