//! A person in a browser: signs in, reads, changes something, and signs out.

use reqwest::redirect::Policy;
use reqwest::{Client, RequestBuilder, Response, StatusCode};
use sistership_auth::hash_password;
use sistership_store::GrantRow;
use sistership_store::testing::TestDatabase;

use super::harness::{Harness, config};
use crate::Server;

const PASSWORD: &str = "a long sentence of its own";
const NEW: &str = "another long sentence";

/// Browser of a user.
struct Browser<'a> {
    harness: &'a Harness,
    cookie: String,
}

async fn text(response: Response) -> (StatusCode, String) {
    (response.status(), response.text().await.unwrap())
}

pub(super) fn token(page: &str) -> String {
    let rest = page.split("name=\"form_token\" value=\"").nth(1).unwrap_or_default();
    rest.split('"').next().unwrap_or_default().to_owned()
}

impl Harness {
    async fn with_people(database: TestDatabase) -> Self {
        let mut config = config(&database);
        config.accounts = true;
        config.workers = 0;
        let server = Server::start(config).await.unwrap();
        let client = Client::builder().redirect(Policy::none()).build().unwrap();
        let users = server.archive().store.users();
        let hash = hash_password(PASSWORD).unwrap();
        for (name, role) in [("ann", "engineer"), ("eve", "admin"), ("rob", "reader")] {
            let role = GrantRow {
                scope_kind: "server".into(),
                scope_name: String::new(),
                role: role.into(),
            };
            users.create(name, name, Some(&hash), &[role]).await.unwrap();
        }
        Self { server, client, database }
    }

    /// Returns a form as a page of this server sends it.
    fn form(&self, path: &str, fields: &[(&str, &str)]) -> RequestBuilder {
        let url = reqwest::Url::parse(&self.url(path)).unwrap();
        let body = serde_urlencoded::to_string(fields).unwrap();
        let post = self.client.post(url).header("origin", self.server.url());
        post.header("content-type", "application/x-www-form-urlencoded").body(body)
    }

    async fn signs_in(&self, name: &str, password: &str) -> Response {
        let page =
            self.client.get(self.url("/sign-in")).send().await.unwrap().text().await.unwrap();
        let token = token(&page);
        let fields =
            [("form_token", &*token), ("name", name), ("password", password), ("next", "/zoo")];
        self.form("/sign-in", &fields).send().await.unwrap()
    }

    async fn browser(&self, name: &str) -> Browser<'_> {
        let answer = self.signs_in(name, PASSWORD).await;
        assert_eq!(answer.status(), StatusCode::SEE_OTHER, "{name}");
        assert_eq!(answer.headers()["location"], "/zoo");
        Browser { harness: self, cookie: cookie(&answer) }
    }
}

fn cookie(answer: &Response) -> String {
    let set = answer.headers()["set-cookie"].to_str().unwrap();
    for part in ["HttpOnly", "SameSite=Lax", "Path=/", "Max-Age=43200"] {
        assert!(set.contains(part), "{set}");
    }
    set.split(';').next().unwrap().to_owned()
}

impl Browser<'_> {
    async fn looks(&self, path: &str) -> (StatusCode, String) {
        let get = self.harness.client.get(self.harness.url(path)).header("accept", "text/html");
        text(get.header("cookie", &self.cookie).send().await.unwrap()).await
    }

    /// Sends a form of the page at `from`.
    async fn sends(&self, from: &str, path: &str, fields: &[(&str, &str)]) -> (StatusCode, String) {
        let token = token(&self.looks(from).await.1);
        let mut all = vec![("form_token", &*token)];
        all.extend(fields);
        let form = self.harness.form(path, &all).header("cookie", &self.cookie);
        text(form.send().await.unwrap()).await
    }
}

async fn people_sign_in_and_out(database: TestDatabase) {
    let harness = Harness::with_people(database).await;
    let first = harness.client.get(harness.url("/ships/mariner?a=b")).header("accept", "text/html");
    let first = first.send().await.unwrap();
    assert_eq!(first.status(), StatusCode::SEE_OTHER);
    assert_eq!(first.headers()["location"], "/sign-in?next=%2Fships%2Fmariner%3Fa%3Db");
    for (name, password) in [("ann", "a wrong sentence"), ("nobody", PASSWORD), ("ann", "")] {
        let (status, page) = text(harness.signs_in(name, password).await).await;
        assert!(!status.is_redirection() && !page.contains(PASSWORD), "{name}: {status}");
    }
    let ann = harness.browser("ann").await;
    let (status, page) = ann.looks("/ships/mariner").await;
    assert!(status == StatusCode::OK && page.contains(">ann</a>"), "{page}");
    assert!(!page.contains("href=\"/audit\""), "the navigation is that of an engineer");
    let (status, _) = ann.sends("/ships/mariner", "/ships/mariner/tag", &[("tag", "own")]).await;
    assert_eq!(status, StatusCode::SEE_OTHER);
    assert_eq!(ann.looks("/audit").await.0, StatusCode::FORBIDDEN);
    let rob = harness.browser("rob").await;
    let (status, page) = rob.sends("/ships/mariner", "/ships/mariner/tag", &[("tag", "x")]).await;
    assert!(status == StatusCode::FORBIDDEN && page.contains("the role engineer"), "{page}");
    let eve = harness.browser("eve").await;
    let (status, page) = eve.looks("/audit?actor=ann").await;
    assert_eq!(status, StatusCode::OK);
    assert!(
        page.contains("tagged the ship mariner") && page.contains("began the session"),
        "{page}"
    );
    let (status, _) = ann.sends("/account", "/sign-out", &[]).await;
    assert_eq!(status, StatusCode::SEE_OTHER);
    assert_eq!(ann.looks("/").await.0, StatusCode::SEE_OTHER, "to sign in again");
    harness.server.stop().await;
}

async fn a_session_is_not_used_by_others(database: TestDatabase) {
    let harness = Harness::with_people(database).await;
    let (ann, eve) = (harness.browser("ann").await, harness.browser("eve").await);
    let (own, other) = (ann.looks("/ships/mariner").await.1, eve.looks("/ships/mariner").await.1);
    let (own, other) = (token(&own), token(&other));
    let store = &harness.server.archive().store;
    let tag = |token: &str| {
        harness
            .form("/ships/mariner/tag", &[("form_token", token), ("tag", "x")])
            .header("cookie", &ann.cookie)
    };
    let anonymous = harness.client.get(harness.url("/sign-in")).send().await.unwrap();
    let open = token(&anonymous.text().await.unwrap());
    for wrong in [&other, &open, ""] {
        assert_eq!(tag(wrong).send().await.unwrap().status(), StatusCode::FORBIDDEN);
    }
    let foreign = harness
        .client
        .post(harness.url("/ships/mariner/tag"))
        .header("content-type", "application/x-www-form-urlencoded")
        .header("cookie", &ann.cookie);
    let body = format!("form_token={own}&tag=x");
    let foreign = |origin: &str| {
        let post = foreign.try_clone().unwrap().body(body.clone());
        if origin.is_empty() { post } else { post.header("origin", origin) }
    };
    for origin in ["", "http://evil.example", "null"] {
        let status = foreign(origin).send().await.unwrap().status();
        assert_eq!(status, StatusCode::UNAUTHORIZED, "{origin}");
    }
    let put = harness.client.put(harness.url("/v1/ships/mariner/tags/x"));
    let put = put.header("cookie", &ann.cookie).header("origin", harness.server.url());
    assert_eq!(put.send().await.unwrap().status(), StatusCode::UNAUTHORIZED, "not under /v1");
    assert!(store.ships().list_tags("mariner").await.unwrap().is_empty());
    assert_eq!(tag(&own).send().await.unwrap().status(), StatusCode::SEE_OTHER);
    let signs = [("form_token", &*open), ("name", "ann"), ("password", PASSWORD)];
    let other_site = harness.form("/sign-in", &signs).build().unwrap();
    let mut other_site = other_site.try_clone().unwrap();
    other_site.headers_mut().insert("origin", "http://evil.example".parse().unwrap());
    let status = harness.client.execute(other_site).await.unwrap().status();
    assert_eq!(status, StatusCode::FORBIDDEN, "nobody is signed in by another site");
    harness.server.stop().await;
}

async fn admins_give_and_take_on_pages(database: TestDatabase) {
    let harness = Harness::with_people(database).await;
    let (ann, eve) = (harness.browser("ann").await, harness.browser("eve").await);
    let new = [("name", "joe"), ("roles", "reader engineer@ship:mariner"), ("password", PASSWORD)];
    assert_eq!(eve.sends("/users", "/users", &new).await.0, StatusCode::SEE_OTHER);
    let joe = harness.browser("joe").await;
    let (status, _) = joe.sends("/ships/mariner", "/ships/mariner/tag", &[("tag", "own")]).await;
    assert_eq!(status, StatusCode::SEE_OTHER);
    let (status, page) =
        eve.sends("/users", "/keys", &[("title", "<b>"), ("roles", "reader")]).await;
    assert!(status == StatusCode::OK && page.contains("sis_") && !page.contains("<b>"), "{page}");
    let (_, page) = eve.looks("/users").await;
    assert!(page.contains("engineer@ship:mariner") && page.contains("sis_"), "{page}");
    assert_eq!(eve.sends("/users", "/users/joe/disable", &[]).await.0, StatusCode::SEE_OTHER);
    assert_eq!(joe.looks("/zoo").await.0, StatusCode::SEE_OTHER, "to sign in");
    assert_eq!(harness.signs_in("joe", PASSWORD).await.status(), StatusCode::OK, "in vain");
    let change = [("old", PASSWORD), ("new", NEW)];
    assert_eq!(ann.sends("/account", "/account/password", &change).await.0, StatusCode::SEE_OTHER);
    assert_eq!(ann.looks("/zoo").await.0, StatusCode::SEE_OTHER, "its old session has ended");
    assert_eq!(harness.signs_in("ann", NEW).await.status(), StatusCode::SEE_OTHER);
    let wrong = [("roles", "captain")];
    let (status, page) = eve.sends("/users", "/users/rob/roles", &wrong).await;
    assert!(status == StatusCode::UNPROCESSABLE_ENTITY && page.contains("captain"), "{page}");
    let on = [("second_person", "on")];
    assert_eq!(eve.sends("/users", "/settings", &on).await.0, StatusCode::SEE_OTHER);
    assert!(harness.server.archive().store.settings().requires_second_person().await.unwrap());
    harness.server.stop().await;
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn who_tries_passwords_waits() {
    let harness = Harness::with_people(TestDatabase::new_sqlite()).await;
    // All at once: failed attempts expire while a slow machine hashes one after the other.
    let wrong = (0..12).map(|_| harness.signs_in("ann", "a wrong sentence"));
    for answer in futures::future::join_all(wrong).await {
        assert!(matches!(answer.status().as_u16(), 200 | 429), "{}", answer.status());
    }
    let right = harness.signs_in("ann", PASSWORD).await;
    assert_eq!(right.status(), StatusCode::TOO_MANY_REQUESTS);
    harness.server.stop().await;
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn people_on_sqlite() {
    people_sign_in_and_out(TestDatabase::new_sqlite()).await;
    a_session_is_not_used_by_others(TestDatabase::new_sqlite()).await;
    admins_give_and_take_on_pages(TestDatabase::new_sqlite()).await;
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn people_on_postgres() {
    for journey in 0..3 {
        let Some(database) = TestDatabase::new_postgres().await else { return };
        match journey {
            0 => people_sign_in_and_out(database).await,
            1 => a_session_is_not_used_by_others(database).await,
            _ => admins_give_and_take_on_pages(database).await,
        }
    }
}
