//! Failures of commands, and their exit status.

use sistership_model::FileError;

/// Failure of a command.
#[derive(Debug, PartialEq)]
pub enum Failure {
    /// The call is wrong: exit status 2.
    Call(String),
    /// The data or the model is refused: exit status 1.
    Refused(String),
    /// Same as [`Failure::Refused`], with the reason already printed.
    Told,
}

impl Failure {
    /// Returns the exit status.
    pub fn exit_status(&self) -> u8 {
        match self {
            Self::Call(_) => 2,
            Self::Refused(_) | Self::Told => 1,
        }
    }

    /// Returns the message that is still to be printed.
    pub fn message(&self) -> Option<&str> {
        match self {
            Self::Call(message) | Self::Refused(message) => Some(message),
            Self::Told => None,
        }
    }

    /// Joins two failures; if one of them is a wrong call, the result is one.
    fn merge_failures(self, other: Self) -> Self {
        let lines: Vec<&str> = [&self, &other].into_iter().filter_map(Self::message).collect();
        match (lines.is_empty(), self.exit_status().max(other.exit_status())) {
            (true, _) => Self::Told,
            (false, 2) => Self::Call(lines.join("\n")),
            (false, _) => Self::Refused(lines.join("\n")),
        }
    }
}

/// Returns both values, or all failures, so that a person can correct all faults of a call at once.
pub fn combine_results<A, B>(
    a: Result<A, Failure>,
    b: Result<B, Failure>,
) -> Result<(A, B), Failure> {
    match (a, b) {
        (Ok(a), Ok(b)) => Ok((a, b)),
        (Err(failure), Ok(_)) | (Ok(_), Err(failure)) => Err(failure),
        (Err(a), Err(b)) => Err(a.merge_failures(b)),
    }
}

/// Returns all values, or all failures.
pub fn collect_results<T>(
    each: impl Iterator<Item = Result<T, Failure>>,
) -> Result<Vec<T>, Failure> {
    let mut all = Ok(Vec::new());
    for one in each {
        // Items are evaluated after a failure, too, to collect every reason.
        all = combine_results(all, one).map(|(mut all, one)| {
            all.push(one);
            all
        });
    }
    all
}

impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        Self::Refused(error.to_string())
    }
}

/// Creates a refusal that names a file.
pub fn about_file(path: &std::path::Path, what: impl std::fmt::Display) -> Failure {
    Failure::Refused(format!("{}: {what}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statuses_are_those_of_the_contract() {
        assert_eq!(Failure::Call("x".into()).exit_status(), 2);
        assert_eq!(about_file(std::path::Path::new("a"), "b"), Failure::Refused("a: b".into()));
        assert_eq!((Failure::Told.exit_status(), Failure::Told.message()), (1, None));
    }

    #[test]
    fn every_reason_is_told() {
        let refused = |what: &str| Failure::Refused(what.to_owned());
        let of = |all: [Result<u8, Failure>; 3]| super::collect_results(all.into_iter());
        assert_eq!(of([Ok(1), Ok(2), Ok(3)]), Ok(vec![1, 2, 3]));
        assert_eq!(of([Err(refused("a")), Ok(2), Err(refused("c"))]), Err(refused("a\nc")));
        let call = Failure::Call("b".into());
        assert_eq!(
            combine_results::<u8, u8>(Err(refused("a")), Err(call)),
            Err(Failure::Call("a\nb".into()))
        );
        assert_eq!(of([Err(Failure::Told), Ok(1), Err(Failure::Told)]), Err(Failure::Told));
    }
}
