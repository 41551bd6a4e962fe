//! What is exported, and where its figures come from.

use sistership_model::estimated_particulars::estimated_words;
use sistership_model::version::code_revision;
use sistership_model::vessel::Status;
use sistership_model::{Law, Model};

/// What is exported.
#[derive(Debug, Clone)]
pub struct Subject<'a> {
    /// The model.
    pub model: &'a Model,
    /// Its law.
    pub law: &'a Law,
    /// The version by name, `ship/number`, where it is one.
    pub version: Option<String>,
    /// The SHA-256 of the version's document, or of the model's.
    pub sha256: String,
}

impl Subject<'_> {
    /// Lines that say what it is and where its figures come from.
    pub fn provenance(&self) -> Vec<String> {
        let Self { model, law, version, sha256 } = self;
        let version =
            version.as_ref().map_or(String::new(), |version| format!(", version {version}"));
        let mut lines = vec![
            format!("Model {}{version}: {}", model.name, worth(model.status)),
            format!("SHA-256 {sha256}"),
            format!("Law {}: {}", law.name, law.title),
            format!("Written by sistership {}", code_revision()),
        ];
        lines.extend(model.note.iter().map(|note| format!("Note: {}", one_line(note))));
        lines.extend(model.effects.iter().map(|effect| {
            let values = effect.parameters.iter();
            let values: Vec<String> =
                values.map(|(name, quantity)| format!("{name} {}", quantity.value)).collect();
            format!("Effect {} ({}): {}", effect.name, effect.form.name, values.join(", "))
        }));
        let folded = model.parameters.iter().map(|(name, quantity)| {
            let known = law.parameters.get(name);
            let about =
                known.map_or(String::new(), |p| format!("[{}] {}", p.unit, one_line(&p.meaning)));
            format!("  {name} = {} {about}, {}", quantity.value, quantity.source)
        });
        let stated = model.particulars.iter();
        let stated = stated
            .map(|(name, quantity)| format!("  {name} = {}, {}", quantity.value, quantity.source));
        lines
            .push("Particulars and parameters, which stand as numbers in what follows:".to_owned());
        lines.extend(stated.chain(folded));
        lines.extend(estimated_words(&model.particulars).map(|words| format!("Note: {words}")));
        lines.extend(trials_environment(model).map(|words| format!("Note: {words}")));
        lines.extend(sources(model));
        lines.extend(law.sources.iter().map(|(key, source)| cited("Law's source", key, source)));
        lines
    }
}

/// The wind and the depth that the trials of a refined model had; none of a model without trials.
fn trials_environment(model: &Model) -> Option<String> {
    let environment = &model.validity.as_ref()?.environment;
    let ranges = environment.iter().map(|(name, [low, high])| format!("{name} {low} to {high}"));
    let covered = match environment.is_empty() {
        true => "none of them".to_owned(),
        false => ranges.collect::<Vec<_>>().join(", ") + " (SI)",
    };
    Some(format!(
        "of wind, current, waves and water depth the trials recorded {covered}; what acts beyond \
         that does not follow from trials of this ship"
    ))
}

fn sources(model: &Model) -> impl Iterator<Item = String> + '_ {
    model.sources.iter().map(|(key, source)| cited("Source", key, source))
}

fn cited(what: &str, key: &str, source: &sistership_model::source::Source) -> String {
    let doi = source.doi.as_ref().map_or(String::new(), |doi| format!(" doi:{doi}"));
    format!("{what} {key}: {}{doi}", one_line(&source.citation))
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn worth(status: Status) -> &'static str {
    match status {
        Status::Published => "as published",
        Status::Estimated => "ESTIMATED from particulars, not measured",
        Status::Transferred => "TRANSFERRED from another ship, not fitted to it",
        Status::Refined => "refined against trials",
    }
}
