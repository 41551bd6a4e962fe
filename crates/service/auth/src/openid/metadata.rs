//! Discovery document of a provider (OpenID Connect Discovery 1.0).

use serde::Deserialize;

use crate::openid::failure::{Result, SignInFailure};
use crate::openid::settings::{is_safe, parse_url};

/// Discovery document of a provider.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct ProviderMetadata {
    issuer: String,
    pub authorization_endpoint: String,
    pub token_endpoint: String,
    pub jwks_uri: String,
    pub userinfo_endpoint: Option<String>,
    #[serde(default = "by_default")]
    token_endpoint_auth_methods_supported: Vec<String>,
    #[serde(default)]
    authorization_response_iss_parameter_supported: bool,
}

fn by_default() -> Vec<String> {
    vec!["client_secret_basic".to_owned()]
}

/// Returns the URL of the discovery document of an issuer.
pub(crate) fn discovery_url(issuer: &str) -> String {
    format!("{}/.well-known/openid-configuration", issuer.trim_end_matches('/'))
}

impl ProviderMetadata {
    /// Checks that the document is that of this issuer, and that all endpoints use a safe
    /// connection.
    ///
    /// # Errors
    /// Returns an error that describes the violation.
    pub fn check_issuer(self, issuer: &str) -> Result<Self> {
        // Compared as text, without normalisation (OpenID Connect Discovery 1.0).
        if self.issuer != issuer {
            let own: String = self.issuer.chars().take(200).collect();
            let why = format!("its issuer is `{own}`, but the setting is `{issuer}`");
            return Err(SignInFailure::Provider(why));
        }
        let places = [
            ("authorization_endpoint", Some(&self.authorization_endpoint)),
            ("token_endpoint", Some(&self.token_endpoint)),
            ("jwks_uri", Some(&self.jwks_uri)),
            ("userinfo_endpoint", self.userinfo_endpoint.as_ref()),
        ];
        for (name, place) in places {
            let Some(place) = place else { continue };
            if !parse_url(place).is_some_and(|url| is_safe(&url)) {
                return Err(SignInFailure::Provider(format!("its {name} is not an https address")));
            }
        }
        Ok(self)
    }

    /// Returns true if the client secret goes into the body, because the provider does not accept
    /// it in the header.
    pub fn secret_in_body(&self) -> bool {
        let has = |method: &str| {
            self.token_endpoint_auth_methods_supported.iter().any(|known| known == method)
        };
        // The header is preferred; it is the default of a document that names no method.
        has("client_secret_post") && !has("client_secret_basic")
    }

    /// Returns true if an answer to the browser comes from this provider, as far as it names the
    /// issuer (RFC 9207).
    pub fn is_from(&self, issuer: Option<&str>) -> bool {
        match issuer {
            Some(issuer) => issuer == self.issuer,
            None => !self.authorization_response_iss_parameter_supported,
        }
    }
}
