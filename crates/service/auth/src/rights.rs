//! Rights that follow from all granted roles.

use crate::grant::{Grant, Scope};
use crate::role::Role;

/// The granted roles of a user or key, and the decisions based on them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Rights(Vec<Grant>);

impl Rights {
    /// Creates the rights that follow from roles.
    pub fn new(mut grants: Vec<Grant>) -> Self {
        grants.sort();
        Self(grants)
    }

    /// Creates the rights of an administrator of the whole server.
    pub fn full_access() -> Self {
        Self(vec![Grant::on_server(Role::Admin)])
    }

    /// Returns the roles, sorted.
    pub fn grants(&self) -> &[Grant] {
        &self.0
    }

    /// Returns true if the role, or a higher one, is granted for the whole server.
    pub fn on_server(&self, role: Role) -> bool {
        // `None` sorts below every role: without a grant the comparison is false.
        self.highest_role(|scope| *scope == Scope::Server) >= Some(role)
    }

    /// Returns true if the role, or a higher one, is granted for any scope.
    pub fn holds_anywhere(&self, role: Role) -> bool {
        self.highest_role(|_| true) >= Some(role)
    }

    /// Returns true if the role, or a higher one, is granted for a ship: by name, by one of its
    /// families, or for the whole server.
    pub fn on_ship(&self, role: Role, ship: &str, families: &[String]) -> bool {
        let given = |scope: &Scope| match scope {
            Scope::Server => true,
            Scope::Ship(name) => name == ship,
            Scope::Family(name) => families.contains(name),
        };
        self.highest_role(given) >= Some(role)
    }

    /// Returns true if the role, or a higher one, is granted for a family.
    pub fn on_family(&self, role: Role, family: &str) -> bool {
        let given = |scope: &Scope| match scope {
            Scope::Server => true,
            Scope::Family(name) => name == family,
            Scope::Ship(_) => false,
        };
        self.highest_role(given) >= Some(role)
    }

    /// Returns true if a role is granted for a family, so that the families of a ship must be
    /// known.
    pub fn by_family(&self) -> bool {
        self.0.iter().any(|grant| matches!(grant.scope, Scope::Family(_)))
    }

    fn highest_role(&self, given: impl Fn(&Scope) -> bool) -> Option<Role> {
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
            let rights = Rights::new(vec![Grant::on_server(given)]);
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
        assert!(rights.holds_anywhere(Role::Approver) && !rights.holds_anywhere(Role::Admin));
        assert!(rights.by_family());
    }

    #[test]
    fn who_has_no_role_may_do_nothing() {
        let none = Rights::default();
        assert!(!none.on_server(Role::Reader) && !none.holds_anywhere(Role::Reader));
        assert!(!none.on_ship(Role::Reader, "a", &[]) && !none.by_family());
    }
}
