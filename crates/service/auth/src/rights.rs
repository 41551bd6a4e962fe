//! What somebody may do, by all the roles that they have been given.

use crate::grant::{Grant, Scope};
use crate::role::Role;

/// The roles of somebody.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Rights(Vec<Grant>);

impl Rights {
    /// Those of somebody who has these roles.
    pub fn new(mut grants: Vec<Grant>) -> Self {
        grants.sort();
        Self(grants)
    }

    /// Those of somebody who may do everything.
    pub fn all() -> Self {
        Self(vec![Grant::everywhere(Role::Admin)])
    }

    /// The roles, in order.
    pub fn grants(&self) -> &[Grant] {
        &self.0
    }

    /// Whether the role is given for the whole server.
    pub fn on_server(&self, role: Role) -> bool {
        self.highest(|scope| *scope == Scope::Server) >= Some(role)
    }

    /// Whether the role is given for anything at all.
    pub fn anywhere(&self, role: Role) -> bool {
        self.highest(|_| true) >= Some(role)
    }

    /// Whether the role is given for a ship: by name, by one of its families, or for everything.
    pub fn on_ship(&self, role: Role, ship: &str, families: &[String]) -> bool {
        let given = |scope: &Scope| match scope {
            Scope::Server => true,
            Scope::Ship(name) => name == ship,
            Scope::Family(name) => families.contains(name),
        };
        self.highest(given) >= Some(role)
    }

    /// Whether the role is given for a family.
    pub fn on_family(&self, role: Role, family: &str) -> bool {
        let given = |scope: &Scope| match scope {
            Scope::Server => true,
            Scope::Family(name) => name == family,
            Scope::Ship(_) => false,
        };
        self.highest(given) >= Some(role)
    }

    /// Whether it depends on a ship's families what may be done to it.
    pub fn by_family(&self) -> bool {
        self.0.iter().any(|grant| matches!(grant.scope, Scope::Family(_)))
    }

    fn highest(&self, given: impl Fn(&Scope) -> bool) -> Option<Role> {
        self.0.iter().filter(|grant| given(&grant.scope)).map(|grant| grant.role).max()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn rights(grants: &[&str]) -> Rights {
        Rights::new(grants.iter().map(|grant| grant.parse().unwrap()).collect())
    }

    #[test]
    fn each_role_has_the_rights_of_those_before_it() {
        for (n, given) in Role::ALL.into_iter().enumerate() {
            let rights = Rights::new(vec![Grant::everywhere(given)]);
            for (m, asked) in Role::ALL.into_iter().enumerate() {
                assert_eq!(rights.on_server(asked), m <= n, "{given} as {asked}");
                assert_eq!(rights.on_ship(asked, "any", &[]), m <= n);
                assert_eq!(rights.on_family(asked, "any"), m <= n);
            }
        }
    }

    #[test]
    fn a_role_for_a_ship_or_a_family_goes_no_further() {
        let rights = rights(&["reader", "engineer@ship:a", "approver@family:f"]);
        let f = ["f".to_owned()];
        assert!(rights.on_ship(Role::Engineer, "a", &[]));
        assert!(!rights.on_ship(Role::Approver, "a", &[]));
        assert!(rights.on_ship(Role::Approver, "b", &f) && rights.on_family(Role::Approver, "f"));
        assert!(
            !rights.on_ship(Role::Engineer, "b", &[]) && !rights.on_family(Role::Engineer, "g")
        );
        assert!(rights.on_server(Role::Reader) && !rights.on_server(Role::Engineer));
        assert!(rights.anywhere(Role::Approver) && !rights.anywhere(Role::Admin));
        assert!(rights.by_family());
    }

    #[test]
    fn who_has_no_role_may_do_nothing() {
        let none = Rights::default();
        assert!(!none.on_server(Role::Reader) && !none.anywhere(Role::Reader));
        assert!(!none.on_ship(Role::Reader, "a", &[]) && !none.by_family());
    }
}
