//! Messages of the catalogues with their arguments.

use std::borrow::Cow;
use std::fmt;

use askama::filters::{Html, HtmlSafe, escape};
use fluent_bundle::{FluentArgs, FluentValue};

use super::catalogue::{has_message, write_message};

/// Message of a catalogue: it is written in the language of the present request.
#[derive(Debug)]
pub struct Message {
    key: Cow<'static, str>,
    arguments: Vec<(&'static str, ArgumentValue)>,
}

/// Value of an argument.
#[derive(Debug)]
pub enum ArgumentValue {
    /// A text.
    Text(String),
    /// A whole number, by which a plural is chosen.
    Number(i64),
}

/// Message that contains markup: its arguments are escaped, its own text is not.
#[derive(Debug)]
pub struct MarkupMessage(Message);

/// Returns the message of a key.
pub fn say(key: &'static str) -> Message {
    Message::with_key(key)
}

/// Returns the message of a key whose text contains markup.
pub fn say_html(key: &'static str) -> MarkupMessage {
    MarkupMessage(say(key))
}

/// Returns the word for a name in data, by the key `prefix-name`; the name itself if the catalogues
/// lack it, as laws, effects and channels of ships may have any name.
pub fn say_word(prefix: &str, name: &str) -> String {
    let key = word_key(prefix, name);
    // A name that people have given is no key, and stays as it is.
    if has_message(&key) { Message::with_key(key).to_string() } else { name.to_owned() }
}

/// Returns true if the catalogues have a word for a name in data.
pub(crate) fn has_word(prefix: &str, name: &str) -> bool {
    has_message(&word_key(prefix, name))
}

/// Key of a word: the catalogues have letters, digits and hyphens only.
fn word_key(prefix: &str, name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '-' };
    format!("{prefix}-{name}").chars().map(plain).collect()
}

impl Message {
    pub(super) fn with_key(key: impl Into<Cow<'static, str>>) -> Self {
        Self { key: key.into(), arguments: Vec::new() }
    }

    /// Returns the message with an argument.
    #[must_use]
    pub fn with(mut self, name: &'static str, value: impl MessageArgument) -> Self {
        self.arguments.push((name, value.to_value()));
        self
    }
}

impl MarkupMessage {
    /// Returns the message with an argument, which is escaped.
    #[must_use]
    pub fn with(mut self, name: &'static str, value: impl MessageArgument) -> Self {
        // Numbers have no markup, and a text of a number would choose no plural.
        let value = match value.to_value() {
            ArgumentValue::Text(text) => ArgumentValue::Text(escape_text(&text)),
            number => number,
        };
        self.0.arguments.push((name, value));
        self
    }
}

fn escape_text(text: &str) -> String {
    escape(text, Html).map_or_else(|_| String::new(), |escaped| escaped.to_string())
}

impl fmt::Display for Message {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = |value: &'_ ArgumentValue| match value {
            ArgumentValue::Text(text) => FluentValue::from(text.clone()),
            ArgumentValue::Number(number) => FluentValue::from(*number),
        };
        // Written at last: only then is the language of the request known.
        let arguments = self.arguments.iter().map(|(name, of)| (*name, value(of)));
        write_message(out, &self.key, &FluentArgs::from_iter(arguments))
    }
}

impl fmt::Display for MarkupMessage {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(out)
    }
}

impl HtmlSafe for MarkupMessage {}

impl From<Message> for String {
    fn from(message: Message) -> Self {
        message.to_string()
    }
}

/// Argument of a message.
pub trait MessageArgument {
    /// Returns the value for the catalogue.
    fn to_value(&self) -> ArgumentValue;
}

macro_rules! text_arguments {
    ($($kind:ty),+) => {
        $(impl MessageArgument for $kind {
            fn to_value(&self) -> ArgumentValue {
                ArgumentValue::Text(self.to_string())
            }
        })+
    };
}
text_arguments!(str, String, Message);

impl MessageArgument for i64 {
    fn to_value(&self) -> ArgumentValue {
        ArgumentValue::Number(*self)
    }
}

impl MessageArgument for u32 {
    fn to_value(&self) -> ArgumentValue {
        ArgumentValue::Number(i64::from(*self))
    }
}

impl MessageArgument for usize {
    fn to_value(&self) -> ArgumentValue {
        ArgumentValue::Number(i64::try_from(*self).unwrap_or(i64::MAX))
    }
}

impl<T: MessageArgument + ?Sized> MessageArgument for &T {
    fn to_value(&self) -> ArgumentValue {
        (**self).to_value()
    }
}
