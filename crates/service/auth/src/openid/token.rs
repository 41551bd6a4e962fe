//! Verification of ID tokens (OpenID Connect Core 1.0, 3.1.3.7; RFC 8725).

use crate::same;
use jsonwebtoken::errors::ErrorKind;
use jsonwebtoken::{AlgorithmFamily, Header, Validation, decode, decode_header};

use crate::openid::claims::Claims;
use crate::openid::failure::{Failure, Result};
use crate::openid::keys::Keys;
use crate::openid::ring_keys;

/// Maximum length of a subject (OpenID Connect Core 1.0, 2).
const LONGEST_SUBJECT: usize = 255;
/// Accepted difference of clocks, s.
const APART_S: u64 = 60;

/// Claims that a token must have.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Expected<'a> {
    pub issuer: &'a str,
    pub client_id: &'a str,
    pub nonce: &'a str,
}

fn untrusted(why: &str) -> Failure {
    Failure::Untrusted(why.to_owned())
}

/// Reads the header of a token, which is not trusted yet: algorithm and name of the key.
///
/// # Errors
/// Returns an error if it is not a token, or is not signed by a private key of the provider.
pub(crate) fn header(token: &str) -> Result<Header> {
    let header = decode_header(token)
        .map_err(|_| untrusted("its token is no signed token of a kind that is known here"))?;
    match (header.alg.family(), &header.crit) {
        (AlgorithmFamily::Hmac, _) => Err(untrusted("its token is signed by a shared secret")),
        (_, Some(_)) => Err(untrusted("its token asks for what is not known here")),
        (_, None) => Ok(header),
    }
}

/// Returns the verified claims of a token; none if no known key could have signed it.
///
/// # Errors
/// Returns an error if the token is not valid.
pub(crate) fn verified(
    token: &str,
    header: &Header,
    keys: &Keys,
    expected: Expected<'_>,
) -> Result<Option<Claims>> {
    let Some(key) = keys.of(header) else { return Ok(None) };
    ring_keys::provide();
    let mut validation = Validation::new(header.alg);
    validation.leeway = APART_S;
    validation.validate_nbf = true;
    validation.set_required_spec_claims(&["exp", "iss", "sub", "aud"]);
    validation.set_issuer(&[expected.issuer]);
    validation.set_audience(&[expected.client_id]);
    let claims: Claims =
        decode(token, &key, &validation).map_err(|error| words(error.kind()))?.claims;
    checked(&claims, expected)?;
    Ok(Some(claims))
}

/// Checks the rules that the library leaves to its users: authorised party, nonce and subject.
fn checked(claims: &Claims, expected: Expected<'_>) -> Result<()> {
    let all = claims.aud.all();
    if claims.iss != expected.issuer || !all.iter().any(|one| one == expected.client_id) {
        return Err(untrusted("its token is another provider's, or for another server"));
    }
    // `azp` must name this client if it is present, and must be present with several audiences.
    let party = claims.azp.as_deref();
    if party.is_some_and(|party| party != expected.client_id) || (all.len() > 1 && party.is_none())
    {
        return Err(untrusted("its token was given to another server"));
    }
    let nonce = claims.nonce.as_deref().unwrap_or_default();
    if !same(nonce.as_bytes(), expected.nonce.as_bytes()) {
        return Err(untrusted("its token was made for another sign-in"));
    }
    let subject = &claims.sub;
    if subject.is_empty() || subject.len() > LONGEST_SUBJECT || subject.contains(char::is_control) {
        return Err(untrusted("its token names nobody"));
    }
    Ok(())
}

fn words(kind: &ErrorKind) -> Failure {
    untrusted(match kind {
        ErrorKind::InvalidSignature => "the signature of its token is wrong",
        ErrorKind::ExpiredSignature => "its token has expired",
        ErrorKind::ImmatureSignature => "its token is not valid yet; a clock is wrong",
        ErrorKind::InvalidIssuer => "its token is another provider's",
        ErrorKind::InvalidAudience => "its token is for another server",
        ErrorKind::MissingRequiredClaim(_) | ErrorKind::InvalidClaimFormat(_) => {
            "its token lacks what it must say"
        }
        _ => "its token cannot be read",
    })
}
