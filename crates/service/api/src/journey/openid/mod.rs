//! Sign-in at an OpenID provider: admission, audit, and refusals.

pub(super) mod knowing;
mod real;

use std::collections::BTreeMap;

use reqwest::{Method, StatusCode};
use serde_json::{Value, json};
use sistership_auth::openid::testing::ScriptedProvider;
use sistership_store::testing::TestDatabase;

use super::harness::{Harness, config};
use crate::{Server, StartError};
use knowing::{Browser, Knowing, PASSWORD, claims, settings, token};

/// A person whom an admin has linked signs in as that user; others are refused.
async fn who_is_linked_gets_in(database: TestDatabase) {
    let hostile = ScriptedProvider::start().await;
    let on = Knowing::on(&database, &hostile, |_| {}).await;
    on.user("ann", "engineer").await;
    let mut browser = Browser::default();
    let page = browser.looks(&on, "/sign-in?next=/jobs").await.text;
    assert!(
        page.contains("Sign in with The yard") && page.contains("/sign-in/oidc?next=%2Fjobs"),
        "{page}"
    );
    let refused = browser.signs_in(&on, &hostile).await;
    assert!(refused.text.contains("no account here is linked with it"), "{}", refused.text);
    assert_eq!(browser.looks(&on, "/v1/me").await.status, StatusCode::UNAUTHORIZED);
    let (action, actor, after) = on.audited(1).await.remove(0);
    assert_eq!((action.as_str(), actor.as_str()), ("session.refuse", "openid"));
    assert_eq!((&after["issuer"], &after["subject"]), (&json!(hostile.url), &json!("7-of-9")));

    let identity = json!({ "identities": [{ "issuer": hostile.url, "subject": "7-of-9" }] });
    let ann = on.owner(Method::PUT, "/v1/users/ann/identities", &identity).await;
    assert_eq!(ann["identities"], identity["identities"]);
    let back = browser.leaves(&on, &hostile, "?next=/jobs?ship%3Dkcs").await;
    let ticket = browser.0["sistership_oidc"].clone();
    let done = browser.looks(&on, &back).await;
    assert_eq!((done.status, done.place.as_str()), (StatusCode::SEE_OTHER, "/jobs?ship=kcs"));
    let session =
        done.cookies.iter().find(|cookie| cookie.starts_with("sistership_session=")).unwrap();
    assert!(session.contains("HttpOnly") && session.contains("SameSite=Lax"), "{session}");
    assert!(!browser.0.contains_key("sistership_oidc"), "the ticket is taken away");
    let me = browser.me(&on).await;
    assert_eq!((&me["name"], &me["kind"]), (&json!("ann"), &json!("user")), "{me}");
    let (action, actor, after) = on.audited(1).await.remove(0);
    assert_eq!((action.as_str(), actor.as_str()), ("session.begin", "ann"));
    assert_eq!(after, json!({ "issuer": hostile.url, "subject": "7-of-9" }));

    // The same way back again, with the ticket that was removed.
    let mut thief = Browser(BTreeMap::from([("sistership_oidc".to_owned(), ticket)]));
    let replayed = thief.looks(&on, &back).await;
    assert!(replayed.text.contains("has expired") && !thief.0.contains_key("sistership_session"));
    on.owner(Method::DELETE, "/v1/users/ann", &Value::Null).await;
    let disabled = browser.signs_in(&on, &hostile).await;
    assert!(disabled.text.contains("disabled"), "{}", disabled.text);
    on.server.stop().await;
}

/// A provider that accepts a code twice does not cause a second sign-in.
async fn a_sign_in_ends_once_whatever_the_provider_says(database: TestDatabase) {
    let hostile = ScriptedProvider::start().await;
    let on = Knowing::on(&database, &hostile, |told| {
        (told.auto_create, told.default_role) = (true, Some("reader".into()));
    })
    .await;
    let mut browser = Browser::default();
    let gone = browser.looks(&on, "/sign-in/oidc").await.place;
    let ticket = browser.0.clone();
    let back = |query: &str| format!("/sign-in/oidc/callback?{query}");
    let first = browser.looks(&on, &back(&hostile.accept_person(&gone))).await;
    assert_eq!(first.status, StatusCode::SEE_OTHER, "{}", first.text);
    let mut again = Browser(ticket);
    let second = again.looks(&on, &back(&hostile.accept_person(&gone))).await;
    assert!(second.text.contains("has ended already"), "{}", second.text);
    assert!(!again.0.contains_key("sistership_session"));
    on.server.stop().await;
}

/// A person without an account gets one, unless the name is taken.
async fn accounts_are_created_where_that_is_set(database: TestDatabase) {
    let hostile = ScriptedProvider::start().await;
    let on = Knowing::on(&database, &hostile, |told| {
        (told.auto_create, told.default_role) = (true, Some("reader".into()));
    })
    .await;
    on.user("ann", "admin").await;
    let mut browser = Browser::default();
    let taken = browser.signs_in(&on, &hostile).await;
    assert!(taken.text.contains("exists but is not linked"), "{}", taken.text);
    claims(&hostile, json!({ "preferred_username": "Bob.Yard", "name": "Bob of the yard" }));
    let done = browser.signs_in(&on, &hostile).await;
    assert_eq!(done.status, StatusCode::SEE_OTHER, "{}", done.text);
    let me = browser.me(&on).await;
    assert_eq!((&me["name"], &me["roles"][0]["role"]), (&json!("bob.yard"), &json!("reader")));
    let bob = on.owner(Method::GET, "/v1/users/bob.yard", &Value::Null).await;
    assert_eq!((&bob["title"], &bob["has_password"]), (&json!("Bob of the yard"), &json!(false)));
    // Another name for the same subject is the same user.
    claims(&hostile, json!({ "preferred_username": "robert" }));
    browser.signs_in(&on, &hostile).await;
    assert_eq!(browser.me(&on).await["name"], "bob.yard");
    // The same name for another subject is not linked yet.
    claims(&hostile, json!({ "sub": "1-of-9", "preferred_username": "bob.yard" }));
    let other = Browser::default().signs_in(&on, &hostile).await;
    assert!(other.text.contains("exists but is not linked"), "{}", other.text);
    claims(&hostile, json!({ "sub": "2-of-9", "preferred_username": "A <b>bold</b> name" }));
    let unnamed = Browser::default().signs_in(&on, &hostile).await;
    assert!(
        unnamed.text.contains("&#60;b&#62;") || unnamed.text.contains("&lt;b&gt;"),
        "{}",
        unnamed.text
    );
    let found = sistership_jobs::upkeep::check_archive(on.server.archive()).await.unwrap();
    assert!(found.clean, "{:?}", found.faults);
    on.server.stop().await;
}

/// The roles of groups are given and removed at each sign-in.
async fn groups_say_what_people_may_do(database: TestDatabase) {
    let hostile = ScriptedProvider::start().await;
    let on = Knowing::on(&database, &hostile, |told| {
        told.auto_create = true;
        told.group_roles =
            vec!["yard=engineer".into(), "owners=approver".into(), "pilots=reader@ship:kcs".into()];
    })
    .await;
    let roles = async |browser: &mut Browser, groups: Value| {
        claims(&hostile, json!({ "groups": groups }));
        browser.signs_in(&on, &hostile).await;
        let me = browser.me(&on).await;
        let roles = me["roles"].as_array().cloned().unwrap_or_default();
        roles.iter().map(|role| role["role"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    let mut browser = Browser::default();
    assert!(roles(&mut browser, json!(["strangers"])).await.is_empty());
    assert!(
        on.owner(Method::GET, "/v1/users", &Value::Null).await["items"]
            .as_array()
            .unwrap()
            .is_empty()
    );
    assert_eq!(roles(&mut browser, json!(["yard"])).await, ["engineer"]);
    let count = on.entries().await;
    assert_eq!(roles(&mut browser, json!(["yard"])).await, ["engineer"]);
    assert_eq!(on.entries().await, count + 1, "the session alone");
    assert_eq!(
        roles(&mut browser, json!(["owners", "pilots", "yard"])).await,
        ["approver", "reader"]
    );
    let set = on.audited(2).await;
    assert_eq!((set[1].0.as_str(), set[1].1.as_str()), ("roles.set", "openid"));
    let mut fresh = Browser::default();
    assert!(roles(&mut fresh, json!([])).await.is_empty(), "not let in");
    let ann = on.owner(Method::GET, "/v1/users/ann", &Value::Null).await;
    assert_eq!(ann["roles"], json!([]), "nothing is left of them");
    on.server.stop().await;
}

/// A user who has signed in by password links the own account on its page, and no other.
async fn people_link_their_own_account(database: TestDatabase) {
    let hostile = ScriptedProvider::start().await;
    let on = Knowing::on(&database, &hostile, |_| {}).await;
    for name in ["ann", "bob"] {
        on.user(name, "reader").await;
    }
    let signed_in = async |name: &str| {
        let mut browser = Browser::default();
        let page = browser.looks(&on, "/sign-in").await.text;
        let form = [("name", name), ("password", PASSWORD), ("form_token", token(&page))];
        let done = browser.sends(&on, "/sign-in", &form).await;
        assert_eq!(done.status, StatusCode::SEE_OTHER, "{}", done.text);
        browser
    };
    let mut ann = signed_in("ann").await;
    let without = ann.sends(&on, "/account/identity", &[]).await;
    assert_eq!(without.status, StatusCode::FORBIDDEN, "no form of this server");
    let page = ann.looks(&on, "/account").await.text;
    let page = ann.sends(&on, "/account/identity", &[("form_token", token(&page))]).await.text;
    let place = page.split("href=\"http").nth(1).unwrap().split('"').next().unwrap();
    let place = format!("http{place}").replace("&#38;", "&").replace("&amp;", "&");
    let query = hostile.accept_person(&place);
    let back = format!("/sign-in/oidc/callback?{query}");
    // In the browser of another person, who is given the ticket.
    let mut bob = signed_in("bob").await;
    bob.0.insert("sistership_oidc".into(), ann.0["sistership_oidc"].clone());
    let other = bob.looks(&on, &back).await;
    assert!(other.text.contains("sign in as ann again"), "{}", other.text);
    let back = format!("/sign-in/oidc/callback?{}", hostile.accept_person(&place));
    let done = ann.looks(&on, &back).await;
    assert_eq!(done.place, "/account?done=link", "{}", done.text);
    let account = ann.looks(&on, &done.place).await.text;
    assert!(account.contains("Your account is linked") && account.contains("7-of-9"), "{account}");
    let mut browser = Browser::default();
    browser.signs_in(&on, &hostile).await;
    assert_eq!(browser.me(&on).await["name"], "ann");
    on.server.stop().await;
}

/// No redirect leads to another site, and each failure is shown on the sign-in page.
async fn failures_are_told_and_local_accounts_go_on(database: TestDatabase) {
    let hostile = ScriptedProvider::start().await;
    hostile.lock_script().down = true;
    let on = Knowing::on(&database, &hostile, |_| {}).await;
    on.user("ann", "reader").await;
    let mut browser = Browser::default();
    let page = browser.looks(&on, "/sign-in/oidc").await;
    assert!(
        page.status == StatusCode::OK && page.text.contains("cannot be reached"),
        "{}",
        page.text
    );
    let form = [("name", "ann"), ("password", PASSWORD), ("form_token", token(&page.text))];
    assert_eq!(browser.sends(&on, "/sign-in", &form).await.status, StatusCode::SEE_OTHER);
    hostile.lock_script().down = false;
    for next in ["//evil.example", "/%5Cevil.example", "/%09/evil.example", "https://evil.example"]
    {
        let page = browser.looks(&on, &format!("/sign-in?next={next}")).await.text;
        assert!(!page.contains("evil"), "{page}");
        let identity = json!({ "identities": [{ "issuer": hostile.url, "subject": "7-of-9" }] });
        on.owner(Method::PUT, "/v1/users/ann/identities", &identity).await;
        let back = browser.leaves(&on, &hostile, &format!("?next={next}")).await;
        assert_eq!(browser.looks(&on, &back).await.place, "/", "{next}");
    }
    let back = browser.leaves(&on, &hostile, "").await;
    let (_, rest) = back.split_once('&').unwrap();
    let denied =
        browser.looks(&on, &format!("/sign-in/oidc/callback?error=access_denied&{rest}")).await;
    assert!(denied.text.contains("has denied access"), "{}", denied.text);
    let expired = browser.looks(&on, &back).await;
    assert!(expired.text.contains("has expired") && expired.text.contains("Sign in with The yard"));
    let twice = browser.looks(&on, "/sign-in/oidc/callback?state=a&state=b").await;
    assert!(twice.status == StatusCode::OK && twice.text.contains("has expired"), "{}", twice.text);
    on.server.stop().await;
}

#[tokio::test]
async fn without_accounts_there_is_no_provider() {
    let database = TestDatabase::new_sqlite();
    let mut config = config(&database);
    config.openid = Some(settings("http://127.0.0.1:1", "https://id.example", "a", |_| {}));
    let refused = Server::start(config).await;
    assert!(matches!(refused, Err(StartError::OpenIdWithoutAccounts)), "{refused:?}");
    let harness = Harness::on(TestDatabase::new_sqlite()).await;
    for path in ["/sign-in/oidc", "/sign-in/oidc/callback?code=a"] {
        let answer = harness.client.get(harness.url(path)).send().await.unwrap();
        assert_eq!(answer.status(), StatusCode::NOT_FOUND);
        let cookie = answer.headers().get("set-cookie").map(|cookie| cookie.to_str().unwrap());
        let is_removed =
            cookie.is_some_and(|cookie| cookie.starts_with("sistership_oidc=; Max-Age=0"));
        assert_eq!(
            is_removed,
            path.contains("callback"),
            "a failure removes the ticket: {cookie:?}"
        );
    }
    harness.server.stop().await;
}

on_both_databases!(
    who_is_linked_gets_in,
    a_sign_in_ends_once_whatever_the_provider_says,
    accounts_are_created_where_that_is_set,
    groups_say_what_people_may_do,
    people_link_their_own_account,
    failures_are_told_and_local_accounts_go_on,
);
