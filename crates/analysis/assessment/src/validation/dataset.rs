//! A ship's entry in data catalogues: JSON-LD in the terms of schema.org.

use serde::Serialize;
use sistership_model::Vessel;
use sistership_model::source::Source;

/// Licence of the zoo's own files.
const OWN_LICENCE: &str = "MIT OR Apache-2.0";
/// Licence text of a source that states no terms.
const NONE_STATED: &str = "none stated";

/// A ship as a `Dataset` of schema.org (<https://schema.org/Dataset>).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CatalogueEntry {
    #[serde(rename = "@context")]
    context: &'static str,
    #[serde(rename = "@type")]
    kind: &'static str,
    /// The ship.
    pub identifier: String,
    /// One line for people.
    pub name: String,
    /// Content of the file.
    pub description: String,
    /// Category and type.
    pub keywords: Vec<String>,
    /// Licence of the file itself.
    pub license: &'static str,
    /// The models by name and law.
    #[serde(rename = "variableMeasured", skip_serializing_if = "Vec::is_empty")]
    pub models: Vec<String>,
    /// Sources of the figures.
    #[serde(rename = "isBasedOn")]
    pub sources: Vec<CitedWork>,
}

/// A source of figures as a `CreativeWork`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CitedWork {
    #[serde(rename = "@type")]
    kind: &'static str,
    /// Its key in the file.
    #[serde(rename = "alternateName")]
    pub alternate_name: String,
    /// The citation.
    pub name: String,
    /// Address.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub url: Option<String>,
    /// Licence; absent if the file does not state one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub license: Option<String>,
    /// Statement that the source has no terms.
    #[serde(rename = "usageInfo", skip_serializing_if = "Option::is_none")]
    pub usage: Option<&'static str>,
}

impl CatalogueEntry {
    /// Creates the entry of a vessel.
    pub fn from_vessel(vessel: &Vessel) -> Self {
        let file = &vessel.file;
        let keywords = [Some(file.category.clone()), file.ship_type.clone()];
        Self {
            context: "https://schema.org/",
            kind: "Dataset",
            identifier: file.name.clone(),
            name: file.title.clone(),
            description: vessel_description(vessel),
            keywords: keywords.into_iter().flatten().collect(),
            license: OWN_LICENCE,
            models: file.models.iter().map(|one| format!("{} ({})", one.name, one.law)).collect(),
            sources: file
                .sources
                .iter()
                .map(|(key, source)| CitedWork::from_source(key, source, file.licences.get(key)))
                .collect(),
        }
    }
}

fn vessel_description(vessel: &Vessel) -> String {
    let file = &vessel.file;
    let counted = |count: usize, one: &str, many: &str| match count {
        0 => format!("no {many}"),
        1 => format!("1 {one}"),
        _ => format!("{count} {many}"),
    };
    format!(
        "Particulars, {} and {} of {}, each number with its source",
        counted(file.models.len(), "manoeuvring model", "manoeuvring models"),
        counted(
            file.free_running.len(),
            "set of free-running trials",
            "sets of free-running trials"
        ),
        file.title
    )
}

impl CitedWork {
    fn from_source(key: &str, source: &Source, licence: Option<&String>) -> Self {
        let stated = licence.filter(|licence| *licence != NONE_STATED);
        Self {
            kind: "CreativeWork",
            alternate_name: key.to_owned(),
            name: source.citation.clone(),
            // A DOI is a permanent address and preferred to a repository.
            url: source
                .doi
                .as_ref()
                .map(|doi| format!("https://doi.org/{doi}"))
                .or_else(|| repository_url(&source.citation)),
            license: stated.cloned(),
            usage: licence.filter(|licence| *licence == NONE_STATED).map(|_| NONE_STATED),
        }
    }
}

/// The address of the repository in a citation.
fn repository_url(citation: &str) -> Option<String> {
    let place = &citation[citation.find("github.com/")?..];
    // The address ends at the first character that separates it from the rest of the citation.
    let end = place.find([',', ' ', ';', ')']).unwrap_or(place.len());
    Some(format!("https://{}", place[..end].trim_end_matches('/')))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::Zoo;

    #[test]
    fn an_entry_names_its_sources_and_their_terms() {
        let zoo = Zoo::load_embedded().unwrap();
        let entry = CatalogueEntry::from_vessel(zoo.vessel("tanker-173m").unwrap());
        assert_eq!(entry.sources[0].license.as_deref(), Some("MIT"));
        let url = entry.sources[0].url.as_deref();
        assert_eq!(url, Some("https://github.com/martinlarsalbert/VesselManoeuvringModels"));
        let without = CatalogueEntry::from_vessel(zoo.vessel("fs-bitumen-1").unwrap());
        assert!(without.sources.iter().all(|work| work.license.is_none()));
        assert!(without.sources.iter().all(|work| work.usage == Some(NONE_STATED)));
        let trials = "1 manoeuvring model and 1 set of free-running trials";
        assert!(without.description.contains(trials), "{}", without.description);
    }

    #[test]
    fn a_doi_stands_before_a_repository() {
        let source = Source {
            citation: "A paper; as quoted in github.com/some/where, file".into(),
            doi: Some("10.1/2".into()),
            note: None,
        };
        assert_eq!(
            CitedWork::from_source("a", &source, None).url.as_deref(),
            Some("https://doi.org/10.1/2")
        );
        let apart = Source { doi: None, ..source };
        let url = CitedWork::from_source("a", &apart, None).url;
        assert_eq!(url.as_deref(), Some("https://github.com/some/where"));
    }
}
