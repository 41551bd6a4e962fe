//! Words in headers, by language, from the data files of the zoo.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::Deserialize;

use crate::role::{Role, Side};
use crate::words::split_words;

const FILES: [(&str, &str); 9] = [
    ("en.yaml", include_str!("../../../../models/vocabulary/en.yaml")),
    ("de.yaml", include_str!("../../../../models/vocabulary/de.yaml")),
    ("no.yaml", include_str!("../../../../models/vocabulary/no.yaml")),
    ("fr.yaml", include_str!("../../../../models/vocabulary/fr.yaml")),
    ("es.yaml", include_str!("../../../../models/vocabulary/es.yaml")),
    ("it.yaml", include_str!("../../../../models/vocabulary/it.yaml")),
    ("ja.yaml", include_str!("../../../../models/vocabulary/ja.yaml")),
    ("ko.yaml", include_str!("../../../../models/vocabulary/ko.yaml")),
    ("zh.yaml", include_str!("../../../../models/vocabulary/zh.yaml")),
];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct VocabularyFile {
    #[serde(rename = "kind")]
    _kind: VocabularyKind,
    #[serde(rename = "language")]
    _language: String,
    names: BTreeMap<String, Vec<String>>,
    others: BTreeMap<String, Vec<String>>,
    sides: SidesFile,
    passed_over: Vec<String>,
    units: BTreeMap<String, Vec<String>>,
    signs: SignsFile,
}

#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum VocabularyKind {
    Vocabulary,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SidesFile {
    port: Vec<String>,
    starboard: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SignsFile {
    #[serde(rename = "port positive")]
    port_positive: Vec<String>,
}

/// Meaning of a phrase.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum PhraseMeaning {
    Channel(Role),
    /// A quantity for which there is no channel, by its name in messages.
    Other(String),
}

/// Phrase and its meaning.
#[derive(Debug)]
pub(crate) struct Phrase {
    pub words: Vec<String>,
    /// The words, joined without a separator.
    pub joined: String,
    pub meaning: PhraseMeaning,
}

/// Words of all languages.
#[derive(Debug, Default)]
pub(crate) struct Vocabulary {
    pub phrases: Vec<Phrase>,
    pub sides: Vec<(String, Side)>,
    pub passed_over: Vec<String>,
    /// Spelling in lower case, and the name of the unit in manifests.
    pub units: Vec<(String, String)>,
    pub port_positive: Vec<String>,
}

static VOCABULARY: LazyLock<Vocabulary> = LazyLock::new(|| {
    let mut all = Vocabulary::default();
    // Errors are ignored here: the files are part of the build, and a test parses each of them.
    for file in FILES.iter().filter_map(|(_, text)| serde_yaml::from_str(text).ok()) {
        all.add_file(file);
    }
    all
});

/// Returns the vocabulary of all languages.
pub(crate) fn vocabulary() -> &'static Vocabulary {
    &VOCABULARY
}

impl Vocabulary {
    fn add_file(&mut self, file: VocabularyFile) {
        for (name, phrases) in file.names {
            let role = Role::from_name(&name).unwrap_or(Role::Other);
            self.add_phrases(&phrases, &PhraseMeaning::Channel(role));
        }
        for (name, phrases) in file.others {
            self.add_phrases(&phrases, &PhraseMeaning::Other(name));
        }
        let sides = [(file.sides.port, Side::Port), (file.sides.starboard, Side::Starboard)];
        for (list, side) in sides {
            self.sides.extend(list.into_iter().map(|word| (word.to_lowercase(), side)));
        }
        self.passed_over.extend(file.passed_over.into_iter().map(|word| word.to_lowercase()));
        for (unit, spellings) in file.units {
            let spelled = spellings.into_iter().map(|word| (word.to_lowercase(), unit.clone()));
            self.units.extend(spelled);
        }
        self.port_positive.extend(file.signs.port_positive.iter().map(|text| text.to_lowercase()));
    }

    fn add_phrases(&mut self, phrases: &[String], meaning: &PhraseMeaning) {
        self.phrases.extend(phrases.iter().map(|phrase| {
            let words = split_words(phrase);
            Phrase { joined: words.concat(), words, meaning: meaning.clone() }
        }));
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn every_file_is_read_and_names_channels() {
        for (name, text) in FILES {
            let file: VocabularyFile = serde_yaml::from_str(text).unwrap();
            for channel in file.names.keys() {
                assert!(Role::from_name(channel).is_some(), "{name}: {channel}");
            }
            let known: Vec<&str> = Role::channels()
                .flat_map(|role| role.kind().known_units())
                .map(|unit| unit.name)
                .chain(["%"])
                .collect();
            for unit in file.units.keys() {
                assert!(known.contains(&unit.as_str()), "{name}: {unit}");
            }
        }
        assert!(vocabulary().phrases.len() > 700);
    }

    #[test]
    fn a_phrase_names_one_quantity() {
        // A word may be a channel's in one language and another's in a second: then both are
        // candidates. Within a channel or an other quantity of one file it stands once.
        for (name, text) in FILES {
            let file: VocabularyFile = serde_yaml::from_str(text).unwrap();
            let all: Vec<&String> = file.names.values().flatten().collect();
            for (at, phrase) in all.iter().enumerate() {
                let twice = all[..at].contains(phrase);
                let shared = ["kurs", "ost", "x position", "y position"];
                assert!(!twice || shared.contains(&phrase.as_str()), "{name}: {phrase}");
            }
        }
    }
}
