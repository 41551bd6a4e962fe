//! Catalogues of messages in Project Fluent's format, one file for each part of the pages.

use std::fmt;
use std::sync::LazyLock;

use fluent_bundle::concurrent::FluentBundle;
use fluent_bundle::{FluentArgs, FluentResource};

use super::Language;

/// Names and texts of the files of a language.
macro_rules! catalogue_files {
    ($code:literal) => {
        catalogue_files!($code: "acceptance", "audit", "compare", "conditions", "families", "fleet",
            "frame", "jobs", "people", "playground", "plots", "ship", "terms", "trial", "upload",
            "version", "zoo")
    };
    ($code:literal: $($part:literal),+) => {
        [$(($part, include_str!(concat!("../../messages/", $code, "/", $part, ".ftl")))),+]
    };
}

/// Number of files of a language.
const PARTS: usize = 17;
const ENGLISH: [(&str, &str); PARTS] = catalogue_files!("en");
const GERMAN: [(&str, &str); PARTS] = catalogue_files!("de");
const NORWEGIAN: [(&str, &str); PARTS] = catalogue_files!("nb");

/// Messages of a language.
type Catalogue = FluentBundle<FluentResource>;

/// Catalogues in the order of [`Language::ALL`]; each is parsed once.
static CATALOGUES: LazyLock<[Catalogue; 3]> = LazyLock::new(|| Language::ALL.map(read_catalogue));

/// Name and text of each file of a language.
pub(super) fn catalogue_texts(language: Language) -> [(&'static str, &'static str); PARTS] {
    match language {
        Language::English => ENGLISH,
        Language::German => GERMAN,
        Language::Norwegian => NORWEGIAN,
    }
}

fn read_catalogue(language: Language) -> Catalogue {
    let mut catalogue =
        Catalogue::new_concurrent(vec![language.code().parse().unwrap_or_default()]);
    // Marks of direction around arguments would stand in titles and be found by searches.
    catalogue.set_use_isolating(false);
    for (_, text) in catalogue_texts(language) {
        // What can be read of a faulty file is used; a test refuses such files.
        let read = FluentResource::try_new(text.to_owned());
        catalogue.add_resource_overriding(read.unwrap_or_else(|(resource, _)| resource));
    }
    catalogue
}

fn catalogue(language: Language) -> &'static Catalogue {
    &CATALOGUES[language as usize]
}

/// Returns true if there is a message of this key.
pub(super) fn has_message(key: &str) -> bool {
    catalogue(Language::English).has_message(key)
}

/// Writes a message in the present language, or in English if that lacks it; the key if both do.
pub(super) fn write_message(
    out: &mut impl fmt::Write,
    key: &str,
    arguments: &FluentArgs<'_>,
) -> fmt::Result {
    let in_order = [Language::current(), Language::English];
    let found = in_order
        .into_iter()
        .map(catalogue)
        .find_map(|catalogue| Some((catalogue, catalogue.get_message(key)?.value()?)));
    match found {
        Some((catalogue, pattern)) => {
            catalogue.write_pattern(out, pattern, Some(arguments), &mut Vec::new())
        }
        None => out.write_str(key),
    }
}

/// Keys of the messages of a language, in the order of the files.
pub(super) fn message_keys(language: Language) -> Vec<String> {
    let keys = |text: &'static str| {
        let lines = text.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_alphabetic()));
        lines.filter_map(|line| Some(line.split_once(" =")?.0.to_owned()))
    };
    catalogue_texts(language).into_iter().flat_map(|(_, text)| keys(text)).collect()
}
