//! Names of ships, laws and models.

/// Error of a text that is not a name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` is not a valid name: use 1 to 64 lower-case letters, digits and hyphens, such as \
     `esso-osaka-3m`"
)]
pub struct InvalidName(pub String);

/// Checks that a name is made of lower-case letters, digits and hyphens, and starts with a letter
/// or digit.
///
/// # Errors
/// Returns an error that describes the form of a name.
pub fn check_slug(name: &str) -> Result<(), InvalidName> {
    let fits = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    if !name.is_empty() && name.len() <= 64 && name.chars().all(fits) && !name.starts_with('-') {
        return Ok(());
    }
    Err(InvalidName(name.to_owned()))
}
