//! Text types: names, words, remarks and values of headers.

use std::marker::PhantomData;
use std::str::FromStr;
use std::sync::LazyLock;

use regex::Regex;
use utoipa::openapi::RefOr;
use utoipa::openapi::schema::{ObjectBuilder, Schema, Type};

/// Rule of a type of text.
pub struct TextRule {
    /// Minimum length, characters.
    pub min: usize,
    /// Maximum length, characters.
    pub max: usize,
    /// Regular expression in the common syntax of Rust, ECMAScript and Python.
    pub pattern: &'static str,
    /// Description of valid texts.
    pub says: &'static str,
}

impl TextRule {
    /// Checks a text; `regex` is the compiled pattern.
    fn check(&self, regex: &LazyLock<Option<Regex>>, text: &str) -> Result<(), String> {
        let fits = (self.min..=self.max).contains(&text.chars().count());
        match fits && regex.as_ref().is_some_and(|regex| regex.is_match(text)) {
            true => Ok(()),
            false => Err(format!("must be {}", self.says)),
        }
    }

    fn schema(&self) -> RefOr<Schema> {
        let text = ObjectBuilder::new().schema_type(Type::String).pattern(Some(self.pattern));
        text.min_length(Some(self.min)).max_length(Some(self.max)).build().into()
    }
}

/// Declares a type of text with a rule.
macro_rules! text {
    ($(#[$about:meta])* $name:ident: $min:literal..=$max:literal, $pattern:expr, $says:literal) => {
        $(#[$about])*
        #[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
        pub struct $name(String);

        impl $name {
            const RULE: TextRule = TextRule { min: $min, max: $max, pattern: $pattern, says: $says };

            /// Returns the text.
            #[allow(dead_code, reason = "not every type is converted back")]
            pub fn into_string(self) -> String {
                self.0
            }
        }

        impl std::str::FromStr for $name {
            type Err = String;

            fn from_str(text: &str) -> Result<Self, String> {
                // Compiled once for each type; an invalid pattern would refuse every text.
                static REGEX: LazyLock<Option<Regex>> = LazyLock::new(|| Regex::new($pattern).ok());
                Self::RULE.check(&REGEX, text).map(|()| Self(text.to_owned()))
            }
        }

        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                from.deserialize_str(Written(PhantomData))
            }
        }

        impl std::ops::Deref for $name {
            type Target = str;

            fn deref(&self) -> &str {
                &self.0
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                out.write_str(&self.0)
            }
        }

        impl utoipa::PartialSchema for $name {
            fn schema() -> RefOr<Schema> {
                Self::RULE.schema()
            }
        }

        impl utoipa::ToSchema for $name {}
    };
}

text! {
    /// The name of a ship, a law or a model: `sistership_model::name::check_slug`.
    Name: 1..=64, "^[a-z0-9][a-z0-9-]*$", "a name of 1 to 64 lower-case letters, digits and \
        hyphens, such as `esso-osaka-3m`"
}
text! {
    /// A tag, or the name of a family: one word in any script.
    Word: 1..=200, r"^[^\s/.\x00-\x1f\x7f-\x9f][^\s/\x00-\x1f\x7f-\x9f]*$",
        "a word of 1 to 200 characters without white space, control characters and slashes that \
         does not begin with a full stop"
}
text! {
    /// The id of a trial, a job, a report or a refinement of a family.
    Id: 1..=64, "^[0-9A-Za-z-]+$", "an id of 1 to 64 letters, digits and hyphens, as the server \
        gives them"
}
text! {
    /// The name of a user: `sistership_auth::check_name`.
    UserName: 1..=64, "^[a-z0-9][a-z0-9._@-]*$",
        "a name of 1 to 64 lower-case letters, digits, `.`, `_`, `@` and `-` that starts with a \
         letter or digit"
}
text! {
    /// An issuer or a subject of OpenID Connect.
    Line: 1..=255, r"^[^\x00-\x1f\x7f-\x9f]+$", "a text of 1 to 255 characters without control \
        characters"
}
text! {
    /// The prefix of a service key.
    KeyPrefix: 12..=12, "^[0-9a-f]{12}$", "the first 12 hexadecimal digits of a service key after \
                                           `sis_`"
}
text! {
    /// A password that is set: `sistership_auth::check_password`.
    Password: 15..=256, r"^[^\x00]*$", "a password of 15 to 256 characters without NUL, such as a \
                                        sentence"
}
text! {
    /// Author or subject of an audit entry.
    AuditName: 1..=300, r"^[^\s\x00-\x1f\x7f-\x9f]+$", "a name of 1 to 300 characters, such as \
        `ann` or `ship:kvlcc2`"
}
text! {
    /// Name of a version for people.
    ModelName: 1..=129, "^[a-z0-9][a-z0-9-]{0,63}(/[a-z0-9][a-z0-9-]{0,63})?$",
        "`ship` (its champion), `ship/number` or `ship/alias`, in lower-case letters, digits and \
         hyphens"
}
text! {
    /// A stored remark of a person: a reason, an origin, a name.
    Remark: 1..=1000, r"^[^\x00]*[^\s\x00][^\x00]*$", "1 to 1000 characters that are not all white \
        space, without NUL"
}
text! {
    /// A condition of trials in words, as an acceptance summary prints it.
    ConditionText: 1..=300, r"^[^\x00]*[^\s\x00][^\x00]*$", "1 to 300 characters that are not all \
        white space, without NUL"
}
text! {
    /// A date of the calendar.
    CalendarDate: 10..=10, "^[0-9]{4}-(0[1-9]|1[0-2])-(0[1-9]|[12][0-9]|3[01])$",
        "a date such as `2026-11-29`"
}
text! {
    /// Name of a person under an acceptance summary.
    PersonName: 1..=200, r"^[^\x00]*[^\s\x00][^\x00]*$", "a name of 1 to 200 characters that are not \
        all white space, without NUL"
}
text! {
    /// URL of a web server.
    WebAddress: 10..=2000, r"^https?://[^\s\x00-\x1f\x7f-\x9f]+$", "a URL of 10 to 2000 \
                                                                    characters, such as \
                                                                    `https://example.com/hook`"
}
text! {
    /// Address of a receiver of events: a web server, or a mail box.
    ReceiverAddress: 10..=2000, r"^(https?://[^\s\x00-\x1f\x7f-\x9f]+|mailto:[^\s\x00-\x1f\x7f-\x9f@]+@[^\s\x00-\x1f\x7f-\x9f@]+)$",
        "a URL of 10 to 2000 characters, such as `https://example.com/hook` or \
         `mailto:ann@example.com`"
}
text! {
    /// The name of a file.
    FileName: 1..=200, r"^[^\x00-\x1f\x7f-\x9f]+$", "a name of 1 to 200 characters without control \
        characters"
}
text! {
    /// Cursor: `next` of the previous page.
    Cursor: 1..=4096, "^[0-9A-Za-z_-]+$", "the value `next` of a page of this list; omit it for \
                                           the first page"
}
text! {
    /// `Idempotency-Key`.
    RequestKey: 1..=200, "^[!-.0-~]+$", "1 to 200 letters, digits and marks (no slash), such as a \
        UUID"
}
text! {
    /// `If-Match` and `If-None-Match`.
    EntityTags: 1..=2000, r#"^[ \t]*(\*|(W/)?"[!#-+\x2d-~]+"([ \t]*,[ \t]*(W/)?"[!#-+\x2d-~]+")*)[ \t]*$"#,
        "`*` or the quoted ETag of the last answer, such as \"3\""
}

/// Visitor that checks the text, so that libraries know the field of an error.
struct Written<T>(PhantomData<T>);

impl<T: FromStr<Err = String>> serde::de::Visitor<'_> for Written<T> {
    type Value = T;

    fn expecting(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.write_str("a string")
    }

    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<T, E> {
        text.parse().map_err(E::custom)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn every_pattern_compiles_and_takes_what_its_words_say() {
        assert!(
            "esso-osaka-3m".parse::<Name>().is_ok()
                && "-a".parse::<Name>().is_err()
                && "A".parse::<Name>().is_err()
        );
        assert!(
            "größe".parse::<Word>().is_ok()
                && "two words".parse::<Word>().is_err()
                && "..".parse::<Word>().is_err()
        );
        assert!("01a-F".parse::<Id>().is_ok() && "a/b".parse::<Id>().is_err());
        assert!("a/1".parse::<ModelName>().is_ok() && "a/1/2".parse::<ModelName>().is_err());
        assert!("because\nof it".parse::<Remark>().is_ok() && " \n".parse::<Remark>().is_err());
        assert!(
            "sailed/1 a.csv".parse::<FileName>().is_ok() && "a\u{7}".parse::<FileName>().is_err()
        );
        assert!("eyJ-_".parse::<Cursor>().is_ok() && "=".parse::<Cursor>().is_err());
        assert!("a.b".parse::<RequestKey>().is_ok() && "a/b".parse::<RequestKey>().is_err());
        for tags in ["*", "\"3\"", "W/\"3.a\" , \"4\"", " \"-\" "] {
            assert!(tags.parse::<EntityTags>().is_ok(), "{tags}");
        }
        for address in ["https://example.com/a@b/hook", "mailto:ann@example.com"] {
            assert!(address.parse::<ReceiverAddress>().is_ok(), "{address}");
        }
        assert!("mailto:a@b.example@c".parse::<ReceiverAddress>().is_err());
        assert!(
            "2026-02-30".parse::<CalendarDate>().is_ok()
                && "2026-13-01".parse::<CalendarDate>().is_err()
        );
        assert!("3".parse::<EntityTags>().is_err() && "\"\"".parse::<EntityTags>().is_err());
        assert_eq!(
            "x".repeat(65).parse::<Name>().unwrap_err(),
            format!("must be {}", Name::RULE.says)
        );
        assert!(
            "ü".repeat(200).parse::<Word>().is_ok() && "ü".repeat(201).parse::<Word>().is_err()
        );
    }

    #[test]
    fn a_name_is_what_the_files_call_one() {
        for name in ["a", "0-", "-a", "A", "", "a_b", "é", &"a".repeat(64), &"a".repeat(65), "a\n"]
        {
            assert_eq!(
                Name::from_str(name).is_ok(),
                sistership_model::name::check_slug(name).is_ok(),
                "{name:?}"
            );
        }
    }
}
