//! Who of those that a provider knows gets in, under which name and with which roles.

use std::collections::BTreeMap;

use crate::{Grant, Role, Scope, check_name};
use serde_json::{Map, Value};

use crate::openid::failure::{Failure, Result};

/// Who of those that a provider knows gets in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Admission {
    /// Whether whoever has no account gets one.
    pub auto_create: bool,
    /// What everybody may do who gets in by the provider, where it is not by their groups alone.
    pub default_role: Option<Grant>,
    /// The claim that names the account; `preferred_username`, else a verified `email`, where none
    /// is set.
    pub name_claim: Option<String>,
    /// The claim that lists the groups.
    pub groups_claim: String,
    /// What members of a group may do.
    pub group_roles: Vec<(String, Grant)>,
}

impl Admission {
    /// Whether the provider's groups say what people may do.
    pub fn by_groups(&self) -> bool {
        !self.group_roles.is_empty()
    }

    /// What somebody may do by the groups that the claims name; for each ship, family or the server
    /// the most that any of them gives.
    pub fn roles(&self, claims: &Map<String, Value>) -> Vec<Grant> {
        let groups = words(claims.get(&self.groups_claim));
        let given = self.group_roles.iter().filter(|(group, _)| groups.contains(&group.as_str()));
        let given = given.map(|(_, grant)| grant).chain(&self.default_role);
        let mut most: BTreeMap<Scope, Role> = BTreeMap::new();
        for Grant { scope, role } in given {
            let known = most.entry(scope.clone()).or_insert(*role);
            *known = (*known).max(*role);
        }
        most.into_iter().map(|(scope, role)| Grant { scope, role }).collect()
    }

    /// Whether the claims hold all that is asked for; the provider may have more elsewhere.
    pub fn is_answered_by(&self, claims: &Map<String, Value>) -> bool {
        let named = !self.auto_create || self.called(claims).is_some();
        named && (!self.by_groups() || claims.contains_key(&self.groups_claim))
    }

    /// What the claims call somebody, whatever that is worth here.
    fn called<'a>(&self, claims: &'a Map<String, Value>) -> Option<&'a str> {
        match &self.name_claim {
            Some(claim) => text(claims, claim),
            None => text(claims, "preferred_username").or_else(|| text(claims, "email")),
        }
    }

    /// The name of an account to be.
    ///
    /// # Errors
    /// The claims hold none, or one that no account may have.
    pub fn name(&self, claims: &Map<String, Value>) -> Result<String> {
        let found = self.called(claims);
        let claim =
            self.name_claim.as_deref().unwrap_or("preferred_username` or a verified `email");
        let Some(found) = found else {
            return Err(Failure::Lacking(format!(
                "the provider does not say `{claim}`, by which you would have a name here"
            )));
        };
        let name = found.to_lowercase();
        match check_name(&name) {
            Ok(()) => Ok(name),
            Err(why) => Err(Failure::Lacking(format!(
                "the provider calls you `{}`, and a name here {why}",
                name.chars().take(64).collect::<String>()
            ))),
        }
    }
}

/// A claim that is a text; an address only where the provider has verified it.
fn text<'a>(claims: &'a Map<String, Value>, claim: &str) -> Option<&'a str> {
    if claim == "email" && claims.get("email_verified") != Some(&Value::Bool(true)) {
        return None;
    }
    claims.get(claim).and_then(Value::as_str).filter(|text| !text.is_empty())
}

/// The texts of a list; of a text, itself.
fn words(value: Option<&Value>) -> Vec<&str> {
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

    fn admission(group_roles: &[(&str, &str)]) -> Admission {
        let grant = |&(group, role): &(&str, &str)| (group.to_owned(), role.parse().unwrap());
        Admission {
            auto_create: true,
            default_role: Some(Grant::everywhere(Role::Reader)),
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
            let grants = admission(&rules).roles(&claims(json!({ "groups": groups })));
            grants.iter().map(ToString::to_string).collect::<Vec<_>>()
        };
        assert_eq!(roles(json!(["yard", "owners", "other"])), ["approver", "engineer@ship:kcs"]);
        assert_eq!(roles(json!("pilots")), ["reader", "reader@ship:kcs"]);
        assert_eq!(roles(json!(["Yard", 7])), ["reader"]);
        assert_eq!(roles(Value::Null), ["reader"]);
        let alone = Admission { default_role: None, ..admission(&rules) };
        assert!(alone.roles(&claims(json!({ "groups": [] }))).is_empty());
    }

    #[test]
    fn names_are_those_that_accounts_may_have() {
        let all = admission(&[]);
        let name = |admission: &Admission, value: Value| admission.name(&claims(value));
        let both = json!({ "preferred_username": "Ann", "email": "a@b.c", "email_verified": true });
        assert_eq!(name(&all, both.clone()), Ok("ann".into()));
        let mail = json!({ "email": "Ann@Yard.example", "email_verified": true });
        assert_eq!(name(&all, mail), Ok("ann@yard.example".into()));
        let by_mail = Admission { name_claim: Some("email".into()), ..all.clone() };
        assert_eq!(name(&by_mail, both), Ok("a@b.c".into()));
        for wrong in [
            json!({}),
            json!({ "email": "ann@yard.example" }),
            json!({ "email": "ann@yard.example", "email_verified": "true" }),
            json!({ "preferred_username": "Ann Bee" }),
            json!({ "preferred_username": "local" }),
            json!({ "preferred_username": 7 }),
        ] {
            assert!(matches!(name(&all, wrong.clone()), Err(Failure::Lacking(_))), "{wrong}");
        }
    }
}
