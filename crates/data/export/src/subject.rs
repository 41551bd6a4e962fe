//! Subject of an export, and the provenance of its values.

use sistership_model::estimated_particulars::describe_estimates;
use sistership_model::version::code_revision;
use sistership_model::vessel::Status;
use sistership_model::{Law, Model};

use crate::quoting::single_line;

/// Model to be exported.
#[derive(Debug, Clone)]
pub struct ExportSubject<'a> {
    /// Model to be exported.
    pub model: &'a Model,
    /// Law of the model.
    pub law: &'a Law,
    /// Name of the version, `ship/number`, if it is one.
    pub version: Option<String>,
    /// SHA-256 of the version's document, or of the model's.
    pub sha256: String,
}

impl ExportSubject<'_> {
    /// Lines of provenance: the model, and the sources of its values.
    pub fn provenance_lines(&self) -> Vec<String> {
        let Self { model, law, version, sha256 } = self;
        // A model outside the store has no version.
        let version =
            version.as_ref().map_or(String::new(), |version| format!(", version {version}"));
        let mut lines = vec![
            format!("Model {}{version}: {}", model.name, status_words(model.status)),
            format!("SHA-256 {sha256}"),
            format!("Law {}: {}", law.name, law.title),
            format!("Written by sistership {}", code_revision()),
        ];
        lines.extend(model.note.iter().map(|note| format!("Note: {}", single_line(note))));
        lines.extend(model.effects.iter().map(|effect| {
            let values = effect.parameters.iter();
            let values: Vec<String> =
                values.map(|(name, quantity)| format!("{name} {}", quantity.value)).collect();
            format!("Effect {} ({}): {}", effect.name, effect.form.name, values.join(", "))
        }));
        let folded = model.parameters.iter().map(|(name, quantity)| {
            let known = law.parameters.get(name);
            let about = known
                .map_or(String::new(), |p| format!("[{}] {}", p.unit, single_line(&p.meaning)));
            format!("  {name} = {} {about}, {}", quantity.value, quantity.source)
        });
        let stated = model.particulars.iter();
        let stated = stated
            .map(|(name, quantity)| format!("  {name} = {}, {}", quantity.value, quantity.source));
        lines.push("Particulars and parameters:".to_owned());
        lines.extend(stated.chain(folded));
        lines.extend(describe_estimates(&model.particulars).map(|words| format!("Note: {words}")));
        lines.extend(trials_environment(model).map(|words| format!("Note: {words}")));
        lines.extend(source_lines(model));
        lines.extend(
            law.sources.iter().map(|(key, source)| citation_line("Law's source", key, source)),
        );
        lines
    }
}

/// Wind and depth during the trials of a refined model; `None` for a model without trials.
fn trials_environment(model: &Model) -> Option<String> {
    let environment = &model.validity.as_ref()?.environment;
    let ranges = environment.iter().map(|(name, [low, high])| format!("{name} {low} to {high}"));
    let covered = match environment.is_empty() {
        true => "none of them".to_owned(),
        false => ranges.collect::<Vec<_>>().join(", ") + " (SI)",
    };
    Some(format!(
        "of wind, current, waves and water depth the trials recorded {covered}; effects outside \
         these ranges are not based on trials of this ship"
    ))
}

fn source_lines(model: &Model) -> impl Iterator<Item = String> + '_ {
    model.sources.iter().map(|(key, source)| citation_line("Source", key, source))
}

fn citation_line(what: &str, key: &str, source: &sistership_model::source::Source) -> String {
    let doi = source.doi.as_ref().map_or(String::new(), |doi| format!(" doi:{doi}"));
    format!("{what} {key}: {}{doi}", single_line(&source.citation))
}

/// Reliability of a model by its status.
fn status_words(status: Status) -> &'static str {
    match status {
        Status::Published => "as published",
        Status::Estimated => "ESTIMATED from particulars, not measured",
        Status::Transferred => "TRANSFERRED from another ship, not fitted to it",
        Status::Refined => "refined against trials",
    }
}
