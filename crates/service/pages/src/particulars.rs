//! Particulars of a ship in forms: the fields, how a number is read, and the form by which they are
//! changed later.

use std::collections::BTreeMap;

use askama::Template;
use serde_json::{Map, Value, json};
use sistership_jobs::archive::parse_vessel;
use sistership_jobs::particulars_change::{ParticularsChange, STATED_SOURCE};
use sistership_store::Ship;

use crate::error::{PageError, Result};
use crate::form::FormFields;
use crate::language::{say, say_word};
use crate::shell::PageShell;
use crate::terms::particular_words;

/// Metres per second in a knot.
const KNOT_M_S: f64 = 1852.0 / 3600.0;

/// A particular in a form.
pub(crate) struct ParticularField {
    /// Name in documents.
    pub name: &'static str,
    /// True if an explanation is under the label.
    pub has_hint: bool,
    /// True if similarity and transfer need it.
    pub needed: bool,
}

/// Particulars in forms; the needed ones come first.
pub(crate) const PARTICULARS: [ParticularField; 16] = {
    const fn field(name: &'static str, has_hint: bool, needed: bool) -> ParticularField {
        ParticularField { name, has_hint, needed }
    }
    [
        field("lpp_m", false, true),
        field("beam_m", false, true),
        field("draught_m", true, true),
        field("displacement_m3", true, true),
        field("service_speed_m_s", true, true),
        field("draught_fore_m", false, false),
        field("draught_aft_m", false, false),
        field("block_coefficient", false, false),
        field("x_g_m", false, false),
        field("yaw_gyradius_ratio", true, false),
        field("rudder_area_m2", false, false),
        field("rudder_height_m", false, false),
        field("propeller_diameter_m", false, false),
        field("gm_m", false, false),
        field("frontal_area_m2", false, false),
        field("lateral_area_m2", false, false),
    ]
};

impl ParticularField {
    /// Label, with the unit.
    pub fn label(&self) -> String {
        match particular_words(self.name) {
            (words, "") => words,
            (words, unit) => format!("{words}, {unit}"),
        }
    }

    /// Explanation under the label.
    pub fn hint(&self) -> String {
        say_word("particular", &format!("{}-hint", self.name))
    }
}

/// Reads a particular that is given; speeds also in knots.
///
/// # Errors
/// Returns an error if the text is no finite number, or if a required field is empty.
fn read_particular(
    form: &FormFields,
    field: &ParticularField,
    required: bool,
) -> Result<Option<f64>> {
    let text = match form.get_text(field.name) {
        Some(text) => text,
        None if required => return Err(PageError::invalid_field(field.name, say("form-required"))),
        None => return Ok(None),
    };
    // Speeds alone have knots; a length in knots is a mistake.
    let knots = text.strip_suffix("kn").filter(|_| field.name.ends_with("_m_s"));
    // A decimal comma is accepted; `inf` and `nan` parse as numbers.
    let number = knots.unwrap_or(text).trim().replace(',', ".").parse::<f64>().ok();
    let number = number.filter(|number| number.is_finite()).ok_or_else(|| {
        PageError::invalid_field(field.name, say("form-not-a-number").with("text", text))
    })?;
    // Rounded, so that the form shows a short number again.
    Ok(Some(if knots.is_some() { (1e4 * number * KNOT_M_S).round() / 1e4 } else { number }))
}

#[derive(Template)]
#[template(path = "particulars.html")]
struct ParticularsPage<'a> {
    shell: PageShell,
    ship: &'a str,
    revision: i64,
    fields: Vec<(&'static ParticularField, String)>,
}

/// Returns the form with the present particulars of a ship.
///
/// # Errors
/// Returns an error if the ship's document cannot be read.
pub fn particulars_page(shell: PageShell, ship: &Ship) -> Result<String> {
    let vessel = parse_vessel(&ship.name, &ship.document)?;
    // Those that are stated, without derived ones.
    let text = |name: &str| {
        vessel.particulars.get(name).map_or_else(String::new, |of| of.value.to_string())
    };
    let page = ParticularsPage {
        shell: shell.at_place("/"),
        ship: &ship.name,
        revision: ship.revision,
        fields: PARTICULARS.iter().map(|field| (field, text(field.name))).collect(),
    };
    Ok(page.render()?)
}

/// Returns the document of a ship with the particulars of the form; those that differ from the
/// present ones get the source that the form names.
///
/// # Errors
/// Returns an error that names a field which is missing or no number.
pub fn changed_document(ship: &Ship, form: &FormFields) -> Result<Value> {
    let vessel = parse_vessel(&ship.name, &ship.document)?;
    let mut values = BTreeMap::new();
    for field in &PARTICULARS {
        // A published ship may lack one that a new ship needs.
        let required = field.needed && vessel.particulars.contains_key(field.name);
        // An untouched field has the text of its value, which parses to the same number.
        values.insert(field.name.to_owned(), read_particular(form, field, required)?);
    }
    let change = ParticularsChange::new(ship, values)?;
    let citation = match change.needs_source() {
        true => form.required_text("citation")?,
        false => "",
    };
    Ok(change.into_document(citation))
}

/// Returns sources and particulars of a new ship.
///
/// # Errors
/// Returns an error that names a field which is missing or no number.
pub(crate) fn new_particulars(form: &FormFields) -> Result<(Value, Value)> {
    let mut values = Map::new();
    for field in &PARTICULARS {
        // Optional particulars that are empty are left out of the document.
        if let Some(value) = read_particular(form, field, field.needed)? {
            values.insert(field.name.to_owned(), json!(value));
        }
    }
    let sources = json!({ STATED_SOURCE: { "citation": form.required_text("citation")? } });
    Ok((sources, json!({ "source": STATED_SOURCE, "values": values })))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn fields(pairs: &[(&str, &str)]) -> FormFields {
        let owned = |(name, text): &(&str, &str)| ((*name).to_owned(), (*text).to_owned());
        FormFields::from(pairs.iter().map(owned).collect::<Vec<_>>())
    }

    fn own_ship() -> Ship {
        let values = json!({ "lpp_m": 175.0, "beam_m": 25.4, "draught_m": 8.5,
            "displacement_m3": 21222.0, "service_speed_m_s": 10.47, "gm_m": 0.3 });
        let document = json!({ "kind": "vessel", "name": "own", "title": "Own",
            "category": "tanker", "sources": { "typed-in": { "citation": "booklet" } },
            "particulars": { "source": "typed-in", "values": values } });
        Ship {
            name: "own".to_owned(),
            title: "Own".to_owned(),
            category: "tanker".to_owned(),
            document: document.to_string(),
            revision: 1,
            created_us: 0,
            updated_us: 0,
            deleted_us: None,
        }
    }

    const KEPT: [(&str, &str); 5] = [
        ("lpp_m", "175"),
        ("beam_m", "25,4"),
        ("draught_m", "8.5"),
        ("displacement_m3", "21222"),
        ("service_speed_m_s", "10.47"),
    ];

    #[test]
    fn changed_particulars_name_their_own_source() {
        let change = [("draught_aft_m", "9"), ("citation", "draught survey")];
        let document = changed_document(&own_ship(), &fields(&[&KEPT[..], &change].concat()));
        let document = document.unwrap();
        let values = &document["particulars"]["values"];
        assert_eq!(values["draught_aft_m"]["source"], "typed-in-2");
        assert_eq!(document["sources"]["typed-in-2"]["citation"], "draught survey");
        assert_eq!(values["beam_m"], 25.4, "an untouched value keeps its source");
        assert!(values.get("gm_m").is_none(), "an emptied field is removed");
        let without = changed_document(&own_ship(), &fields(&[&KEPT[..], &change[..1]].concat()));
        assert!(without.unwrap_err().to_string().starts_with("citation"));
    }

    #[test]
    fn speeds_are_read_in_knots_too() {
        let read = |index: usize, text| {
            let field = &PARTICULARS[index];
            read_particular(&fields(&[(field.name, text)]), field, true)
        };
        let speed = read(4, "20 kn").unwrap().unwrap();
        assert!((speed - 10.2889).abs() < 1e-4, "{speed}");
        assert!(read(0, "20 kn").is_err() && read(0, "inf").is_err());
    }
}
