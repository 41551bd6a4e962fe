//! Public keys of a provider (RFC 7517).

use jsonwebtoken::jwk::{Jwk, PublicKeyUse};
use jsonwebtoken::{Algorithm, AlgorithmFamily, DecodingKey, Header};
use serde::Deserialize;
use serde_json::Value;

/// The published key set of a provider.
#[derive(Debug, Clone, Default)]
pub(crate) struct KeySet(Vec<Jwk>);

#[derive(Deserialize)]
struct KeySetDocument {
    keys: Vec<Value>,
}

impl KeySet {
    /// Parses a key set; unknown kinds of keys are skipped (RFC 7517, 5).
    pub fn read(bytes: &[u8]) -> Option<Self> {
        let KeySetDocument { keys } = serde_json::from_slice(bytes).ok()?;
        let read = keys.into_iter().filter_map(|key| serde_json::from_value(key).ok());
        Some(Self(read.collect()))
    }

    /// Returns the key that a token names; if it names none, the only key that could have signed
    /// it.
    pub fn find_key(&self, header: &Header) -> Option<DecodingKey> {
        let fitting = self.0.iter().filter_map(|key| Some((key, signing_key(key, header.alg)?)));
        let mut fitting =
            fitting.filter(|(key, _)| header.kid.is_none() || key.common.key_id == header.kid);
        let (_, found) = fitting.next()?;
        // Without a name the choice must be unambiguous.
        (header.kid.is_some() || fitting.next().is_none()).then_some(found)
    }
}

/// Returns a key if it is meant for signatures by this algorithm.
fn signing_key(key: &Jwk, algorithm: Algorithm) -> Option<DecodingKey> {
    let signs = key.common.public_key_use.as_ref();
    if signs.is_some_and(|purpose| *purpose != PublicKeyUse::Signature) {
        return None;
    }
    let named = key.common.key_algorithm.map(Algorithm::try_from);
    if named.is_some_and(|named| named.ok() != Some(algorithm)) {
        return None;
    }
    let key = DecodingKey::from_jwk(key).ok()?;
    // A shared secret in a published set is no proof of the signer.
    let public = key.family() == algorithm.family() && key.family() != AlgorithmFamily::Hmac;
    public.then_some(key)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use serde_json::json;

    fn edwards(about: Value) -> Value {
        let mut key = json!({ "kty": "OKP", "crv": "Ed25519",
            "x": "11qYAYKxCrfVS_7TyWQHOg7hcvPapiMlrwIaaPcHURo" });
        key.as_object_mut().unwrap().extend(about.as_object().unwrap().clone());
        key
    }

    fn found(keys: &[Value], kid: Option<&str>) -> bool {
        let keys = KeySet::read(json!({ "keys": keys }).to_string().as_bytes()).unwrap();
        let header = Header { kid: kid.map(str::to_owned), ..Header::new(Algorithm::EdDSA) };
        keys.find_key(&header).is_some()
    }

    #[test]
    fn a_key_is_found_by_its_name_and_kind() {
        let (a, b) = (edwards(json!({ "kid": "a" })), edwards(json!({ "kid": "b" })));
        assert!(found(&[a.clone(), b.clone()], Some("b")));
        assert!(!found(&[a.clone(), b.clone()], Some("c")));
        assert!(found(std::slice::from_ref(&a), None));
        assert!(!found(&[a.clone(), b], None), "either could have signed");
        let unknown = json!({ "kty": "AKP", "kid": "new", "pub": "x" });
        let damaged = json!({ "kty": "EC", "kid": "b" });
        assert!(found(&[unknown, damaged, json!(7), a], Some("a")));
    }

    #[test]
    fn a_key_for_something_else_signs_nothing() {
        for about in
            [json!({ "use": "enc" }), json!({ "alg": "ES256" }), json!({ "alg": "RSA-OAEP" })]
        {
            assert!(!found(&[edwards(about.clone())], None), "{about}");
        }
        assert!(found(&[edwards(json!({ "use": "sig", "alg": "EdDSA" }))], None));
        assert!(!found(&[json!({ "kty": "oct", "k": "c2VjcmV0" })], None));
        assert!(KeySet::read(b"{}").is_none() && KeySet::read(b"[]").is_none());
    }
}
