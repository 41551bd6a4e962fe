//! What a form or a query has sent.

use crate::error::{PageError, Result};

/// Fields in the order in which they came; one may be there several times. What is left empty
/// counts as absent.
#[derive(Debug, Clone, Default)]
pub struct Fields(Vec<(String, String)>);

impl From<Vec<(String, String)>> for Fields {
    fn from(pairs: Vec<(String, String)>) -> Self {
        Self(pairs)
    }
}

impl Fields {
    /// The text of a field, without spaces about it.
    pub fn text(&self, name: &str) -> Option<&str> {
        let own = self.0.iter().filter(|(known, _)| known == name);
        own.map(|(_, text)| text.trim()).find(|text| !text.is_empty())
    }

    /// The texts of a field that may be there several times.
    pub fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a str> {
        let own = self.0.iter().filter(move |(known, _)| known == name);
        own.map(|(_, text)| text.trim()).filter(|text| !text.is_empty())
    }

    /// The text of a field that must be there.
    ///
    /// # Errors
    /// It is not.
    pub fn needed(&self, name: &str) -> Result<&str> {
        self.text(name).ok_or_else(|| PageError::invalid(name, "is empty; fill it in"))
    }

    /// A number.
    ///
    /// # Errors
    /// The text is no finite number.
    pub fn number(&self, name: &str) -> Result<Option<f64>> {
        let read = |text: &str| {
            let number = text.replace(',', ".").parse().ok();
            number.filter(|number: &f64| number.is_finite()).ok_or_else(|| {
                PageError::invalid(name, format!("`{text}` is no number; write one such as 12.5"))
            })
        };
        self.text(name).map(read).transpose()
    }

    /// A number within a range, or the default where there is none.
    ///
    /// # Errors
    /// It is no number, or outside.
    pub fn within(&self, name: &str, range: (f64, f64), default: f64) -> Result<f64> {
        let number = self.number(name)?.unwrap_or(default);
        match (range.0..=range.1).contains(&number) {
            true => Ok(number),
            false => Err(PageError::invalid(
                name,
                format!("{number} is outside {} to {}", range.0, range.1),
            )),
        }
    }

    /// A whole number.
    ///
    /// # Errors
    /// It is missing or none.
    pub fn whole(&self, name: &str) -> Result<i64> {
        let text = self.needed(name)?;
        text.parse().map_err(|_| PageError::invalid(name, format!("`{text}` is no whole number")))
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
        let fields = Fields::from(pairs.to_vec());
        assert_eq!((fields.number("a").unwrap(), fields.text("b")), (Some(1.5), None));
        assert_eq!(fields.all("v").collect::<Vec<_>>(), ["1", "2"]);
        assert!(fields.number("c").unwrap_err().to_string().starts_with("c: "));
        assert!(fields.number("d").is_err() && fields.whole("a").is_err());
        assert!(fields.within("a", (0.0, 1.0), 0.0).is_err());
        assert_eq!(fields.within("b", (0.0, 1.0), 0.5).unwrap(), 0.5);
    }
}
