//! Settings of the OpenID provider of a server.

use std::fmt;
use std::net::IpAddr;

use reqwest::Url;

use crate::openid::admission::AdmissionRules;

/// Path to which the provider sends browsers back, below the server's own URL.
const CALLBACK: &str = "/sign-in/oidc/callback";

/// Settings of the OpenID provider of a server; created by
/// [`crate::openid::OpenIdArguments::settings`].
#[derive(Clone, PartialEq, Eq)]
pub struct ProviderSettings {
    pub(crate) issuer: String,
    pub(crate) client_id: String,
    pub(crate) client_secret: Option<String>,
    /// URL of the server for browsers, without a slash at the end.
    pub(crate) base_url: String,
    pub(crate) title: String,
    pub(crate) scopes: String,
    pub(crate) admission: AdmissionRules,
}

/// All faults of the settings, each with the name of the setting.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}", .0.join("; "))]
pub struct SettingsError(pub Vec<String>);

impl ProviderSettings {
    /// Returns the display name of the provider.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// Returns the issuer URL.
    pub fn issuer(&self) -> &str {
        &self.issuer
    }

    /// Returns the rules of admission.
    pub fn admission_rules(&self) -> &AdmissionRules {
        &self.admission
    }

    /// Returns true if browsers reach the server by https.
    pub fn is_secure(&self) -> bool {
        self.base_url.starts_with("https:")
    }

    pub(crate) fn redirect_uri(&self) -> String {
        format!("{}{CALLBACK}", self.base_url)
    }
}

impl fmt::Debug for ProviderSettings {
    /// Formats the settings without the secret.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.debug_struct("Settings")
            .field("issuer", &self.issuer)
            .field("client_id", &self.client_id)
            .field("base_url", &self.base_url)
            .field("admission", &self.admission)
            .finish_non_exhaustive()
    }
}

/// Parses a URL without user name, password and fragment.
pub(crate) fn parse_url(text: &str) -> Option<Url> {
    let url = Url::parse(text).ok()?;
    let plain = url.username().is_empty() && url.password().is_none() && url.fragment().is_none();
    (plain && url.has_host()).then_some(url)
}

/// Returns true if a connection to the URL cannot be intercepted: by https, or within this machine.
pub(crate) fn is_safe(url: &Url) -> bool {
    // An IPv6 address has brackets in a URL.
    let host = url.host_str().unwrap_or_default().trim_matches(['[', ']']);
    let here = host == "localhost" || host.parse().is_ok_and(|ip: IpAddr| ip.is_loopback());
    url.scheme() == "https" || (url.scheme() == "http" && here)
}
