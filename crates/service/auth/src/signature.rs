//! Signatures of messages: HMAC-SHA256 (RFC 2104, FIPS 198-1).

use hmac::{Hmac, KeyInit as _, Mac as _};
use sha2::Sha256;

use crate::secret::to_hex;

/// Returns the HMAC-SHA256 of a message under a key, in hexadecimal.
pub fn sign_message(key: &str, message: &[u8]) -> String {
    // HMAC accepts keys of any length, so that this does not fail.
    let Ok(mut mac) = Hmac::<Sha256>::new_from_slice(key.as_bytes()) else { return String::new() };
    mac.update(message);
    to_hex(&mac.finalize().into_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signatures_are_those_of_the_standard() {
        // RFC 4231, test case 2.
        assert_eq!(
            sign_message("Jefe", b"what do ya want for nothing?"),
            "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843"
        );
        assert_ne!(sign_message("Jefe", b"a"), sign_message("Jefe", b"b"));
    }
}
