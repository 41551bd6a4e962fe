//! Why a sign-in at a provider comes to nothing, in words for the person who tried. Nothing of it
//! holds a token, a code or a secret.

/// Why a sign-in at a provider comes to nothing.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Failure {
    /// Nobody answers there.
    #[error("the provider cannot be reached ({0}); try again later, or sign in with a password")]
    Unreachable(String),
    /// It answers what it must not.
    #[error("the provider does not answer as it must: {0}; tell an admin of this server")]
    Provider(String),
    /// The person, or the provider, has said no.
    #[error("the provider says that you were not let through; sign in there, or with a password")]
    Denied,
    /// The provider says that something else is wrong.
    #[error("the provider refuses to sign you in: {0}; tell an admin of this server")]
    Refused(String),
    /// It began too long ago, in another browser, or has ended already.
    #[error("this sign-in has expired, or was begun in another browser or window; begin again")]
    Expired,
    /// What came back does not show who is there.
    #[error("what the provider has sent does not show who you are: {0}; tell an admin")]
    Untrusted(String),
    /// The provider does not say what was asked for.
    #[error("{0}; tell an admin of this server")]
    Lacking(String),
}

/// What comes of a sign-in, or of a part of it.
pub type Result<T, E = Failure> = std::result::Result<T, E>;
