//! Sign-in at a provider of another project.

use reqwest::{Method, StatusCode};
use serde_json::{Value, json};
use sistership_auth::openid::testing::RealProvider;
use sistership_store::testing::TestDatabase;

use super::knowing::{Browser, Knowing, Shown, free, settings};

/// Returns the address to which a form of the provider's page is sent.
fn action(page: &str) -> String {
    let action = page.split("action=\"").nth(1).expect("a form").split('"').next().unwrap();
    action.to_owned()
}

impl Browser {
    /// Follows the provider's redirects to its page or out of it.
    async fn follows(&mut self, on: &Knowing, issuer: &str, mut shown: Shown) -> Shown {
        while shown.status.is_redirection() && !shown.place.starts_with(&on.url) {
            let place = match shown.place.starts_with('/') {
                true => format!("{issuer}{}", shown.place),
                false => shown.place,
            };
            shown = self.asks(&on.client, Method::GET, &place, &[]).await;
        }
        shown
    }

    /// Signs in at the provider under a name, grants the request, and comes back.
    async fn signs_in_really(&mut self, on: &Knowing, issuer: &str, name: &str) -> Shown {
        let gone = self.looks(on, "/sign-in/oidc?next=/jobs").await;
        let mut shown = self.follows(on, issuer, gone).await;
        for form in [
            &[("prompt", "login"), ("login", name), ("password", "any")][..],
            &[("prompt", "consent")],
        ] {
            assert_eq!(shown.status, StatusCode::OK, "{}", shown.text);
            let sent = self.asks(&on.client, Method::POST, &action(&shown.text), form).await;
            shown = self.follows(on, issuer, sent).await;
        }
        assert!(
            shown.place.starts_with(&format!("{}/sign-in/oidc/callback?", on.url)),
            "{}",
            shown.place
        );
        let back = shown.place;
        self.asks(&on.client, Method::GET, &back, &[]).await
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_certified_provider_lets_people_in() {
    let listen = free();
    let url = format!("http://{listen}");
    let Some(provider) = RealProvider::start(&url) else { return };
    let database = TestDatabase::new_sqlite();
    let settings = settings(&url, &provider.issuer, RealProvider::SECRET, |told| {
        told.auto_create = true;
        told.scopes = Some("openid profile email groups".into());
        told.group_roles = vec!["yard=engineer".into()];
    });
    let on = Knowing::start(&database, listen, settings).await.unwrap();
    let mut browser = Browser::default();
    let done = browser.signs_in_really(&on, &provider.issuer, "ann").await;
    assert_eq!(
        (done.status, done.place.as_str()),
        (StatusCode::SEE_OTHER, "/jobs"),
        "{}",
        done.text
    );
    let me = browser.me(&on).await;
    assert_eq!((&me["name"], &me["roles"][0]["role"]), (&json!("ann"), &json!("engineer")), "{me}");
    let ann = on.owner(Method::GET, "/v1/users/ann", &Value::Null).await;
    assert_eq!(ann["title"], "ann of the yard");
    assert_eq!(ann["identities"], json!([{ "issuer": provider.issuer, "subject": "ann" }]));
    let stranger = Browser::default().signs_in_really(&on, &provider.issuer, "eve").await;
    assert!(stranger.text.contains("none of your groups"), "{}", stranger.text);
    on.server.stop().await;
}
