//! Settings of a provider from command-line flags, the environment and the configuration file.

use std::path::{Path, PathBuf};

use crate::Grant;
use clap::Args;
use serde::Deserialize;

use crate::openid::admission::AdmissionRules;
use crate::openid::settings::{ProviderSettings, SettingsError, is_safe, parse_url};

/// Environment variable of the client secret.
const SECRET: &str = "SISTERSHIP_OIDC_CLIENT_SECRET";

/// Settings of a provider, each with its flag; the section `oidc` of the configuration file has the
/// same names.
#[derive(Debug, Clone, Default, PartialEq, Args, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[command(next_help_heading = "Signing in at an OpenID provider")]
pub struct OpenIdArguments {
    /// Issuer of the provider, spelled as in its discovery document; needs --accounts.
    #[arg(
        id = "oidc_issuer",
        long = "oidc-issuer",
        value_name = "URL",
        env = "SISTERSHIP_OIDC_ISSUER"
    )]
    pub issuer: Option<String>,
    /// Client ID of this server at the provider.
    #[arg(
        id = "oidc_client_id",
        long = "oidc-client-id",
        value_name = "ID",
        env = "SISTERSHIP_OIDC_CLIENT_ID"
    )]
    pub client_id: Option<String>,
    /// File with the client secret of this server; takes precedence over
    /// SISTERSHIP_OIDC_CLIENT_SECRET.
    #[arg(
        id = "oidc_client_secret_file",
        long = "oidc-client-secret-file",
        value_name = "FILE",
        env = "SISTERSHIP_OIDC_CLIENT_SECRET_FILE"
    )]
    pub client_secret_file: Option<PathBuf>,
    /// URL of this server for browsers; the provider redirects them to BASE/sign-in/oidc/callback.
    #[arg(
        id = "oidc_base_url",
        long = "oidc-base-url",
        value_name = "BASE",
        env = "SISTERSHIP_OIDC_BASE_URL"
    )]
    pub base_url: Option<String>,
    /// Name of the provider on the sign-in button [default: its host].
    #[arg(
        id = "oidc_title",
        long = "oidc-title",
        value_name = "TEXT",
        env = "SISTERSHIP_OIDC_TITLE"
    )]
    pub title: Option<String>,
    /// Scopes requested from the provider [default: openid profile email].
    #[arg(
        id = "oidc_scopes",
        long = "oidc-scopes",
        value_name = "WORDS",
        env = "SISTERSHIP_OIDC_SCOPES"
    )]
    pub scopes: Option<String>,
    /// Claim that names a new account [default: preferred_username, else a verified email].
    #[arg(
        id = "oidc_name_claim",
        long = "oidc-name-claim",
        value_name = "CLAIM",
        env = "SISTERSHIP_OIDC_NAME_CLAIM"
    )]
    pub name_claim: Option<String>,
    /// Create an account for every person that the provider lets through and who has none;
    /// otherwise an account must exist and be linked.
    #[arg(id = "oidc_auto_create", long = "oidc-auto-create", env = "SISTERSHIP_OIDC_AUTO_CREATE")]
    pub auto_create: bool,
    /// Role of a new account; with --oidc-group-role, of every person in addition to those of their
    /// groups.
    #[arg(
        id = "oidc_default_role",
        long = "oidc-default-role",
        value_name = "ROLE",
        env = "SISTERSHIP_OIDC_DEFAULT_ROLE"
    )]
    pub default_role: Option<String>,
    /// Claim that lists groups [default: groups].
    #[arg(
        id = "oidc_groups_claim",
        long = "oidc-groups-claim",
        value_name = "CLAIM",
        env = "SISTERSHIP_OIDC_GROUPS_CLAIM"
    )]
    pub groups_claim: Option<String>,
    /// Role of a group's members; repeatable, separated by `;` in the environment. A person who
    /// signs in at the provider then has the roles of their groups, and no others.
    #[arg(
        id = "oidc_group_roles",
        long = "oidc-group-role",
        value_name = "GROUP=ROLE",
        value_delimiter = ';',
        env = "SISTERSHIP_OIDC_GROUP_ROLES"
    )]
    pub group_roles: Vec<String>,
}

impl OpenIdArguments {
    /// Returns the settings of the provider, if one is configured; missing values are taken from
    /// the configuration file.
    ///
    /// # Errors
    /// Returns an error that names all invalid settings.
    pub fn resolve_settings(&self, file: &Self) -> Result<Option<ProviderSettings>, SettingsError> {
        // All faults are collected, so that one start of the server shows all of them.
        let mut faults = Vec::new();
        let secret = self.read_secret(file, &mut faults);
        let wanted = self.clone().merged_with(file);
        let settings = wanted.check_settings(secret, &mut faults);
        if faults.is_empty() { Ok(settings) } else { Err(SettingsError(faults)) }
    }

    /// Fills values that are not set from another source.
    fn merged_with(self, other: &Self) -> Self {
        let first = |a: Option<String>, b: &Option<String>| a.or_else(|| b.clone());
        Self {
            issuer: first(self.issuer, &other.issuer),
            client_id: first(self.client_id, &other.client_id),
            client_secret_file: self
                .client_secret_file
                .or_else(|| other.client_secret_file.clone()),
            base_url: first(self.base_url, &other.base_url),
            title: first(self.title, &other.title),
            scopes: first(self.scopes, &other.scopes),
            name_claim: first(self.name_claim, &other.name_claim),
            auto_create: self.auto_create || other.auto_create,
            default_role: first(self.default_role, &other.default_role),
            groups_claim: first(self.groups_claim, &other.groups_claim),
            group_roles: if self.group_roles.is_empty() {
                other.group_roles.clone()
            } else {
                self.group_roles
            },
        }
    }

    /// Reads the client secret: the file of the flag takes precedence over the environment, and
    /// that over the configuration file.
    fn read_secret(&self, file: &Self, faults: &mut Vec<String>) -> Option<String> {
        let read = |path: &Path| match std::fs::read_to_string(path) {
            Ok(text) if !text.trim().is_empty() => Ok(text.trim().to_owned()),
            Ok(_) => Err(format!("oidc client_secret_file: {} is empty", path.display())),
            Err(error) => Err(format!("oidc client_secret_file: {}: {error}", path.display())),
        };
        let variable = || std::env::var(SECRET).ok().filter(|secret| !secret.is_empty());
        let found = match (&self.client_secret_file, variable(), &file.client_secret_file) {
            (Some(path), ..) => read(path),
            (None, Some(secret), _) => Ok(secret),
            (None, None, Some(path)) => read(path),
            (None, None, None) => return None,
        };
        found.map_err(|fault| faults.push(fault)).ok()
    }

    fn check_settings(
        self,
        client_secret: Option<String>,
        faults: &mut Vec<String>,
    ) -> Option<ProviderSettings> {
        let Some(issuer) = self.issuer.clone() else {
            // Any other setting shows that the issuer was forgotten.
            if self != Self::default() {
                faults.push("oidc issuer: is missing; other settings of oidc need it".into());
            }
            return None;
        };
        let host = parse_url(&issuer).and_then(|url| url.host_str().map(str::to_owned));
        checked_url("issuer", &issuer, faults);
        let client_id = self.client_id.clone().unwrap_or_default();
        if client_id.is_empty() || !client_id.bytes().all(|byte| byte.is_ascii_graphic()) {
            faults.push("oidc client_id: must be the id of this server at the provider".into());
        }
        let base_url = self.base_url(faults);
        let scopes = self.scopes.clone().unwrap_or_else(|| "openid profile email".to_owned());
        // Without the scope `openid` the provider sends no ID token.
        if !scopes.split_whitespace().any(|scope| scope == "openid") {
            faults.push("oidc scopes: must include `openid`".into());
        }
        let title = self.title.clone().or(host).unwrap_or_default();
        let admission = self.admission_rules(faults);
        Some(ProviderSettings {
            issuer,
            client_id,
            client_secret,
            base_url,
            title,
            scopes,
            admission,
        })
    }

    fn base_url(&self, faults: &mut Vec<String>) -> String {
        let Some(text) = &self.base_url else {
            faults.push(
                "oidc base_url: is missing; give the address of this server for browsers, such as \
                 https://ships.example"
                    .into(),
            );
            return String::new();
        };
        // The pages of the server are at the root of its address.
        if parse_url(text).is_some_and(|url| url.path() != "/") {
            faults.push("oidc base_url: must end with the host and port, without a path".into());
        }
        checked_url("base_url", text, faults);
        text.trim_end_matches('/').to_owned()
    }

    fn admission_rules(self, faults: &mut Vec<String>) -> AdmissionRules {
        let mut group_roles = Vec::new();
        for rule in &self.group_roles {
            match group_role(rule) {
                Ok(read) => group_roles.push(read),
                Err(why) => faults.push(format!("oidc group_roles: `{rule}`: {why}")),
            }
        }
        let default_role = self.default_role.as_deref().map(str::parse::<Grant>).transpose();
        let default_role = default_role
            .map_err(|why| faults.push(format!("oidc default_role: {why}")))
            .ok()
            .flatten();
        if self.auto_create && self.default_role.is_none() && self.group_roles.is_empty() {
            faults.push(
                "oidc auto_create: needs default_role or group_roles, because a new account would \
                 have no rights"
                    .into(),
            );
        }
        AdmissionRules {
            auto_create: self.auto_create,
            default_role,
            name_claim: self.name_claim,
            groups_claim: self.groups_claim.unwrap_or_else(|| "groups".to_owned()),
            group_roles,
        }
    }
}

/// Parses `GROUP=ROLE`; the name of a group may contain `=`, a role does not.
fn group_role(rule: &str) -> Result<(String, Grant), String> {
    let (group, role) =
        rule.rsplit_once('=').filter(|(group, _)| !group.is_empty()).ok_or("write GROUP=ROLE")?;
    Ok((group.to_owned(), role.parse()?))
}

fn checked_url(name: &str, text: &str, faults: &mut Vec<String>) {
    match parse_url(text) {
        Some(url) if url.query().is_some() => {
            faults.push(format!("oidc {name}: must not contain `?`"))
        }
        // Plain http is allowed for addresses of this machine only.
        Some(url) if !is_safe(&url) => faults.push(format!(
            "oidc {name}: must begin with https://; http:// is allowed for addresses of this \
             machine only"
        )),
        Some(_) => {}
        None => faults.push(format!("oidc {name}: `{text}` is not a URL")),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn least() -> OpenIdArguments {
        OpenIdArguments {
            issuer: Some("https://id.example/realms/yard".into()),
            client_id: Some("ships".into()),
            base_url: Some("https://ships.example/".into()),
            ..OpenIdArguments::default()
        }
    }

    #[test]
    fn flags_win_over_the_file_and_defaults_are_filled_in() {
        let none = OpenIdArguments::default();
        assert_eq!(none.resolve_settings(&none), Ok(None));
        let flags = OpenIdArguments { title: Some("Yard".into()), ..none.clone() };
        let file = OpenIdArguments { title: Some("Other".into()), ..least() };
        let settings = flags.resolve_settings(&file).unwrap().unwrap();
        assert_eq!((settings.title(), settings.scopes.as_str()), ("Yard", "openid profile email"));
        assert_eq!(settings.redirect_uri(), "https://ships.example/sign-in/oidc/callback");
        assert!(settings.is_secure() && !settings.admission_rules().auto_create);
        assert_eq!(least().resolve_settings(&none).unwrap().unwrap().title(), "id.example");
    }

    #[test]
    fn the_secret_is_read_and_never_shown() {
        let path = std::env::temp_dir().join(format!("oidc-secret-{}", std::process::id()));
        std::fs::write(&path, "very secret\n").unwrap();
        let with = OpenIdArguments { client_secret_file: Some(path.clone()), ..least() };
        let settings = with.resolve_settings(&OpenIdArguments::default()).unwrap().unwrap();
        assert_eq!(settings.client_secret.as_deref(), Some("very secret"));
        assert!(!format!("{settings:?}").contains("very secret"));
        std::fs::remove_file(path).unwrap();
        let gone = with.resolve_settings(&OpenIdArguments::default()).unwrap_err();
        assert!(gone.to_string().starts_with("oidc client_secret_file: "), "{gone}");
    }

    #[test]
    fn all_that_is_wrong_is_named_at_once() {
        let wrong = OpenIdArguments {
            issuer: Some("http://id.example".into()),
            client_id: Some("two words".into()),
            base_url: Some("https://ships.example/below".into()),
            scopes: Some("profile".into()),
            default_role: Some("captain".into()),
            group_roles: vec!["yard".into(), "a=b=engineer".into(), "yard=admin@ship:kcs".into()],
            auto_create: true,
            ..OpenIdArguments::default()
        };
        let SettingsError(faults) =
            wrong.resolve_settings(&OpenIdArguments::default()).unwrap_err();
        let named: Vec<&str> =
            faults.iter().map(|fault| fault.split_once(": ").unwrap().0).collect();
        let expected = [
            "issuer",
            "client_id",
            "base_url",
            "scopes",
            "group_roles",
            "group_roles",
            "default_role",
        ];
        assert_eq!(named, expected.map(|name| format!("oidc {name}")), "{faults:?}");
    }

    #[test]
    fn what_cannot_be_is_refused() {
        let refused = |change: fn(&mut OpenIdArguments), name: &str| {
            let mut wanted = least();
            change(&mut wanted);
            let error =
                wanted.resolve_settings(&OpenIdArguments::default()).unwrap_err().to_string();
            assert!(error.starts_with(&format!("oidc {name}: ")), "{error}");
        };
        refused(|wanted| wanted.issuer = None, "issuer");
        refused(|wanted| wanted.issuer = Some("id.example".into()), "issuer");
        refused(|wanted| wanted.issuer = Some("https://me:pw@id.example".into()), "issuer");
        refused(|wanted| wanted.base_url = None, "base_url");
        refused(|wanted| wanted.base_url = Some("http://10.0.0.1".into()), "base_url");
        refused(|wanted| wanted.client_id = None, "client_id");
        refused(|wanted| wanted.auto_create = true, "auto_create");
        let mut here = least();
        here.base_url = Some("http://127.0.0.1:8080".into());
        assert!(here.resolve_settings(&OpenIdArguments::default()).is_ok());
    }
}
