//! Valid names of users.

/// Reserved names, under which the program itself, or a person without an account, appears in the
/// audit.
const RESERVED: [&str; 6] =
    ["sistership", "server-key", "local", "command-line", "admin-key", "openid"];

/// Returns true if a name is reserved, so that no user may have it.
pub fn is_reserved_name(name: &str) -> bool {
    RESERVED.contains(&name)
}

/// Checks a user's name: 1 to 64 lower-case letters, digits, `.`, `-`, `_` and `@`, the first a
/// letter or digit.
///
/// # Errors
/// Returns a message that states the valid form.
pub fn check_name(name: &str) -> Result<(), String> {
    let allowed = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || ".-_@".contains(c);
    let first = name.chars().next().is_some_and(|c| c.is_ascii_alphanumeric());
    match first && name.len() <= 64 && name.chars().all(allowed) {
        true if is_reserved_name(name) => {
            Err(format!("`{name}` is reserved for the program; choose another name"))
        }
        true => Ok(()),
        false => {
            Err("must be 1 to 64 lower-case letters, digits, `.`, `-`, `_` or `@`, and start with \
                 a letter or digit"
                .to_owned())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_checked() {
        for name in ["ann", "a.b-c_d", "ann@yard.example", "7"] {
            assert_eq!(check_name(name), Ok(()), "{name}");
        }
        let long = "a".repeat(65);
        for name in ["", "Ann", "-a", "a b", "key:1", "a/b", "local", "sistership", &long] {
            assert!(check_name(name).is_err(), "{name}");
        }
    }
}
