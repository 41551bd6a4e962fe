//! Admission of persons with an account at a provider: their name here and their roles.

use std::collections::BTreeMap;

use crate::{Grant, Role, Scope, check_name};
use serde_json::{Map, Value};

use crate::openid::failure::{Result, SignInFailure};

/// Rules of admission of persons with an account at a provider.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AdmissionRules {
    /// True if a person without an account here gets one.
    pub auto_create: bool,
    /// Role of every person who signs in at the provider, in addition to those of their groups.
    pub default_role: Option<Grant>,
    /// Claim with the name of the account; default: `preferred_username`, else a verified `email`.
    pub name_claim: Option<String>,
    /// Claim with the list of groups.
    pub groups_claim: String,
    /// Roles by group.
    pub group_roles: Vec<(String, Grant)>,
}

impl AdmissionRules {
    /// Returns true if the provider's groups determine the roles.
    pub fn by_groups(&self) -> bool {
        !self.group_roles.is_empty()
    }

    /// Returns the roles of a person with these claims; for each scope the highest role of any
    /// group.
    pub fn granted_roles(&self, claims: &Map<String, Value>) -> Vec<Grant> {
        let groups = text_list(claims.get(&self.groups_claim));
        let given = self.group_roles.iter().filter(|(group, _)| groups.contains(&group.as_str()));
        let given = given.map(|(_, grant)| grant).chain(&self.default_role);
        // Ordered by scope, so that the same groups give the same list.
        let mut most: BTreeMap<Scope, Role> = BTreeMap::new();
        for Grant { scope, role } in given {
            let known = most.entry(scope.clone()).or_insert(*role);
            *known = (*known).max(*role);
        }
        most.into_iter().map(|(scope, role)| Grant { scope, role }).collect()
    }

    /// Returns true if the claims have the name and the groups that are needed; otherwise the
    /// UserInfo endpoint may have them.
    pub fn is_answered_by(&self, claims: &Map<String, Value>) -> bool {
        let named = !self.auto_create || self.claimed_name(claims).is_some();
        named && (!self.by_groups() || claims.contains_key(&self.groups_claim))
    }

    /// Returns the name in the claims, not checked.
    fn claimed_name<'a>(&self, claims: &'a Map<String, Value>) -> Option<&'a str> {
        match &self.name_claim {
            Some(claim) => text_claim(claims, claim),
            None => {
                text_claim(claims, "preferred_username").or_else(|| text_claim(claims, "email"))
            }
        }
    }

    /// Returns the name for a new account, in lower case.
    ///
    /// # Errors
    /// Returns an error if the claims have no name, or one that is not valid here.
    pub fn account_name(&self, claims: &Map<String, Value>) -> Result<String> {
        let found = self.claimed_name(claims);
        let claim =
            self.name_claim.as_deref().unwrap_or("preferred_username` or a verified `email");
        let Some(found) = found else {
            return Err(SignInFailure::Lacking(format!(
                "the provider does not send `{claim}`, from which your user name here is derived"
            )));
        };
        // Providers may keep upper case; names here have none.
        let name = found.to_lowercase();
        match check_name(&name) {
            Ok(()) => Ok(name),
            Err(why) => Err(SignInFailure::Lacking(format!(
                "the provider's name for you is `{}`, but a user name {why}",
                name.chars().take(64).collect::<String>()
            ))),
        }
    }
}

/// Returns a claim of text; an email address only if the provider has verified it.
fn text_claim<'a>(claims: &'a Map<String, Value>, claim: &str) -> Option<&'a str> {
    if claim == "email" && claims.get("email_verified") != Some(&Value::Bool(true)) {
        return None;
    }
    claims.get(claim).and_then(Value::as_str).filter(|text| !text.is_empty())
}

/// Returns the texts of a list, or a single text as a list of one.
fn text_list(value: Option<&Value>) -> Vec<&str> {
    match value {
        Some(Value::Array(items)) => items.iter().filter_map(Value::as_str).collect(),
        Some(Value::String(word)) => vec![word],
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use serde_json::json;

    fn admission(group_roles: &[(&str, &str)]) -> AdmissionRules {
        let grant = |&(group, role): &(&str, &str)| (group.to_owned(), role.parse().unwrap());
        AdmissionRules {
            auto_create: true,
            default_role: Some(Grant::on_server(Role::Reader)),
            name_claim: None,
            groups_claim: "groups".into(),
            group_roles: group_roles.iter().map(grant).collect(),
        }
    }

    fn claims(value: Value) -> Map<String, Value> {
        value.as_object().unwrap().clone()
    }

    #[test]
    fn the_most_that_the_groups_give_is_given() {
        let rules = [
            ("yard", "engineer"),
            ("owners", "approver"),
            ("yard", "engineer@ship:kcs"),
            ("pilots", "reader@ship:kcs"),
        ];
        let roles = |groups: Value| {
            let grants = admission(&rules).granted_roles(&claims(json!({ "groups": groups })));
            grants.iter().map(ToString::to_string).collect::<Vec<_>>()
        };
        assert_eq!(roles(json!(["yard", "owners", "other"])), ["approver", "engineer@ship:kcs"]);
        assert_eq!(roles(json!("pilots")), ["reader", "reader@ship:kcs"]);
        assert_eq!(roles(json!(["Yard", 7])), ["reader"]);
        assert_eq!(roles(Value::Null), ["reader"]);
        let alone = AdmissionRules { default_role: None, ..admission(&rules) };
        assert!(alone.granted_roles(&claims(json!({ "groups": [] }))).is_empty());
    }

    #[test]
    fn names_are_those_that_accounts_may_have() {
        let all = admission(&[]);
        let name =
            |admission: &AdmissionRules, value: Value| admission.account_name(&claims(value));
        let both = json!({ "preferred_username": "Ann", "email": "a@b.c", "email_verified": true });
        assert_eq!(name(&all, both.clone()), Ok("ann".into()));
        let mail = json!({ "email": "Ann@Yard.example", "email_verified": true });
        assert_eq!(name(&all, mail), Ok("ann@yard.example".into()));
        let by_mail = AdmissionRules { name_claim: Some("email".into()), ..all.clone() };
        assert_eq!(name(&by_mail, both), Ok("a@b.c".into()));
        for wrong in [
            json!({}),
            json!({ "email": "ann@yard.example" }),
            json!({ "email": "ann@yard.example", "email_verified": "true" }),
            json!({ "preferred_username": "Ann Bee" }),
            json!({ "preferred_username": "local" }),
            json!({ "preferred_username": 7 }),
        ] {
            assert!(matches!(name(&all, wrong.clone()), Err(SignInFailure::Lacking(_))), "{wrong}");
        }
    }
}
