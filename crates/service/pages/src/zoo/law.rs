//! The page of a law: its equations, parameters and sources.

use askama::Template;
use sistership_jobs::Archive;
use sistership_model::law::{AxisFile, LawFile, TermFile};
use sistership_model::{FileError, yaml};

use super::citation::{Citation, citations};
use super::equations::{formula_mathml, name_symbol};
use crate::error::Result;
use crate::shell::PageShell;

#[derive(Template)]
#[template(path = "law.html")]
struct LawPage {
    shell: PageShell,
    law: LawFile,
    sha256: String,
    values: Vec<(String, String)>,
    factors: Vec<(String, String)>,
    axes: Vec<AxisRows>,
    mass: Vec<(String, String)>,
    citations: Vec<Citation>,
}

/// One equation of motion.
struct AxisRows {
    name: String,
    scale: Option<String>,
    /// Coefficient and its factor; only a name if the law's factors give that.
    terms: Vec<(String, Option<String>)>,
    rest: Option<String>,
    open: bool,
}

/// Returns the page of a law.
///
/// # Errors
/// Returns an error if there is no such law or the store fails.
pub async fn law_page(archive: &Archive, shell: PageShell, name: &str) -> Result<String> {
    let stored = archive.store.laws().get(name).await?;
    let law: LawFile =
        yaml::read_document(&stored.document).map_err(|error| FileError::from_yaml(name, error))?;
    let set = |formulas: &mut dyn Iterator<Item = (&String, &String)>| {
        let pair =
            |(name, formula): (&String, &String)| (symbol_mathml(name), formula_mathml(formula));
        formulas.map(pair).collect::<Vec<_>>()
    };
    let page = LawPage {
        values: set(&mut law.values.iter()),
        factors: set(&mut law.factors.iter()),
        axes: law.axes.iter().map(|(axis, file)| axis_rows(&axis.to_string(), file)).collect(),
        mass: law
            .mass
            .iter()
            .flat_map(|(row, entries)| {
                entries.iter().map(move |(column, formula)| {
                    (symbol_mathml(&format!("M_{row}{column}")), formula_mathml(formula))
                })
            })
            .collect(),
        citations: citations(&law.sources),
        sha256: stored.sha256,
        shell: shell.at_place("/zoo"),
        law,
    };
    Ok(page.render()?)
}

fn symbol_mathml(name: &str) -> String {
    format!("<math>{}</math>", name_symbol(name))
}

fn axis_rows(name: &str, file: &AxisFile) -> AxisRows {
    // A term is a name, whose factor its letters give, or a pair of name and formula.
    let terms = file.terms.iter().flat_map(|term| match term {
        TermFile::Name(name) => vec![(symbol_mathml(name), None)],
        TermFile::Formula(pairs) => pairs
            .iter()
            .map(|(name, formula)| (symbol_mathml(name), Some(formula_mathml(formula))))
            .collect(),
    });
    AxisRows {
        name: name.to_owned(),
        scale: file.scale.as_deref().map(formula_mathml),
        terms: terms.collect(),
        rest: file.rest.as_deref().map(formula_mathml),
        open: file.open,
    }
}
