//! Why a command ends without success, and the exit status that says so.

use sistership_model::FileError;

/// Why a command ends without success.
#[derive(Debug, PartialEq)]
pub enum Failure {
    /// The call is wrong: exit status 2.
    Call(String),
    /// The data or the model says no: exit status 1.
    Refused(String),
    /// The same, with the reason already printed.
    Told,
}

impl Failure {
    /// The exit status.
    pub fn status(&self) -> u8 {
        match self {
            Self::Call(_) => 2,
            Self::Refused(_) | Self::Told => 1,
        }
    }

    /// What is still to be said.
    pub fn message(&self) -> Option<&str> {
        match self {
            Self::Call(message) | Self::Refused(message) => Some(message),
            Self::Told => None,
        }
    }
}

impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        Self::Refused(error.to_string())
    }
}

/// A refusal that names a file.
pub fn about_file(path: &std::path::Path, what: impl std::fmt::Display) -> Failure {
    Failure::Refused(format!("{}: {what}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statuses_are_those_of_the_contract() {
        assert_eq!(Failure::Call("x".into()).status(), 2);
        assert_eq!(about_file(std::path::Path::new("a"), "b"), Failure::Refused("a: b".into()));
        assert_eq!((Failure::Told.status(), Failure::Told.message()), (1, None));
    }
}
