//! Signature of a bundle: an Ed25519 signature (RFC 8032) of the manifest, which has the hash of
//! everything else. Keys are those of `openssl genpkey -algorithm ed25519`, so that OpenSSL can
//! check a bundle without this program.

use std::fmt;

use ring::signature::{ED25519, Ed25519KeyPair, KeyPair as _, UnparsedPublicKey};
use rustls_pki_types::pem::PemObject as _;
use rustls_pki_types::{PrivatePkcs8KeyDer, SubjectPublicKeyInfoDer};
use sistership_model::version::sha256_hex;

use super::error::BundleError;

/// Bytes before the 32 bytes of an Ed25519 key in a SubjectPublicKeyInfo: RFC 8410, section 4.
const PREFIX: [u8; 12] = [0x30, 0x2a, 0x30, 0x05, 0x06, 0x03, 0x2b, 0x65, 0x70, 0x03, 0x21, 0x00];

/// A key that signs bundles.
pub struct SigningKey(Ed25519KeyPair);

impl fmt::Debug for SigningKey {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "SigningKey({})", self.verifying_key())
    }
}

impl SigningKey {
    /// Reads a private key in PEM.
    ///
    /// # Errors
    /// Returns an error if it is no Ed25519 key.
    pub fn from_pem(text: &[u8]) -> Result<Self, BundleError> {
        // The cause is dropped on purpose: it could quote parts of a private key.
        let is_none = || BundleError::Key("has no Ed25519 private key in PEM (PKCS #8)");
        let key = PrivatePkcs8KeyDer::from_pem_slice(text).map_err(|_| is_none())?;
        // OpenSSL writes version 1 of PKCS #8, which has no public key to check the private one
        // against.
        let pair = Ed25519KeyPair::from_pkcs8_maybe_unchecked(key.secret_pkcs8_der());
        Ok(Self(pair.map_err(|_| is_none())?))
    }

    /// Returns the key that verifies its signatures.
    pub fn verifying_key(&self) -> VerifyingKey {
        let key = self.0.public_key().as_ref();
        VerifyingKey([&PREFIX[..], key].concat())
    }

    pub(super) fn sign_manifest(&self, manifest: &[u8]) -> ManifestSignature {
        let bytes = self.0.sign(manifest).as_ref().to_vec();
        ManifestSignature { key: self.verifying_key(), bytes }
    }
}

/// Key that verifies signatures of bundles: a SubjectPublicKeyInfo.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VerifyingKey(Vec<u8>);

/// The SHA-256 of the key, hexadecimal, as `openssl pkey -pubout -outform DER | sha256sum` has it.
impl fmt::Display for VerifyingKey {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(&sha256_hex(&self.0))
    }
}

impl VerifyingKey {
    /// Reads a public key in PEM.
    ///
    /// # Errors
    /// Returns an error if it is no Ed25519 key.
    pub fn from_pem(text: &[u8]) -> Result<Self, BundleError> {
        let is_none = || BundleError::Key("has no Ed25519 public key in PEM");
        let key = SubjectPublicKeyInfoDer::from_pem_slice(text).map_err(|_| is_none())?;
        Self::from_der(&key).ok_or_else(is_none)
    }

    pub(super) fn from_der(der: &[u8]) -> Option<Self> {
        (der.len() == PREFIX.len() + 32 && der.starts_with(&PREFIX)).then(|| Self(der.to_vec()))
    }

    /// Key in DER, as in a bundle.
    pub(super) fn as_der(&self) -> &[u8] {
        &self.0
    }
}

/// Signature with the key that it claims; not yet verified.
pub(super) struct ManifestSignature {
    pub(super) key: VerifyingKey,
    pub(super) bytes: Vec<u8>,
}

impl ManifestSignature {
    /// Returns the key if the signature is valid for the manifest.
    pub(super) fn verify_manifest(self, manifest: &[u8]) -> Option<VerifyingKey> {
        let key = UnparsedPublicKey::new(&ED25519, &self.key.0[PREFIX.len()..]);
        key.verify(manifest, &self.bytes).ok().map(|()| self.key)
    }
}

/// Checks that the signer is one of the trusted keys; without trusted keys every bundle is
/// accepted.
///
/// # Errors
/// Returns an error that names the signer.
pub fn check_signer(
    signer: Option<&VerifyingKey>,
    keys: &[VerifyingKey],
) -> Result<(), BundleError> {
    match signer {
        _ if keys.is_empty() => Ok(()),
        None => Err(BundleError::File("is not signed, but a signature is required".to_owned())),
        Some(signer) if keys.contains(signer) => Ok(()),
        Some(signer) => Err(BundleError::File(format!(
            "is signed by {signer}, which is not one of the given keys"
        ))),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_auth::to_hex;

    use super::*;

    /// RFC 8032, section 7.1, test 2: the key, and the signature of `0x72`.
    const PRIVATE: &str = super::super::tests::KEYS[0];
    const SIGNATURE: &str = "92a009a9f0d4cab8720e820b5f642540a2b27b5416503f8fb3762223ebdb69da\
        085ac1e43e15996e458f3613d0f11d8c387b2eaeb4302aeeb00d291612bb0c00";

    #[test]
    fn the_signature_of_the_standard_is_made_and_taken() {
        let key = SigningKey::from_pem(PRIVATE.as_bytes()).unwrap();
        let made = key.sign_manifest(&[0x72]);
        assert_eq!(to_hex(&made.bytes), SIGNATURE);
        assert_eq!(
            to_hex(&made.key.as_der()[PREFIX.len()..]),
            "3d4017c3e843895a92b70aa74d1b7ebc9c982ccf2ec4968cc0cd55f12af4660c"
        );
        assert_eq!(key.sign_manifest(&[0x72]).verify_manifest(&[0x72]), Some(key.verifying_key()));
        assert_eq!(made.verify_manifest(&[0x73]), None);
    }

    #[test]
    fn other_keys_are_refused() {
        let refused = SigningKey::from_pem(b"nothing").unwrap_err().to_string();
        assert!(refused.contains("no Ed25519 private key"), "{refused}");
        assert!(VerifyingKey::from_pem(PRIVATE.as_bytes()).is_err(), "a private key is no public");
        assert_eq!(VerifyingKey::from_der(&[0; 44]), None);
    }
}
