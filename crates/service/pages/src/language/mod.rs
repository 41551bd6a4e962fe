//! The language of a page: the one that a person chose, else one that the browser asks for, else
//! English; and the catalogues of messages in each.

mod catalogue;
mod chart_words;
mod message;

use std::future::Future;

pub use message::{
    ArgumentValue, MarkupMessage, Message, MessageArgument, say, say_html, say_word,
};

pub(crate) use chart_words::chart_words;
pub(crate) use message::has_word;

tokio::task_local! {
    static CURRENT: Language;
}

/// Language of a page.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Language {
    /// English.
    #[default]
    English,
    /// German.
    German,
    /// Norwegian, Bokmål.
    Norwegian,
}

impl Language {
    /// All languages, the default first.
    pub const ALL: [Self; 3] = [Self::English, Self::German, Self::Norwegian];

    /// Code of the language (BCP 47).
    pub fn code(self) -> &'static str {
        match self {
            Self::English => "en",
            Self::German => "de",
            Self::Norwegian => "nb",
        }
    }

    /// Name of the language in itself.
    pub fn own_name(self) -> &'static str {
        match self {
            Self::English => "English",
            Self::German => "Deutsch",
            Self::Norwegian => "Norsk bokmål",
        }
    }

    /// Returns the language of a code.
    pub fn by_code(code: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|language| language.code() == code)
    }

    /// Returns the language of a request: `chosen` is the code that a person has chosen, `accepted`
    /// the header `Accept-Language`.
    pub fn from_request(chosen: Option<&str>, accepted: Option<&str>) -> Self {
        let chosen = chosen.and_then(Self::by_code);
        chosen.or_else(|| accepted.and_then(Self::from_accepted)).unwrap_or_default()
    }

    /// Returns the known language of the highest quality (RFC 9110, section 12.5.4); of equal ones
    /// the first.
    fn from_accepted(accepted: &str) -> Option<Self> {
        let ranges = accepted.split(',').filter_map(parse_range);
        let mut best: Option<(Self, f64)> = None;
        for (language, quality) in ranges {
            // A quality of zero refuses a language.
            if quality > 0.0 && best.is_none_or(|(_, most)| quality > most) {
                best = Some((language, quality));
            }
        }
        best.map(|(language, _)| language)
    }

    /// Language of the present request; English outside of one.
    pub fn current() -> Self {
        // Jobs and tests write outside of any request.
        CURRENT.try_with(|language| *language).unwrap_or_default()
    }

    /// Runs a future whose messages are in this language. A task-local does not follow
    /// `tokio::spawn`, nor the body of an answer that is still being written.
    pub async fn run_scoped<T>(self, work: impl Future<Output = T>) -> T {
        CURRENT.scope(self, work).await
    }

    /// Runs a closure whose messages are in this language.
    pub fn run_blocking<T>(self, work: impl FnOnce() -> T) -> T {
        CURRENT.sync_scope(self, work)
    }

    /// Returns true for the language of the present request.
    pub(crate) fn is_current(&self) -> bool {
        *self == Self::current()
    }

    /// Decimal mark.
    pub(crate) fn decimal_mark(self) -> char {
        match self {
            Self::English => '.',
            Self::German | Self::Norwegian => ',',
        }
    }
}

/// Parses a range such as `de-AT;q=0.8`; `None` if no catalogue speaks the language. Readers of
/// Nynorsk, and those who name no written form of Norwegian, read Bokmål.
fn parse_range(text: &str) -> Option<(Language, f64)> {
    let mut parts = text.split(';').map(str::trim);
    // Regions do not differ in the catalogues.
    let primary = parts.next()?.split('-').next()?.to_ascii_lowercase();
    let language = match primary.as_str() {
        "no" | "nn" => Language::Norwegian,
        "*" => Language::English,
        code => Language::by_code(code)?,
    };
    let quality =
        parts.find_map(|part| part.strip_prefix("q=")).map_or(Some(1.0), |q| q.parse().ok());
    Some((language, quality?))
}

#[cfg(test)]
mod tests;

#[cfg(test)]
mod choice {
    use super::*;

    #[test]
    fn a_choice_counts_more_than_the_browser_and_its_qualities_decide() {
        let of = |accepted: &str| Language::from_request(None, Some(accepted)).code();
        assert_eq!(of("de-AT,de;q=0.9,en;q=0.8"), "de");
        assert_eq!(of("fr, en;q=0.5, nn;q=0.7"), "nb");
        assert_eq!(of("no"), "nb");
        assert_eq!(of("de;q=0, *;q=0.1"), "en");
        assert_eq!(of("fr;q=1, ja"), "en");
        assert_eq!(of("de;q=wrong"), "en");
        assert_eq!(Language::from_request(Some("nb"), Some("de")).code(), "nb");
        assert_eq!(Language::from_request(Some("xx"), Some("de")).code(), "de");
        assert_eq!(Language::from_request(None, None).code(), "en");
    }
}
