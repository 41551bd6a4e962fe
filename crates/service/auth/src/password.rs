//! Passwords: Argon2id (RFC 9106) with 19 MiB, two passes and one lane, the default of the library
//! and the minimum of OWASP's Password Storage Cheat Sheet.

use crate::guessable::independent_parts;
use argon2::Argon2;
use argon2::password_hash::phc::PasswordHash;
use argon2::password_hash::{PasswordHasher as _, PasswordVerifier as _};

/// Minimum length of a password, characters: NIST SP 800-63B-4, 3.1.1.2, requires 15 where it is
/// the only factor.
const FEWEST: usize = 15;
/// Maximum length, bytes: bounds the work of hashing.
const MOST: usize = 256;

/// Minimum number of independent guesses: eight of the 26 letters alone are 2e11 guesses, too many
/// at one each 12 s (`attempts`).
const FEWEST_PARTS: usize = 8;

/// Error of hashing a password.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the password could not be hashed: {0}")]
pub struct PasswordError(String);

/// Checks a new password.
///
/// # Errors
/// Returns a message that states what would be right.
pub fn check_password(password: &str) -> Result<(), String> {
    let characters = password.chars().count();
    if characters < FEWEST || password.len() > MOST {
        return Err(format!(
            "must have at least {FEWEST} characters and at most {MOST} bytes; spaces are allowed, \
             so that a sentence can be used"
        ));
    }
    if independent_parts(password) < FEWEST_PARTS {
        return Err(
            "is easy to guess: it consists of repetitions, sequences or common words; use \
                    a sentence of your own"
                .to_owned(),
        );
    }
    Ok(())
}

/// Hashes a password with a random salt; returns a PHC string.
///
/// # Errors
/// Returns an error if the system gives no random numbers or no memory.
pub fn hash_password(password: &str) -> Result<String, PasswordError> {
    let hash = Argon2::default().hash_password(password.as_bytes());
    hash.map(|hash| hash.to_string()).map_err(|error| PasswordError(error.to_string()))
}

/// Returns true if a password matches a hash. It takes some 20 ms and 19 MiB.
pub fn verify_password(password: &str, hash: &str) -> bool {
    password.len() <= MOST
        && PasswordHash::new(hash)
            .is_ok_and(|hash| Argon2::default().verify_password(password.as_bytes(), &hash).is_ok())
}

/// Takes as long as [`verify_password`], for a user without a password, so that the time does not
/// reveal which users have one.
pub fn verify_unknown(password: &str) {
    // As long as a valid password at most, so that the time does not depend on its length.
    let shortened = password.get(..MOST).unwrap_or(password);
    std::hint::black_box(hash_password(shortened).is_ok());
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_password_is_told_by_its_hash_alone() {
        let hash = hash_password("a sentence of mine").unwrap();
        assert!(hash.starts_with("$argon2id$v=19$m=19456,t=2,p=1$"), "{hash}");
        assert!(verify_password("a sentence of mine", &hash));
        assert!(!verify_password("a sentence of yours", &hash) && !verify_password("", &hash));
        assert!(!verify_password("a sentence of mine", "no hash"));
        assert_ne!(hash, hash_password("a sentence of mine").unwrap(), "each has its own salt");
        verify_unknown("anything");
    }

    #[test]
    fn short_passwords_are_refused() {
        assert!(check_password("fourteen chars").is_err() && check_password("").is_err());
        assert!(check_password("fifteen charact").is_ok());
        assert!(check_password(&"a".repeat(257)).is_err());
    }

    #[test]
    fn passwords_that_everybody_tries_are_refused() {
        for password in ["aaaaaaaaaaaaaaa", "password1234567", "Qwertyuiop123456"] {
            assert!(check_password(password).is_err_and(|why| why.contains("easy to guess")));
        }
        assert!(check_password("a long sentence of its own").is_ok());
    }
}
