//! Reasons for a failed sign-in at a provider, in words for the person who tried. None of them
//! contains a token, a code or a secret.

/// Reason for a failed sign-in at a provider.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SignInFailure {
    /// The provider does not answer.
    #[error("the provider cannot be reached ({0}); try again later, or sign in with a password")]
    Unreachable(String),
    /// The provider violates the protocol.
    #[error("the answer of the provider is not valid: {0}; tell an admin of this server")]
    Provider(String),
    /// The person, or the provider, has refused.
    #[error("the provider has denied access; sign in there, or with a password")]
    Denied,
    /// The provider reports another error.
    #[error("the provider refuses to sign you in: {0}; tell an admin of this server")]
    Refused(String),
    /// The sign-in began too long ago or in another browser, or has ended already.
    #[error("this sign-in has expired or was started in another browser or window; start again")]
    Expired,
    /// The answer of the provider does not prove the identity of the person.
    #[error("the provider's answer does not identify you: {0}; tell an admin")]
    Untrusted(String),
    /// The provider does not send a required claim.
    #[error("{0}; tell an admin of this server")]
    Lacking(String),
}

/// Result of a sign-in, or of a part of it.
pub type Result<T, E = SignInFailure> = std::result::Result<T, E>;
