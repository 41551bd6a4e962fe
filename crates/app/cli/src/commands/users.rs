//! `sistership users`: users and their roles, directly in the store.

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand, ValueEnum};
use serde_json::{Value, json};
use sistership_auth::{
    Grant, PasswordError, check_name, check_password, hash_password, random_secret,
};
use sistership_jobs::Archive;
use sistership_store::{GrantRow, MAX_LIMIT, PageRequest, StoreError, User};

use super::store::{StoreArguments, with_archive};
use crate::failure::Failure;
use crate::output;
use crate::table::TextTable;
use crate::zoo::read_text_file;

const EXAMPLES: &str = "\
Examples:
  sistership users add ann --role engineer --password-file ann.txt
  sistership users add bob --role reader --role approver@family:tankers
  sistership users roles ann engineer@ship:kvlcc2
  sistership users identity ann https://id.example 248289761001
  sistership users disable ann
  sistership users second-person on

Roles are reader, engineer, approver and admin, each with the rights of those before it;
@ship:NAME and @family:NAME restrict one. Without --password-file a random password is printed.
Running servers apply changes within a second.";

/// Manage the users of a store: add, list, assign roles, disable.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct UsersArguments {
    #[command(subcommand)]
    what: UsersAction,
    #[command(flatten)]
    store: StoreArguments,
    /// Print one JSON document.
    #[arg(long, global = true)]
    json: bool,
}

#[derive(Debug, Subcommand)]
enum UsersAction {
    /// Create a user.
    Add {
        /// User name; it cannot be changed later.
        name: String,
        /// Displayed name; by default the user name.
        #[arg(long)]
        title: Option<String>,
        /// A role; repeatable.
        #[arg(long = "role", value_name = "ROLE[@ship:NAME|@family:NAME]")]
        roles: Vec<Grant>,
        /// File that holds the password.
        #[arg(long, value_name = "FILE")]
        password_file: Option<PathBuf>,
    },
    /// List the users.
    List,
    /// Replace the roles of a user.
    Roles {
        /// The user.
        name: String,
        /// The new roles; none removes all rights.
        #[arg(value_name = "ROLE[@ship:NAME|@family:NAME]")]
        roles: Vec<Grant>,
    },
    /// Link a user to one subject of an OpenID provider; without a subject, remove the link.
    Identity {
        /// The user.
        name: String,
        /// The provider, and its claim `sub`.
        #[arg(num_args = 2, value_names = ["ISSUER", "SUBJECT"])]
        identity: Vec<String>,
    },
    /// Set a password and end all sessions of the user.
    Password {
        /// The user.
        name: String,
        /// File that holds the password.
        #[arg(long, value_name = "FILE")]
        password_file: Option<PathBuf>,
    },
    /// Remove all rights of a user; the name stays reserved.
    Disable {
        /// The user.
        name: String,
    },
    /// Restore the rights of a disabled user.
    Enable {
        /// The user.
        name: String,
    },
    /// Require that champions are approved by a person other than their author.
    SecondPerson {
        /// New value; by default the present value is shown.
        set: Option<OnOff>,
    },
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum OnOff {
    On,
    Off,
}

/// Error of a command on users.
#[derive(Debug, thiserror::Error)]
enum UsersError {
    #[error(transparent)]
    Store(#[from] StoreError),
    #[error(transparent)]
    Password(#[from] PasswordError),
}

type UsersResult = Result<(Value, String), UsersError>;

/// New password, given or generated; a generated one is printed.
struct NewPassword {
    text: String,
    drawn: bool,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the call is wrong, if the store does not exist, or if it refuses the
/// command.
pub fn run(users: &UsersArguments) -> Result<(), Failure> {
    let chosen = match &users.what {
        UsersAction::Add { name, password_file, .. } => {
            // Checked before the store is opened: a wrong name is a wrong call.
            check_name(name).map_err(|message| Failure::Call(format!("name: {message}")))?;
            Some(new_password(password_file.as_deref())?)
        }
        UsersAction::Password { password_file, .. } => {
            Some(new_password(password_file.as_deref())?)
        }
        _ => None,
    };
    let work = async |archive: &Archive| run_action(&users.what, chosen.as_ref(), archive).await;
    let (document, text) = with_archive(&users.store, work)?;
    output::print_result(users.json, &document, || text)
}

fn new_password(file: Option<&Path>) -> Result<NewPassword, Failure> {
    let Some(path) = file else {
        let text = random_secret().map_err(|error| Failure::Refused(error.to_string()))?;
        return Ok(NewPassword { text, drawn: true });
    };
    // Editors end a file with a newline, which is no part of the password.
    let text = read_text_file(path)?.trim_end_matches(['\r', '\n']).to_owned();
    check_password(&text).map_err(|message| crate::failure::about_file(path, message))?;
    Ok(NewPassword { text, drawn: false })
}

async fn run_action(
    what: &UsersAction,
    chosen: Option<&NewPassword>,
    archive: &Archive,
) -> UsersResult {
    let users = archive.store.users();
    match what {
        UsersAction::Add { name, title, roles, .. } => {
            // Hashed before the row is written: the store never sees the password itself.
            let hash = chosen.map(|chosen| hash_password(&chosen.text)).transpose()?;
            let title = title.as_deref().unwrap_or(name);
            users.create(name, title, hash.as_deref(), &grant_rows(roles)).await?;
            user_result(name, "created", chosen)
        }
        UsersAction::List => list_users(archive).await,
        UsersAction::Roles { name, roles } => {
            archive
                .store
                .grants()
                .replace_roles(&User::principal_name(name), &grant_rows(roles))
                .await?;
            user_result(name, "the roles are set", None)
        }
        UsersAction::Identity { name, identity } => {
            let pair = |pair: &[String]| (pair[0].clone(), pair[1].clone());
            // An empty list removes the link to a provider.
            let those: Vec<_> = identity.chunks_exact(2).map(pair).collect();
            archive.store.identities().replace_identities(name, &those).await?;
            user_result(name, "the link with the provider is set", None)
        }
        UsersAction::Password { name, .. } => {
            let hash = chosen.map(|chosen| hash_password(&chosen.text)).transpose()?;
            users.set_password(name, hash.as_deref().unwrap_or_default()).await?;
            user_result(name, "the password is set", chosen)
        }
        UsersAction::Disable { name } => {
            user_result(&users.disable(name).await?.name, "disabled", None)
        }
        UsersAction::Enable { name } => {
            user_result(&users.enable(name).await?.name, "enabled", None)
        }
        UsersAction::SecondPerson { set } => second_person(archive, *set).await,
    }
}

/// Describes what was done to a user, with the password if it was generated.
fn user_result(name: &str, what: &str, chosen: Option<&NewPassword>) -> UsersResult {
    // A given password is never printed.
    let drawn = chosen.filter(|chosen| chosen.drawn).map(|chosen| &chosen.text);
    let secret = drawn.map_or_else(String::new, |text| format!("; the password is {text}"));
    Ok((
        json!({ "name": name, "done": what, "password": drawn }),
        format!("{name}: {what}{secret}"),
    ))
}

async fn second_person(archive: &Archive, set: Option<OnOff>) -> UsersResult {
    let settings = archive.store.settings();
    if let Some(set) = set {
        settings.set_second_person(set == OnOff::On).await?;
    }
    let on = settings.requires_second_person().await?;
    let text = if on {
        "approval by a second person is required"
    } else {
        "approval by a second \
                                                                           person is not required"
    };
    Ok((json!({ "second_person": on }), text.to_owned()))
}

/// Converts roles to rows of the store.
pub(super) fn grant_rows(roles: &[Grant]) -> Vec<GrantRow> {
    let row = |grant: &Grant| {
        let (kind, name) = grant.scope.to_parts();
        let (scope_kind, scope_name) = (kind.to_owned(), name.to_owned());
        GrantRow { scope_kind, scope_name, role: grant.role.as_str().to_owned() }
    };
    roles.iter().map(row).collect()
}

/// Converts rows of the store to the text form of roles.
pub(super) fn grant_texts(rows: &[GrantRow]) -> Vec<String> {
    let word = |row: &GrantRow| match row.scope_kind.as_str() {
        "server" => row.role.clone(),
        kind => format!("{}@{kind}:{}", row.role, row.scope_name),
    };
    rows.iter().map(word).collect()
}

async fn list_users(archive: &Archive) -> UsersResult {
    let mut table = TextTable::new(["name", "title", "roles", "state"]);
    let (mut all, mut page) = (Vec::new(), PageRequest::first_page(MAX_LIMIT));
    loop {
        let users = archive.store.users().list(&page).await?;
        for user in users.items {
            // One query for each user: a store has few users.
            let roles = grant_texts(
                &archive
                    .store
                    .grants()
                    .list_by_principal(&User::principal_name(&user.name))
                    .await?,
            );
            let state = if user.is_enabled() { "enabled" } else { "disabled" };
            table.add_row([
                user.name.clone(),
                user.title.clone(),
                roles.join(" "),
                state.to_owned(),
            ]);
            all.push(json!({ "name": user.name, "title": user.title, "roles": roles,
                "enabled": user.is_enabled() }));
        }
        let Some(next) = users.next else { break };
        page = PageRequest::after_key(next, MAX_LIMIT);
    }
    Ok((json!({ "users": all }), table.to_string()))
}
