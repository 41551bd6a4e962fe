//! Verification of ID tokens (OpenID Connect Core 1.0, 3.1.3.7; RFC 8725).

use crate::constant_time_eq;
use jsonwebtoken::errors::ErrorKind;
use jsonwebtoken::{AlgorithmFamily, Header, Validation, decode, decode_header};

use crate::openid::claims::TokenClaims;
use crate::openid::failure::{Result, SignInFailure};
use crate::openid::keys::KeySet;
use crate::openid::ring_keys;

/// Maximum length of a subject (OpenID Connect Core 1.0, 2).
const LONGEST_SUBJECT: usize = 255;
/// Accepted difference of clocks, s.
const CLOCK_TOLERANCE_S: u64 = 60;

/// Claims that a token must have.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ExpectedClaims<'a> {
    pub issuer: &'a str,
    pub client_id: &'a str,
    pub nonce: &'a str,
}

fn untrusted_error(why: &str) -> SignInFailure {
    SignInFailure::Untrusted(why.to_owned())
}

/// Reads the header of a token, which is not trusted yet: algorithm and name of the key.
///
/// # Errors
/// Returns an error if it is not a token, or is not signed by a private key of the provider.
pub(crate) fn read_header(token: &str) -> Result<Header> {
    let header = decode_header(token)
        .map_err(|_| untrusted_error("its token is not a signed token of a supported kind"))?;
    match (header.alg.family(), &header.crit) {
        (AlgorithmFamily::Hmac, _) => {
            Err(untrusted_error("its token is signed by a shared secret"))
        }
        (_, Some(_)) => {
            Err(untrusted_error("its token requires an extension that is not supported"))
        }
        (_, None) => Ok(header),
    }
}

/// Returns the verified claims of a token; none if no known key could have signed it.
///
/// # Errors
/// Returns an error if the token is not valid.
pub(crate) fn verify_token(
    token: &str,
    header: &Header,
    keys: &KeySet,
    expected: ExpectedClaims<'_>,
) -> Result<Option<TokenClaims>> {
    let Some(key) = keys.find_key(header) else { return Ok(None) };
    ring_keys::install_verifier();
    let mut validation = Validation::new(header.alg);
    validation.leeway = CLOCK_TOLERANCE_S;
    validation.validate_nbf = true;
    validation.set_required_spec_claims(&["exp", "iss", "sub", "aud"]);
    validation.set_issuer(&[expected.issuer]);
    validation.set_audience(&[expected.client_id]);
    let claims: TokenClaims =
        decode(token, &key, &validation).map_err(|error| describe_error(error.kind()))?.claims;
    check_claims(&claims, expected)?;
    Ok(Some(claims))
}

/// Checks the rules that the library leaves to its users: authorised party, nonce and subject.
fn check_claims(claims: &TokenClaims, expected: ExpectedClaims<'_>) -> Result<()> {
    let all = claims.aud.client_ids();
    if claims.iss != expected.issuer || !all.iter().any(|one| one == expected.client_id) {
        return Err(untrusted_error("its token is from another provider or for another server"));
    }
    // `azp` must name this client if it is present, and must be present with several audiences.
    let party = claims.azp.as_deref();
    if party.is_some_and(|party| party != expected.client_id) || (all.len() > 1 && party.is_none())
    {
        return Err(untrusted_error("its token was issued to another server"));
    }
    let nonce = claims.nonce.as_deref().unwrap_or_default();
    if !constant_time_eq(nonce.as_bytes(), expected.nonce.as_bytes()) {
        return Err(untrusted_error("its token was issued for another sign-in"));
    }
    let subject = &claims.sub;
    if subject.is_empty() || subject.len() > LONGEST_SUBJECT || subject.contains(char::is_control) {
        return Err(untrusted_error("its token has no subject"));
    }
    Ok(())
}

fn describe_error(kind: &ErrorKind) -> SignInFailure {
    untrusted_error(match kind {
        ErrorKind::InvalidSignature => "the signature of its token is wrong",
        ErrorKind::ExpiredSignature => "its token has expired",
        ErrorKind::ImmatureSignature => {
            "its token is not valid yet; check the clocks of both servers"
        }
        ErrorKind::InvalidIssuer => "its token is from another provider",
        ErrorKind::InvalidAudience => "its token is for another server",
        ErrorKind::MissingRequiredClaim(_) | ErrorKind::InvalidClaimFormat(_) => {
            "its token lacks a required claim"
        }
        _ => "its token cannot be parsed",
    })
}
