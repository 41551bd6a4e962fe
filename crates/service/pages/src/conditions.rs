//! The form of the conditions of trials: what an acceptance summary states and no instrument
//! records.

use askama::Template;
use serde_json::{Map, Value, json};
use sistership_jobs::Archive;
use sistership_request_types::{CalendarDate, ConditionText, Draught};
use sistership_store::{PageRequest, Trial};

use crate::date::format_stored_day;
use crate::error::{PageError, Result};
use crate::form::FormFields;
use crate::language::say_word;
use crate::shell::PageShell;

/// Number of trials that the form lists.
const LISTED_TRIALS: i64 = 200;

/// A condition in the form.
pub(crate) struct ConditionField {
    /// Name in stored statements.
    pub name: &'static str,
    /// True if an example is under the label.
    pub has_hint: bool,
    /// Type of the input.
    pub kind: ConditionKind,
}

/// Kind of the input of a condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ConditionKind {
    /// A date of the calendar.
    Date,
    /// A length, m.
    Metres,
    /// Words.
    Words,
}

/// The conditions, in the order of the summary.
pub(crate) const CONDITIONS: [ConditionField; 10] = {
    const fn field(name: &'static str, has_hint: bool, kind: ConditionKind) -> ConditionField {
        ConditionField { name, has_hint, kind }
    }
    use ConditionKind::{Date, Metres, Words};
    [
        field("date", false, Date),
        field("place", true, Words),
        field("wind", true, Words),
        field("sea", true, Words),
        field("depth", true, Words),
        field("draught_fore_m", false, Metres),
        field("draught_aft_m", false, Metres),
        field("displacement", true, Words),
        field("instruments", true, Words),
        field("remarks", true, Words),
    ]
};

impl ConditionField {
    /// Label.
    pub fn label(&self) -> String {
        say_word("stated", self.name)
    }

    /// Example under the label.
    pub fn hint(&self) -> String {
        say_word("stated", &format!("{}-hint", self.name))
    }
}

#[derive(Template)]
#[template(path = "conditions.html")]
struct ConditionsPage<'a> {
    shell: PageShell,
    ship: &'a str,
    trials: Vec<TrialChoice>,
    fields: Vec<(&'static ConditionField, String)>,
    /// Version whose summary asked for the conditions.
    version: Option<&'a str>,
}

impl ConditionsPage<'_> {
    fn is_date(&self, field: &ConditionField) -> bool {
        field.kind == ConditionKind::Date
    }

    fn is_metres(&self, field: &ConditionField) -> bool {
        field.kind == ConditionKind::Metres
    }
}

/// A trial to which the conditions may apply.
struct TrialChoice {
    id: String,
    name: String,
    manoeuvre: String,
    chosen: bool,
    /// Date that is stated for it.
    date: String,
}

/// Returns the form; the field `trial` of the query chooses one, otherwise those without a
/// statement are chosen.
///
/// # Errors
/// Returns an error if there is no such ship or the store fails.
pub async fn conditions_page(
    archive: &Archive,
    shell: PageShell,
    ship: &str,
    query: &FormFields,
) -> Result<String> {
    let store = &archive.store;
    // A ship that does not exist is an error, not a form without trials.
    store.ships().get(ship).await?;
    let trials = store.trials().list(ship, &PageRequest::first_page(LISTED_TRIALS)).await?.items;
    // The page of a trial leads here with this trial chosen.
    let only = query.get_text("trial");
    let (mut choices, mut shown) = (Vec::new(), None);
    for trial in trials {
        let stated = store.trials().stated_conditions(&trial.id).await?;
        let chosen = only.map_or(stated.is_none(), |only| only == trial.id);
        // The form begins with what is known of the chosen trial, else of any.
        if stated.is_some() && (shown.is_none() || (only.is_some() && chosen)) {
            shown.clone_from(&stated);
        }
        choices.push(TrialChoice::new(trial, stated.as_ref(), chosen));
    }
    // Where all have a statement, it is changed for all.
    if choices.iter().all(|choice| !choice.chosen) {
        choices.iter_mut().for_each(|choice| choice.chosen = true);
    }
    let text = |field: &ConditionField| stated_text(shown.as_ref(), field.name).to_owned();
    let page = ConditionsPage {
        shell: shell.at_place("/"),
        ship,
        trials: choices,
        fields: CONDITIONS.iter().map(|field| (field, text(field))).collect(),
        version: query.get_text("version"),
    };
    Ok(page.render()?)
}

impl TrialChoice {
    fn new(trial: Trial, stated: Option<&Value>, chosen: bool) -> Self {
        let manoeuvre = trial.manoeuvre.unwrap_or_default();
        let date = format_stored_day(stated_text(stated, "date"));
        Self { id: trial.id, name: trial.name, manoeuvre, chosen, date }
    }
}

/// Text of a condition of a statement; empty if it is not stated.
pub(crate) fn stated_text<'a>(stated: Option<&'a Value>, name: &str) -> &'a str {
    stated.and_then(|stated| stated[name].as_str()).unwrap_or_default()
}

/// Returns the statement of a form: each condition that is filled in, as text.
///
/// # Errors
/// Returns an error that names a field which is too long, no date or no number.
pub fn read_conditions(form: &FormFields) -> Result<Value> {
    let mut stated = Map::new();
    for field in &CONDITIONS {
        // An empty field states nothing, so that the summary lists it as missing.
        let Some(text) = form.get_text(field.name) else { continue };
        match field.kind {
            ConditionKind::Date => text.parse::<CalendarDate>().map(drop),
            // Kept as typed, with its decimal comma: a statement is evidence, not a computed value.
            ConditionKind::Metres => match form.optional_number(field.name)? {
                Some(metres) => check_draught(metres),
                None => Ok(()),
            },
            ConditionKind::Words => text.parse::<ConditionText>().map(drop),
        }
        .map_err(|message| PageError::invalid_field(field.name, message))?;
        stated.insert(field.name.to_owned(), Value::from(text));
    }
    Ok(Value::Object(stated))
}

/// Checks a draught by the rule of the REST interface.
fn check_draught(metres: f64) -> std::result::Result<(), String> {
    serde_json::from_value::<Draught>(json!(metres)).map(drop).map_err(|why| why.to_string())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn read(pairs: &[(&str, &str)]) -> Result<Value> {
        let owned = |(name, text): &(&str, &str)| ((*name).to_owned(), (*text).to_owned());
        read_conditions(&FormFields::from(pairs.iter().map(owned).collect::<Vec<_>>()))
    }

    #[test]
    fn conditions_are_stated_or_their_field_is_named() {
        let stated = read(&[("date", "2026-11-29"), ("draught_aft_m", "8,5"), ("sea", "")]);
        let stated = stated.unwrap();
        assert_eq!(stated["draught_aft_m"], "8,5");
        assert!(stated.get("sea").is_none(), "{stated}");
        for (name, text) in
            [("date", "29.11.2026"), ("date", "2026-13-01"), ("draught_fore_m", "deep")]
        {
            let error = read(&[(name, text)]).unwrap_err().to_string();
            assert!(error.starts_with(&format!("{name}: ")), "{error}");
        }
        assert!(read(&[("place", &"x".repeat(301))]).is_err());
    }
}
