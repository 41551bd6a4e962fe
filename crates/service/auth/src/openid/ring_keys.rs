//! Verification of token signatures by ring, which verifies those of TLS as well. Nothing is signed
//! here, and shared secrets are not accepted as keys: a provider signs with a key that only it has.

use jsonwebtoken::crypto::{CryptoProvider, JwtSigner, JwtVerifier, KeyUtils};
use jsonwebtoken::errors::{ErrorKind, Result};
use jsonwebtoken::signature::{self, Verifier};
use jsonwebtoken::{Algorithm, DecodingKey, DecodingKeyKind, EncodingKey};
use ring::signature as ring_signature;
use ring::signature::{RsaParameters, RsaPublicKeyComponents, VerificationAlgorithm};

static PROVIDER: CryptoProvider = CryptoProvider {
    signer_factory: no_signer,
    verifier_factory: make_verifier,
    key_utils: KeyUtils::new_unimplemented(),
};

/// Makes ring the verifier of token signatures. A second call changes nothing.
pub(crate) fn install_verifier() {
    // An error means that it was installed before.
    let _ = PROVIDER.install_default();
}

fn no_signer(_: &Algorithm, _: &EncodingKey) -> Result<Box<dyn JwtSigner>> {
    Err(ErrorKind::UnsupportedAlgorithm.into())
}

fn make_verifier(algorithm: &Algorithm, key: &DecodingKey) -> Result<Box<dyn JwtVerifier>> {
    // The algorithm that the token names must belong to the kind of key.
    if key.family() != algorithm.family() {
        return Err(ErrorKind::InvalidKeyFormat.into());
    }
    let key = PublicKey::from_decoding_key(*algorithm, key.kind())
        .ok_or(ErrorKind::UnsupportedAlgorithm)?;
    Ok(Box::new(RingVerifier { algorithm: *algorithm, key }))
}

struct RingVerifier {
    algorithm: Algorithm,
    key: PublicKey,
}

enum PublicKey {
    Rsa { parameters: &'static RsaParameters, modulus: Vec<u8>, exponent: Vec<u8> },
    Curve { algorithm: &'static dyn VerificationAlgorithm, point: Vec<u8> },
}

impl PublicKey {
    fn from_decoding_key(algorithm: Algorithm, kind: &DecodingKeyKind) -> Option<Self> {
        match kind {
            DecodingKeyKind::RsaModulusExponent { n, e } => {
                let (modulus, exponent) = (strip_leading_zeros(n), strip_leading_zeros(e));
                Some(Self::Rsa { parameters: rsa_parameters(algorithm)?, modulus, exponent })
            }
            DecodingKeyKind::SecretOrDer(point) => {
                Some(Self::Curve { algorithm: curve_algorithm(algorithm)?, point: point.clone() })
            }
        }
    }
}

/// Removes leading zero bytes, which some providers write and ring does not accept.
fn strip_leading_zeros(number: &[u8]) -> Vec<u8> {
    number.iter().copied().skip_while(|byte| *byte == 0).collect()
}

/// Returns the parameters of RSA with 2048 bits and more (NIST SP 800-131A, revision 2).
fn rsa_parameters(algorithm: Algorithm) -> Option<&'static RsaParameters> {
    match algorithm {
        Algorithm::RS256 => Some(&ring_signature::RSA_PKCS1_2048_8192_SHA256),
        Algorithm::RS384 => Some(&ring_signature::RSA_PKCS1_2048_8192_SHA384),
        Algorithm::RS512 => Some(&ring_signature::RSA_PKCS1_2048_8192_SHA512),
        Algorithm::PS256 => Some(&ring_signature::RSA_PSS_2048_8192_SHA256),
        Algorithm::PS384 => Some(&ring_signature::RSA_PSS_2048_8192_SHA384),
        Algorithm::PS512 => Some(&ring_signature::RSA_PSS_2048_8192_SHA512),
        _ => None,
    }
}

fn curve_algorithm(algorithm: Algorithm) -> Option<&'static dyn VerificationAlgorithm> {
    match algorithm {
        Algorithm::ES256 => Some(&ring_signature::ECDSA_P256_SHA256_FIXED),
        Algorithm::ES384 => Some(&ring_signature::ECDSA_P384_SHA384_FIXED),
        Algorithm::EdDSA => Some(&ring_signature::ED25519),
        _ => None,
    }
}

impl Verifier<Vec<u8>> for RingVerifier {
    fn verify(
        &self,
        message: &[u8],
        presented: &Vec<u8>,
    ) -> std::result::Result<(), signature::Error> {
        let checked = match &self.key {
            PublicKey::Rsa { parameters, modulus: n, exponent: e } => {
                RsaPublicKeyComponents { n, e }.verify(parameters, message, presented)
            }
            PublicKey::Curve { algorithm, point } => {
                ring_signature::UnparsedPublicKey::new(*algorithm, point).verify(message, presented)
            }
        };
        checked.map_err(|_| signature::Error::new())
    }
}

impl JwtVerifier for RingVerifier {
    fn algorithm(&self) -> Algorithm {
        self.algorithm
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use jsonwebtoken::jwk::Jwk;
    use serde_json::{Value, json};

    /// Returns whether a signed text is accepted under a key, unchanged and with its last letters
    /// changed.
    fn holds(key: Value, algorithm: Algorithm, signed: &str) -> (bool, bool) {
        install_verifier();
        let key = serde_json::from_value::<Jwk>(key).unwrap();
        let key = DecodingKey::from_jwk(&key).unwrap();
        let (message, signature) = signed.rsplit_once('.').unwrap();
        let told = |signature: &str| {
            jsonwebtoken::crypto::verify(signature, message.as_bytes(), &key, algorithm)
        };
        let other = signature.replacen(
            &signature[8..9],
            if &signature[8..9] == "A" { "B" } else { "A" },
            1,
        );
        (told(signature).unwrap(), told(&other).unwrap_or(false))
    }

    /// Claims that RFC 7515 signs in its appendix A.
    const CLAIMS: &str = "eyJpc3MiOiJqb2UiLA0KICJleHAiOjEzMDA4MTkzODAsDQogImh0dHA6Ly9leGFtcGxlLmNvbS9pc19yb290Ijp0cnVlfQ";

    #[test]
    fn signatures_of_the_standards_hold() {
        // RFC 7515, A.2.
        let n = "ofgWCuLjybRlzo0tZWJjNiuSfb4p4fAkd_wWJcyQoTbji9k0l8W26mPddxHmfHQp-Vaw-4qPCJrcS2mJPMEzP1Pt0Bm4d4Ql\
            L-yRT-SFd2lZS-pCgNMsD1W_YpRPEwOWvG6b32690r2jZ47soMZo9wGzjb_7OMg0LOL-bSf63kpaSHSXndS5z5rexMdbBYUsLA9e-KXBd\
            QOS-UTo7WTBEMa2R2CapHg665xsmtdVMTBQY4uDZlxvb3qCo5ZwKh9kG4LT6_I5IhlJH7aGhyxXFvUK-DWNmoudF8NAco9_h9iaGNj8q2\
            ethFkMLs91kzk2PAcDTW9gb54h4FRWyuXpoQ";
        let signature = "cC4hiUPoj9Eetdgtv3hF80EGrhuB__dzERat0XF9g2VtQgr9PJbu3XOiZj5RZmh7AAuHIm4Bh-0Qc_lF5YKt_O8W2F\
            p5jujGbds9uJdbF9CUAr7t1dnZcAcQjbKBYNX4BAynRFdiuB--f_nZLgrnbyTyWzO75vRK5h6xBArLIARNPvkSjtQBMHlb1L07Qe7K0Ga\
            rZRmB_eSN9383LcOLn6_dO--xi12jzDwusC-eOkHWEsqtFZESc6BfI7noOPqvhJ1phCnvWh6IeYI2w9QOYEUipUTI8np6LbgGY9Fs98rq\
            Vt5AXLIhWkWywlVmtVrBp0igcN_IoypGlUPQGe77Rw";
        let rsa = json!({ "kty": "RSA", "n": n, "e": "AQAB" });
        let signed = format!("eyJhbGciOiJSUzI1NiJ9.{CLAIMS}.{signature}");
        assert_eq!(holds(rsa.clone(), Algorithm::RS256, &signed), (true, false));
        assert_eq!(holds(rsa, Algorithm::RS512, &signed), (false, false), "another hash");
        // RFC 7515, A.3.
        let curve = json!({ "kty": "EC", "crv": "P-256",
            "x": "f83OJ3D2xF1Bg8vub9tLe1gHMzV76e8Tus9uPHvRVEU",
            "y": "x_FEzRu9m36HLN_tue659LNpXW6pCyStikYjKIWI5a0" });
        let signed = format!(
            "eyJhbGciOiJFUzI1NiJ9.{CLAIMS}.DtEhU3ljbEg8L38VWAfUAqOyKAM6-Xx-F4GawxaepmXFCgfTjDxw5djxLa8ISlSApmWQxfKTUJqPP3-Kg6NU1Q"
        );
        assert_eq!(holds(curve, Algorithm::ES256, &signed), (true, false));
        // RFC 8037, A.4.
        let edwards = json!({ "kty": "OKP", "crv": "Ed25519",
            "x": "11qYAYKxCrfVS_7TyWQHOg7hcvPapiMlrwIaaPcHURo" });
        let signed = "eyJhbGciOiJFZERTQSJ9.RXhhbXBsZSBvZiBFZDI1NTE5IHNpZ25pbmc.hgyY0il_MGCjP0JzlnLWG1PPOt7-09PGcvMg3AIbQR6dWbhijcNR4ki4iylGjg5BhVsPt9g7sVvpAr_MuM0KAg";
        assert_eq!(holds(edwards, Algorithm::EdDSA, signed), (true, false));
    }

    #[test]
    fn a_secret_that_both_know_is_no_key() {
        let secret = DecodingKey::from_secret(b"secret");
        assert!(make_verifier(&Algorithm::HS256, &secret).is_err());
        assert!(make_verifier(&Algorithm::RS256, &secret).is_err());
    }
}
