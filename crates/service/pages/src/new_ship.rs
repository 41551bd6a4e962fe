//! The form of a new ship: its fields become a vessel document.

use askama::Template;
use serde_json::{Value, json};
use sistership_model::categories::known_categories;

use crate::error::Result;
use crate::form::FormFields;
use crate::particulars::{PARTICULARS, ParticularField, new_particulars};
use crate::shell::PageShell;

/// Maximum length of a name for addresses, characters.
const MAX_NAME_CHARS: usize = 64;

#[derive(Template)]
#[template(path = "new_ship.html")]
struct NewShipPage<'a> {
    shell: &'a PageShell,
    particulars: &'static [ParticularField],
    /// Categories that the form offers; others may be typed in.
    categories: Vec<&'static str>,
}

/// Returns the form.
///
/// # Errors
/// Returns an error if the page cannot be rendered.
pub fn new_ship_page(shell: &PageShell) -> Result<String> {
    let categories = known_categories();
    Ok(NewShipPage { shell, particulars: &PARTICULARS, categories }.render()?)
}

/// Returns the vessel document of a form's fields, as `models/schema/vessel.json` describes it.
///
/// # Errors
/// Returns an error that names a field which is missing or no number.
pub fn vessel_document(form: &FormFields) -> Result<Value> {
    let (sources, particulars) = new_particulars(form)?;
    let title = form.required_text("title")?;
    Ok(json!({
        "kind": "vessel",
        "name": form.get_text("name").map_or_else(|| short_name(title), str::to_owned),
        "title": title,
        "category": form.required_text("category")?,
        "sources": sources,
        "particulars": particulars,
    }))
}

/// Returns a name for addresses: the title in lower-case letters, digits and hyphens.
fn short_name(title: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    let spelled: String = title.chars().map(plain).collect();
    let words = spelled.split('-').filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-").chars().take(MAX_NAME_CHARS).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn fields(change: &[(&str, &str)]) -> FormFields {
        let mut all = vec![
            ("name", "my-ship"),
            ("title", "My ship"),
            ("category", "tanker"),
            ("citation", "Its trim and stability booklet"),
            ("lpp_m", "175"),
            ("beam_m", "25,4"),
            ("draught_m", "8.5"),
            ("displacement_m3", "21222"),
            ("service_speed_m_s", "12.4"),
            ("block_coefficient", ""),
        ];
        for (name, text) in change {
            all.iter_mut().filter(|(known, _)| known == name).for_each(|pair| pair.1 = text);
        }
        let owned = |(name, text): (&str, &str)| (name.to_owned(), text.to_owned());
        FormFields::from(all.into_iter().map(owned).collect::<Vec<_>>())
    }

    #[test]
    fn a_form_becomes_a_document_that_reads() {
        let document = vessel_document(&fields(&[])).unwrap();
        let file: sistership_model::vessel::VesselFile =
            serde_json::from_value(document.clone()).unwrap();
        let vessel = sistership_model::Vessel::from_file("form", file).unwrap();
        assert_eq!(vessel.particular("beam_m"), Some(25.4));
        assert!(document["particulars"]["values"].get("block_coefficient").is_none());
    }

    #[test]
    fn a_ship_without_a_short_name_is_named_by_its_title() {
        let document = vessel_document(&fields(&[("name", ""), ("title", "M/V Anna II")]));
        assert_eq!(document.unwrap()["name"], "m-v-anna-ii");
    }

    #[test]
    fn a_field_that_is_missing_or_no_number_is_named() {
        let wrong =
            |change: &[(&str, &str)]| vessel_document(&fields(change)).unwrap_err().to_string();
        assert!(wrong(&[("lpp_m", "long")]).contains("lpp_m"));
        assert!(wrong(&[("beam_m", " ")]).contains("beam_m"));
        assert!(wrong(&[("citation", "")]).contains("citation"));
    }
}
