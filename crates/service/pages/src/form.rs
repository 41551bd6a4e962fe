//! Fields of a form or a query.

use crate::error::{PageError, Result};
use crate::language::say;
use crate::numbers::format_plain;

/// Fields in the order in which they came; a field may occur several times. An empty field counts
/// as absent.
#[derive(Debug, Clone, Default)]
pub struct FormFields(Vec<(String, String)>);

impl From<Vec<(String, String)>> for FormFields {
    fn from(pairs: Vec<(String, String)>) -> Self {
        Self(pairs)
    }
}

impl FormFields {
    /// Text of a field, without spaces around it.
    pub fn get_text(&self, name: &str) -> Option<&str> {
        let own = self.0.iter().filter(|(known, _)| known == name);
        own.map(|(_, text)| text.trim()).find(|text| !text.is_empty())
    }

    /// Returns true if no field has a text.
    pub fn is_empty(&self) -> bool {
        self.0.iter().all(|(_, text)| text.trim().is_empty())
    }

    /// Texts of a field that may occur several times.
    pub fn get_texts<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a str> {
        let own = self.0.iter().filter(move |(known, _)| known == name);
        own.map(|(_, text)| text.trim()).filter(|text| !text.is_empty())
    }

    /// Returns the text of a required field.
    ///
    /// # Errors
    /// Returns an error if the field is absent.
    pub fn required_text(&self, name: &str) -> Result<&str> {
        self.get_text(name).ok_or_else(|| PageError::invalid_field(name, say("form-empty")))
    }

    /// Returns a number, `None` if the field is absent; a decimal comma is accepted.
    ///
    /// # Errors
    /// Returns an error if the text is no finite number.
    pub fn optional_number(&self, name: &str) -> Result<Option<f64>> {
        let read = |text: &str| {
            // `inf` and `nan` parse as numbers.
            let number = text.replace(',', ".").parse().ok();
            number.filter(|number: &f64| number.is_finite()).ok_or_else(|| {
                PageError::invalid_field(name, say("form-not-a-number").with("text", text))
            })
        };
        self.get_text(name).map(read).transpose()
    }

    /// Returns a number within a range, or the default if the field is absent.
    ///
    /// # Errors
    /// Returns an error if the text is no number, or outside the range.
    pub fn number_within(&self, name: &str, range: (f64, f64), default: f64) -> Result<f64> {
        let number = self.optional_number(name)?.unwrap_or(default);
        match (range.0..=range.1).contains(&number) {
            true => Ok(number),
            false => {
                let outside = say("form-outside").with("low", format_plain(range.0));
                let outside = outside.with("high", format_plain(range.1));
                Err(PageError::invalid_field(name, outside.with("number", format_plain(number))))
            }
        }
    }

    /// Returns a whole number.
    ///
    /// # Errors
    /// Returns an error if the field is absent or no whole number.
    pub fn whole_number(&self, name: &str) -> Result<i64> {
        let text = self.required_text(name)?;
        let wrong = || PageError::invalid_field(name, say("form-not-whole").with("text", text));
        text.parse().map_err(|_| wrong())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn fields_are_read_or_named() {
        let pairs = [("a", " 1,5 "), ("b", ""), ("c", "x"), ("d", "inf"), ("v", "1"), ("v", "2")];
        let pairs = pairs.map(|(name, text)| (name.to_owned(), text.to_owned()));
        let fields = FormFields::from(pairs.to_vec());
        assert_eq!((fields.optional_number("a").unwrap(), fields.get_text("b")), (Some(1.5), None));
        assert_eq!(fields.get_texts("v").collect::<Vec<_>>(), ["1", "2"]);
        assert!(fields.optional_number("c").unwrap_err().to_string().starts_with("c: "));
        assert!(fields.optional_number("d").is_err() && fields.whole_number("a").is_err());
        assert!(fields.number_within("a", (0.0, 1.0), 0.0).is_err());
        assert_eq!(fields.number_within("b", (0.0, 1.0), 0.5).unwrap(), 0.5);
    }
}
