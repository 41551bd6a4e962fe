//! Publications that laws and effects cite.

use std::collections::BTreeMap;

use sistership_model::source::Source;

/// A publication as pages cite it.
pub(super) struct Citation {
    pub key: String,
    pub text: String,
    pub doi: Option<String>,
    pub note: Option<String>,
}

/// Returns all publications, by key.
pub(super) fn citations(sources: &BTreeMap<String, Source>) -> Vec<Citation> {
    let one = |(key, source): (&String, &Source)| Citation {
        key: key.clone(),
        text: source.citation.clone(),
        doi: source.doi.clone(),
        note: source.note.clone(),
    };
    sources.iter().map(one).collect()
}
