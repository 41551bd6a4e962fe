//! Caller and access: the decisions of `sistership_auth` for the routes of this server.

mod decide;
mod table;

pub(crate) use decide::{
    RightsRequest, check_access, check_server_role, check_ship_role, filter_visible, readable_trial,
};
pub(crate) use sistership_web_support::acting::{
    AuthenticationKind, RequestActor, carry_actor, current_actor,
};
pub(crate) use table::{HEALTH_ROUTES, OPEN_ROUTES, SECOND_PERSON};
#[cfg(test)]
pub(crate) use table::{IDENTIFIED_ROUTES, ROLE_TABLE, RoleScope};
