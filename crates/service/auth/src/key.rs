//! Service keys, the credentials of programs. The first part is shown in lists and finds the key;
//! the rest is secret, and only the hash of the whole key is stored.
//!
//! A key has 256 random bits and cannot be guessed, so that a fast hash is enough: Argon2id is for
//! passwords, which people choose, and would cost some 20 ms and 19 MiB for each request.

use crate::secret::{constant_time_eq, hash_text, random_secret, to_hex};

const MARK: &str = "sis_";
const PREFIX: usize = 12;

/// A service key in its stored form.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ServiceKey {
    /// Public first part, by which the key is found and shown.
    pub prefix: String,
    /// SHA-256 of the whole key, hexadecimal.
    pub sha256: String,
}

/// The text of a service key, shown to its owner once.
#[derive(Clone, PartialEq, Eq)]
pub struct KeyText(String);

impl KeyText {
    /// Creates a random key.
    ///
    /// # Errors
    /// Returns an error if the system gives no random numbers.
    pub fn new() -> Result<Self, getrandom::Error> {
        // Two hexadecimal digits a byte.
        let mut bytes = [0; PREFIX / 2];
        getrandom::fill(&mut bytes)?;
        Ok(Self(format!("{MARK}{}_{}", to_hex(&bytes), random_secret()?)))
    }

    /// Returns the text.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Returns the stored form of the key.
    pub fn to_stored(&self) -> ServiceKey {
        let prefix = ServiceKey::parse_prefix(&self.0).unwrap_or_default().to_owned();
        ServiceKey { prefix, sha256: to_hex(&hash_text(&self.0)) }
    }
}

impl ServiceKey {
    /// Returns the prefix of a text, if it has the form of a service key.
    pub fn parse_prefix(text: &str) -> Option<&str> {
        let (prefix, rest) = text.strip_prefix(MARK)?.split_once('_')?;
        let hexadecimal = |byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f');
        let fits = prefix.len() == PREFIX && prefix.bytes().all(hexadecimal) && !rest.is_empty();
        fits.then_some(prefix)
    }

    /// Returns true if a text is this key; the comparison takes constant time.
    pub fn matches_text(&self, presented: &str) -> bool {
        constant_time_eq(self.sha256.as_bytes(), to_hex(&hash_text(presented)).as_bytes())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_key_is_found_by_its_prefix_and_told_by_its_hash() {
        let text = KeyText::new().unwrap();
        let kept = text.to_stored();
        assert_eq!(ServiceKey::parse_prefix(text.as_str()), Some(kept.prefix.as_str()));
        assert!(kept.matches_text(text.as_str()) && !kept.sha256.contains(text.as_str()));
        let other = format!("{}x", text.as_str());
        assert!(
            !kept.matches_text(&other)
                && !kept.matches_text("")
                && !kept.matches_text(KeyText::new().unwrap().as_str())
        );
        for wrong in ["", "sis_", "sis_0123456789ab_", "sis_0123_x", "sis_0123456789aB_x", "secret"]
        {
            assert_eq!(ServiceKey::parse_prefix(wrong), None, "{wrong}");
        }
    }
}
