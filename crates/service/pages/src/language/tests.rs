//! Tests of the catalogues against each other, and against the pages that use them.
#![allow(clippy::unwrap_used)]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use fluent_bundle::FluentResource;

use super::catalogue::{catalogue_texts, message_keys};
use super::chart_words::chart_words;
use super::{Language, say, say_html, say_word};

/// Words of the text of templates that need no translation: names, standards, symbols and formats.
const UNTRANSLATED: [&str; 6] = ["Sistership", "REST", "API", "SHA", "doi", "yard"];

/// Literals of more than one word in the code of pages that people do not read, by their beginning.
const CODE_LITERALS: [(&str, &str); 18] = [
    ("<", "markup"),
    ("default-src", "security policy"),
    ("; HttpOnly", "attributes of a cookie"),
    ("private, max-age", "a header for caches"),
    (" m/s ( kn)", "units"),
    ("the page cannot be written", "an error of the program, for its log"),
    ("the request has no user or key", "an error of the program, for its log"),
    ("given on this page", "stored in manifests, translated where it is shown"),
    ("excluded on the upload page", "stored in manifests"),
    ("line ", "class of a style"),
    ("hull ", "class of a style"),
    ("dot ", "class of a style"),
    ("tick ", "class of a style"),
    ("small ", "class of a style"),
    ("title mid", "class of a style"),
    ("node here", "class of a style"),
    ("Norsk bokmål", "a language in itself"),
    ("bar over", "class of a style"),
];

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// Names and texts of the files of a folder with an extension.
fn read_files(name: &str, extension: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut open = vec![folder(name)];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).unwrap().map(Result::unwrap) {
            let path = entry.path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|own| own == extension) {
                found.push((path.display().to_string(), fs::read_to_string(&path).unwrap()));
            }
        }
    }
    assert!(!found.is_empty(), "{name} has no .{extension} files");
    found
}

/// Code of the pages and of their routes without tests and comments.
fn code_files() -> Vec<(String, String)> {
    let own = read_files("src", "rs").into_iter().filter(|(name, _)| !name.ends_with("tests.rs"));
    let routes = read_files("../api/src/routes/pages", "rs");
    let plain = |text: String| {
        let text = text.split("#[cfg(test)]").next().unwrap_or_default();
        let lines = text.lines().filter(|line| !line.trim_start().starts_with("//"));
        lines.collect::<Vec<_>>().join("\n")
    };
    own.chain(routes).map(|(name, text)| (name, plain(text))).collect()
}

/// Messages of a language: key, and text with its continuation lines.
fn messages(language: Language) -> BTreeMap<String, String> {
    let mut found: BTreeMap<String, String> = BTreeMap::new();
    for (part, text) in catalogue_texts(language) {
        let read = FluentResource::try_new(text.to_owned());
        assert!(read.is_ok(), "{}/{part}.ftl: {:?}", language.code(), read.err());
        let mut last = None;
        for line in text.lines().filter(|line| !line.starts_with('#') && !line.is_empty()) {
            match line.split_once(" = ").filter(|_| !line.starts_with(' ')) {
                Some((key, value)) => {
                    let before = found.insert(key.to_owned(), value.to_owned());
                    assert!(before.is_none(), "{}/{part}.ftl has {key} twice", language.code());
                    last = Some(key.to_owned());
                }
                None => found.get_mut(last.as_ref().unwrap()).unwrap().push_str(line),
            }
        }
    }
    found
}

/// Names of the arguments of a message.
fn arguments(text: &str) -> BTreeSet<&str> {
    let end = |rest: &str| rest.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(rest.len());
    text.split('$').skip(1).map(|rest| &rest[..end(rest)]).collect()
}

/// Elements of the markup of a message, sorted.
fn elements(text: &str) -> Vec<&str> {
    let mut all: Vec<&str> = text
        .split('<')
        .skip(1)
        .map(|rest| rest.split(|c: char| !c.is_ascii_alphanumeric() && c != '/').next().unwrap())
        .collect();
    all.sort_unstable();
    all
}

#[test]
fn every_catalogue_has_the_same_messages_arguments_and_markup() {
    let english = messages(Language::English);
    let keys: Vec<String> = message_keys(Language::English);
    assert_eq!(keys.iter().collect::<BTreeSet<_>>(), english.keys().collect());
    for language in [Language::German, Language::Norwegian] {
        let own = messages(language);
        let missing: Vec<_> = english.keys().filter(|key| !own.contains_key(*key)).collect();
        let unknown: Vec<_> = own.keys().filter(|key| !english.contains_key(*key)).collect();
        assert!(missing.is_empty() && unknown.is_empty(), "lacks {missing:?}, has {unknown:?}");
        for (key, text) in &english {
            let code = language.code();
            // A sentence on trials is in the plural in one language, and a list in another.
            assert_eq!(arguments(&own[key]), arguments(text), "arguments of {key} in {code}");
            assert_eq!(elements(&own[key]), elements(text), "markup of {key} in {code}");
        }
    }
}

#[test]
fn every_message_is_used_and_every_used_one_exists() {
    let english = messages(Language::English);
    let sources: String = read_files("templates", "html")
        .into_iter()
        .chain(code_files())
        .map(|(_, text)| text)
        .collect();
    let literals = |call: &'static str| {
        let calls = sources.split(call).skip(1);
        calls.filter_map(|rest| rest.trim_start().strip_prefix('"')?.split('"').next())
    };
    for key in literals("say(").chain(literals("say_html(")) {
        assert!(english.contains_key(key), "the catalogues have no {key}");
    }
    let prefixes: BTreeSet<&str> = literals("say_word(").collect();
    let used = |key: &str| {
        let as_word = prefixes
            .iter()
            .any(|prefix| key.strip_prefix(prefix).is_some_and(|rest| rest.starts_with('-')));
        as_word || key.starts_with("chart-script-") || sources.contains(&format!("\"{key}\""))
    };
    let unused: Vec<_> = english.keys().filter(|key| !used(key)).collect();
    assert!(unused.is_empty(), "no page uses {unused:?}");
}

/// Text of a template that people read: what stands between elements, and in attributes with text.
fn visible_text(template: &str) -> Vec<String> {
    let markup = without_expressions(template);
    let mut found = Vec::new();
    for part in markup.split('<') {
        let (tag, text) = part.split_once('>').unwrap_or(("", part));
        // Examples of addresses and keys stand in elements of code.
        if !tag.starts_with("code") {
            found.push(text.to_owned());
        }
        for name in ["aria-label=\"", "title=\"", "placeholder=\"", "alt=\"", "data-label=\""] {
            let values = tag.split(name).skip(1);
            found.extend(values.map(|rest| rest.split('"').next().unwrap_or_default().to_owned()));
        }
    }
    found
}

/// Template without its expressions and statements, in which literals are words of the program.
fn without_expressions(template: &str) -> String {
    let mut plain = String::new();
    let mut rest = template;
    while let Some(at) = ["{{", "{%", "{#"].iter().filter_map(|open| rest.find(open)).min() {
        plain.push_str(&rest[..at]);
        let close = match &rest[at..at + 2] {
            "{{" => "}}",
            "{%" => "%}",
            _ => "#}",
        };
        rest = rest[at..].find(close).map_or("", |end| &rest[at + end + 2..]);
    }
    plain + rest
}

/// Literals of the expressions of a template, of which those with a space are text.
fn expression_literals(template: &str) -> Vec<&str> {
    let mut found = Vec::new();
    for open in ["{{", "{%"] {
        for rest in template.split(open).skip(1) {
            let close = if open == "{{" { "}}" } else { "%}" };
            let inside = rest.split(close).next().unwrap_or_default();
            found.extend(inside.split('"').skip(1).step_by(2));
        }
    }
    found
}

/// Literal without the arguments of its format.
fn without_arguments(literal: &str) -> String {
    let parts = literal.split('{').map(|part| part.split_once('}').map_or(part, |(_, rest)| rest));
    parts.collect()
}

/// Returns true for a literal of more than one word of letters.
fn is_sentence(literal: &str) -> bool {
    let word = |word: &str| {
        let plain = word.trim_matches(|c: char| !c.is_alphabetic());
        plain.chars().count() > 1 && plain.chars().all(char::is_alphabetic)
    };
    literal.split_whitespace().filter(|part| word(part)).count() > 1
}

#[test]
fn templates_have_no_text_beside_the_catalogues() {
    let mut wrong = Vec::new();
    for (name, template) in read_files("templates", "html") {
        for text in visible_text(&template) {
            let words = text.split(|c: char| !c.is_alphabetic()).filter(|word| word.len() > 2);
            let entity = |word: &str| text.contains(&format!("&{word};"));
            let open: Vec<_> =
                words.filter(|word| !UNTRANSLATED.contains(word) && !entity(word)).collect();
            if !open.is_empty() {
                wrong.push(format!("{name}: {open:?}"));
            }
        }
        let literals = expression_literals(&template).into_iter().filter(|text| is_sentence(text));
        wrong.extend(literals.map(|text| format!("{name}: {text}")));
    }
    assert!(wrong.is_empty(), "text for messages/*/*.ftl: {wrong:#?}");
}

#[test]
fn the_code_of_pages_has_no_sentences_beside_the_catalogues() {
    let mut wrong = Vec::new();
    for (name, code) in code_files() {
        // Attributes and paths of modules have no literals of several words.
        let code = code.replace("\\\"", "'").replace("'\"'", "' '");
        let literals = code.split('"').skip(1).step_by(2).map(without_arguments);
        for literal in literals.filter(|text| is_sentence(text)) {
            let known = CODE_LITERALS.iter().any(|(beginning, _)| literal.starts_with(beginning));
            if !known {
                wrong.push(format!("{name}: {literal}"));
            }
        }
    }
    assert!(wrong.is_empty(), "text for messages/*/*.ftl: {wrong:#?}");
}

#[test]
fn the_script_of_charts_has_the_words_of_the_catalogue() {
    let script = sistership_report::CHART_SCRIPT;
    let keys = message_keys(Language::English);
    for (key, text) in messages(Language::English) {
        if key.starts_with("chart-script-") {
            assert!(script.contains(&format!("\"{text}\"")), "the script has no {text} ({key})");
        }
    }
    assert!(keys.iter().any(|key| key.starts_with("chart-script-")));
    assert!(chart_words().is_none(), "the script speaks English by itself");
    let german = Language::German.run_blocking(|| chart_words().unwrap().to_owned());
    assert!(german.contains(r#""Play":"Abspielen""#), "{german}");
}

#[test]
fn messages_take_plurals_arguments_and_escape_markup() {
    let count = |language: Language, count: usize| {
        language.run_blocking(|| say("stored-heading").with("count", count).to_string())
    };
    assert_eq!(count(Language::English, 1), "1 trial is stored");
    assert_eq!(count(Language::German, 2), "2 Versuche sind gespeichert");
    assert_eq!(count(Language::Norwegian, 1), "1 prøve er lagret");
    let link = say_html("mapping-by-template").with("template", "<b>").to_string();
    assert!(link.contains("<strong>&#60;b&#62;</strong>"), "{link}");
    assert_eq!(say_word("job-state", "running"), "running");
    assert_eq!(Language::German.run_blocking(|| say_word("job-state", "running")), "läuft");
    assert_eq!(say_word("job-kind", "unheard of"), "unheard of");
}
