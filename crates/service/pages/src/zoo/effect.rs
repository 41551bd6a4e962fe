//! The page of an effect: its forms with their parameters and formulas.

use askama::Template;
use sistership_jobs::error::DeriveError;
use sistership_jobs::library::embedded_library;
use sistership_model::effect::{ActsOn, FormFile};
use sistership_store::StoreError;

use super::citation::{Citation, citations};
use super::equations::formula_mathml;
use crate::error::Result;
use crate::language::{MarkupMessage, Message, MessageArgument, say, say_html};
use crate::numbers::format_plain;
use crate::shell::PageShell;

#[derive(Template)]
#[template(path = "effect.html")]
struct EffectPage {
    shell: PageShell,
    name: String,
    title: String,
    acts_on: MarkupMessage,
    note: Option<String>,
    forms: Vec<FormRows>,
    searched: bool,
    citations: Vec<Citation>,
}

/// One form of the effect.
struct FormRows {
    name: String,
    meaning: String,
    needs: String,
    /// Name, unit, meaning, bounds.
    parameters: Vec<(String, String, String, String)>,
    /// Description and formula.
    formulas: Vec<(String, String)>,
}

/// Returns the page of an effect of this release.
///
/// # Errors
/// Returns an error if there is no such effect.
pub fn effect_page(shell: PageShell, name: &str) -> Result<String> {
    let known = embedded_library()?.effects.iter().find(|effect| effect.name == name);
    let effect = known.ok_or_else(|| {
        DeriveError::Store(StoreError::NotFound { kind: "effect", id: name.to_owned() })
    })?;
    let page = EffectPage {
        shell: shell.at_place("/zoo"),
        name: effect.name.clone(),
        title: effect.title.clone(),
        acts_on: acts_on_text(effect.acts_on).with("name", &effect.name),
        note: effect.note.clone(),
        forms: effect.forms.iter().map(|form| form_rows(&form.file)).collect(),
        searched: effect.grammar.is_some(),
        citations: citations(&effect.sources),
    };
    Ok(page.render()?)
}

fn acts_on_text(acts_on: ActsOn) -> MarkupMessage {
    match acts_on {
        ActsOn::Force => say_html("effect-force"),
        ActsOn::Inflow => say_html("effect-inflow"),
        ActsOn::Measurement => say_html("effect-measurement"),
    }
}

fn form_rows(form: &FormFile) -> FormRows {
    let parameters = form.parameters.iter().map(|(name, of)| {
        let [low, high] = of.bounds;
        (name.clone(), of.unit.clone(), of.meaning.clone(), {
            let text = say("range-text").with("low", format_plain(low));
            text.with("high", format_plain(high)).into()
        })
    });
    let values = form.values.iter().map(|(name, formula)| (format!("{name} ="), formula));
    let sees = form.sees.iter().map(|(name, formula)| (named(say("formula-sees"), name), formula));
    let forces = form
        .forces
        .iter()
        .map(|(axis, formula)| (named(say("formula-adds"), axis.to_string()), formula));
    let accelerates = form
        .accelerates
        .iter()
        .map(|(axis, formula)| (named(say("formula-accelerates"), axis.to_string()), formula));
    let coefficients = form
        .coefficients
        .iter()
        .map(|(name, formula)| (named(say("formula-becomes"), name), formula));
    let lags = form.lags.iter().map(|(name, formula)| (named(say("formula-lag"), name), formula));
    let bands =
        form.bands.iter().map(|(name, formula)| (named(say("formula-dead-band"), name), formula));
    let measures = form
        .measures
        .iter()
        .map(|(channel, formula)| (named(say("formula-reads"), channel.to_string()), formula));
    let all = values.chain(sees).chain(forces).chain(accelerates).chain(coefficients);
    FormRows {
        name: form.name.clone(),
        meaning: form.meaning.clone(),
        needs: form.needs.iter().map(ToString::to_string).collect::<Vec<_>>().join(", "),
        parameters: parameters.collect(),
        formulas: all
            .chain(lags)
            .chain(bands)
            .chain(measures)
            .map(|(what, formula)| (what, formula_mathml(formula)))
            .collect(),
    }
}

fn named(message: Message, name: impl MessageArgument) -> String {
    message.with("name", name).into()
}
