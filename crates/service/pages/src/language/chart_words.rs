//! Words of the script of charts.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use super::catalogue::message_keys;
use super::{Language, Message};

/// Prefix of the keys of words that the script of charts writes.
const CHART_PREFIX: &str = "chart-script-";

/// Words of the script of charts in the present language by their English form, JSON that can stand
/// in a script element; `None` in English, which the script speaks by itself.
pub(crate) fn chart_words() -> Option<&'static str> {
    static WORDS: LazyLock<[Option<String>; 3]> =
        LazyLock::new(|| Language::ALL.map(|language| language.run_blocking(collect_chart_words)));
    WORDS[Language::current() as usize].as_deref()
}

fn collect_chart_words() -> Option<String> {
    let language = Language::current();
    let text = |language: Language, key: &str| {
        let message = Message::with_key(key.to_owned());
        language.run_blocking(|| message.to_string())
    };
    let keys =
        message_keys(Language::English).into_iter().filter(|key| key.starts_with(CHART_PREFIX));
    let words: BTreeMap<String, String> =
        keys.map(|key| (text(Language::English, &key), text(language, &key))).collect();
    // A script element ends at the first `</`, whatever the quotes.
    let json = || serde_json::to_string(&words).ok().map(|json| json.replace('<', "\\u003c"));
    (language != Language::English).then(json).flatten()
}
