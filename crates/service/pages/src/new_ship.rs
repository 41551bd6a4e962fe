//! The form of a new ship: its fields become a vessel document.

use askama::Template;
use serde_json::{Map, Value, json};

use crate::error::{PageError, Result};
use crate::form::FormFields;
use crate::shell::PageShell;

/// Particulars in the form: name, label, and whether similarity and transfer need it.
pub const PARTICULARS: [(&str, &str, bool); 14] = [
    ("lpp_m", "Length between perpendiculars, m", true),
    ("beam_m", "Beam, m", true),
    ("draught_m", "Draught, m", true),
    ("displacement_m3", "Displacement, m³", true),
    ("service_speed_m_s", "Service speed, m/s", true),
    ("block_coefficient", "Block coefficient", false),
    ("x_g_m", "Centre of gravity forward of midship, m", false),
    ("yaw_gyradius_ratio", "Yaw radius of gyration divided by length", false),
    ("rudder_area_m2", "Rudder area, m²", false),
    ("rudder_height_m", "Rudder height, m", false),
    ("propeller_diameter_m", "Propeller diameter, m", false),
    ("gm_m", "Metacentric height, m", false),
    ("frontal_area_m2", "Frontal area above water, m²", false),
    ("lateral_area_m2", "Lateral area above water, m²", false),
];

/// Key of the single source.
const SOURCE_KEY: &str = "typed-in";

#[derive(Template)]
#[template(path = "new_ship.html")]
struct NewShipPage<'a> {
    shell: &'a PageShell,
    particulars: &'static [(&'static str, &'static str, bool)],
}

/// Returns the form.
///
/// # Errors
/// Returns an error if the page cannot be rendered.
pub fn new_ship_page(shell: &PageShell) -> Result<String> {
    Ok(NewShipPage { shell, particulars: &PARTICULARS }.render()?)
}

/// Returns the vessel document of a form's fields, as `models/schema/vessel.json` describes it.
///
/// # Errors
/// Returns an error that names a field which is missing or no number.
pub fn vessel_document(form: &FormFields) -> Result<Value> {
    let text = |name: &str| {
        let text = form.get_text(name).map(str::trim).filter(|text| !text.is_empty());
        text.ok_or_else(|| PageError::invalid_field(name, "is required".to_owned()))
    };
    let mut values = Map::new();
    // Optional particulars that are empty are left out of the document.
    for (name, _, needed) in PARTICULARS {
        match form.get_text(name).map(str::trim).filter(|text| !text.is_empty()) {
            None if needed => {
                return Err(PageError::invalid_field(name, "is required".to_owned()));
            }
            None => {}
            Some(text) => {
                // A decimal comma is accepted.
                let value: Option<f64> = text.replace(',', ".").parse().ok();
                let value = value.filter(|value| value.is_finite()).ok_or_else(|| {
                    PageError::invalid_field(name, format!("`{text}` is not a number"))
                })?;
                values.insert(name.to_owned(), json!(value));
            }
        }
    }
    Ok(json!({
        "kind": "vessel",
        "name": text("name")?,
        "title": text("title")?,
        "category": text("category")?,
        "sources": { SOURCE_KEY: { "citation": text("citation")? } },
        "particulars": { "source": SOURCE_KEY, "values": values },
    }))
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
    fn a_field_that_is_missing_or_no_number_is_named() {
        let wrong =
            |change: &[(&str, &str)]| vessel_document(&fields(change)).unwrap_err().to_string();
        assert!(wrong(&[("lpp_m", "long")]).contains("lpp_m"));
        assert!(wrong(&[("beam_m", " ")]).contains("beam_m"));
        assert!(wrong(&[("citation", "")]).contains("citation"));
    }
}
