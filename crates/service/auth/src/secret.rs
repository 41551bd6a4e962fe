//! Random secrets, hashes, and comparison in constant time.

use base64::Engine as _;
use base64::prelude::BASE64_URL_SAFE_NO_PAD;
use sha2::{Digest as _, Sha256};
use subtle::ConstantTimeEq as _;

/// Returns a secret of 256 random bits, as text of 43 letters, digits, `-` and `_`.
///
/// # Errors
/// Returns an error if the system gives no random numbers.
pub fn random_secret() -> Result<String, getrandom::Error> {
    let mut bytes = [0; 32];
    getrandom::fill(&mut bytes)?;
    Ok(BASE64_URL_SAFE_NO_PAD.encode(bytes))
}

/// Returns the SHA-256 of a text.
pub fn hash_text(text: &str) -> [u8; 32] {
    Sha256::digest(text.as_bytes()).into()
}

/// Returns bytes in lower-case hexadecimal.
pub fn to_hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Returns true if two secrets are equal, in a time that does not depend on the position of a
/// difference.
pub fn constant_time_eq(a: &[u8], b: &[u8]) -> bool {
    a.ct_eq(b).into()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn secrets_are_long_and_differ() {
        let (a, b) = (random_secret().unwrap(), random_secret().unwrap());
        assert!(a != b && a.len() == 43);
    }

    #[test]
    fn hashes_are_those_of_the_standard() {
        // NIST FIPS 180-2, appendix B.1.
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(to_hex(&hash_text("abc")), abc);
        assert!(
            constant_time_eq(&hash_text("abc"), &hash_text("abc"))
                && !constant_time_eq(&hash_text("abc"), &hash_text("abd"))
        );
    }
}
