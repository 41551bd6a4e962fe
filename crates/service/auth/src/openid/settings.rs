//! What a server is told of its provider.

use std::fmt;
use std::net::IpAddr;

use reqwest::Url;

use crate::openid::admission::Admission;

/// Where the provider sends browsers back to, below the server's own address.
const CALLBACK: &str = "/sign-in/oidc/callback";

/// What a server is told of its provider; made by [`crate::openid::OpenIdArguments::settings`].
#[derive(Clone, PartialEq, Eq)]
pub struct Settings {
    pub(crate) issuer: String,
    pub(crate) client_id: String,
    pub(crate) client_secret: Option<String>,
    /// Where browsers find the server, without a slash at the end.
    pub(crate) base_url: String,
    pub(crate) title: String,
    pub(crate) scopes: String,
    pub(crate) admission: Admission,
}

/// All that is wrong with the settings, each with its name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}", .0.join("; "))]
pub struct SettingsError(pub Vec<String>);

impl Settings {
    /// What people know the provider by.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// Who issues the identities.
    pub fn issuer(&self) -> &str {
        &self.issuer
    }

    /// Who gets in.
    pub fn admission(&self) -> &Admission {
        &self.admission
    }

    /// Whether browsers reach the server by https.
    pub fn is_secure(&self) -> bool {
        self.base_url.starts_with("https:")
    }

    pub(crate) fn redirect_uri(&self) -> String {
        format!("{}{CALLBACK}", self.base_url)
    }
}

impl fmt::Debug for Settings {
    /// Leaves out the secret.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.debug_struct("Settings")
            .field("issuer", &self.issuer)
            .field("client_id", &self.client_id)
            .field("base_url", &self.base_url)
            .field("admission", &self.admission)
            .finish_non_exhaustive()
    }
}

/// An address without name, password and fragment.
pub(crate) fn url(text: &str) -> Option<Url> {
    let url = Url::parse(text).ok()?;
    let plain = url.username().is_empty() && url.password().is_none() && url.fragment().is_none();
    (plain && url.has_host()).then_some(url)
}

/// Whether nobody can listen in: by https, or within this machine.
pub(crate) fn is_safe(url: &Url) -> bool {
    let host = url.host_str().unwrap_or_default().trim_matches(['[', ']']);
    let here = host == "localhost" || host.parse().is_ok_and(|ip: IpAddr| ip.is_loopback());
    url.scheme() == "https" || (url.scheme() == "http" && here)
}
