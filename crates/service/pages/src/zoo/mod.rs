//! The zoo: laws with their equations, effects, ships with a published model.

mod citation;
mod effect;
mod equations;
mod law;

use askama::Template;
use sistership_jobs::library::embedded_library;
use sistership_model::{Effect, Law, Zoo};

pub use effect::effect_page;
pub use law::law_page;

use crate::error::Result;
use crate::shell::PageShell;

#[derive(Template)]
#[template(path = "zoo.html")]
struct ZooPage<'a> {
    shell: PageShell,
    laws: Vec<LawRow<'a>>,
    effects: Vec<&'a Effect>,
}

struct LawRow<'a> {
    law: &'a Law,
    coefficients: usize,
    roll: bool,
    inputs: String,
}

/// Returns the laws of the database and the effects of this release.
///
/// # Errors
/// Returns an error if the page cannot be rendered.
pub fn zoo_page(zoo: &Zoo, shell: PageShell) -> Result<String> {
    let row = |law| {
        let law: &Law = law;
        LawRow {
            law,
            coefficients: law.coefficient_names().len(),
            roll: law.has_roll(),
            inputs: law.inputs.keys().cloned().collect::<Vec<_>>().join(", "),
        }
    };
    let effects = embedded_library()?.effects.iter().map(|effect| &**effect).collect();
    let laws = zoo.laws().map(|law| row(&**law)).collect();
    Ok(ZooPage { shell: shell.at_place("/zoo"), laws, effects }.render()?)
}
