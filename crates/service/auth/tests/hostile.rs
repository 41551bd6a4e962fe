//! Against a provider that lies: what a server must refuse, and what it must take.
#![allow(clippy::unwrap_used)]

use base64::Engine as _;
use base64::prelude::BASE64_URL_SAFE_NO_PAD;
use serde_json::{Value, json};
use sistership_auth::openid::testing::{CLIENT, Hostile, now_s};
use sistership_auth::openid::{
    Answer, Begun, Failure, Finished, OpenIdArguments, Provider, Purpose,
};

/// A server that knows a provider, with further settings.
fn knowing(hostile: &Hostile, change: impl FnOnce(&mut OpenIdArguments)) -> Provider {
    let _ = rustls::crypto::ring::default_provider().install_default();
    // One file a call: the tests of this program run side by side.
    let secret = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(&secret, CLIENT.1).unwrap();
    let mut told = OpenIdArguments {
        issuer: Some(hostile.url.clone()),
        client_id: Some(CLIENT.0.into()),
        client_secret_file: Some(secret.path().into()),
        base_url: Some("http://127.0.0.1:1".into()),
        ..OpenIdArguments::default()
    };
    change(&mut told);
    let settings = told.settings(&OpenIdArguments::default()).unwrap().unwrap();
    Provider::new(settings).unwrap()
}

async fn begun(server: &Provider) -> Begun {
    server.begin(Purpose::SignIn, "/ships", now_s()).await.unwrap()
}

async fn finished(server: &Provider, begun: &Begun, query: &str) -> Result<Finished, Failure> {
    server.finish(Some(&begun.ticket), &Answer::read(query), now_s()).await
}

/// A whole sign-in.
async fn signed_in(server: &Provider, hostile: &Hostile) -> Result<Finished, Failure> {
    let begun = begun(server).await;
    let query = hostile.lets_through(&begun.place);
    finished(server, &begun, &query).await
}

#[tokio::test]
async fn an_honest_answer_is_taken_once() {
    let hostile = Hostile::start().await;
    let server = knowing(&hostile, |_| {});
    let begun = begun(&server).await;
    let query = hostile.lets_through(&begun.place);
    let done = finished(&server, &begun, &query).await.unwrap();
    assert_eq!(
        (done.identity.issuer, done.identity.subject.as_str()),
        (hostile.url.clone(), "7-of-9")
    );
    assert_eq!((done.purpose, done.next.as_str()), (Purpose::SignIn, "/ships"));
    assert_eq!(hostile.told().client_by, "header");
    assert_eq!(finished(&server, &begun, &query).await, Err(Failure::Expired), "the code is used");
    assert_eq!(hostile.told().asked["/keys"], 1);
}

/// Claims and heads that no honest provider sends, and what is said of them.
#[tokio::test]
async fn forged_tokens_are_refused() {
    let hostile = Hostile::start().await;
    let server = knowing(&hostile, |_| {});
    let cases: &[(&str, Value, Value, &str)] = &[
        ("nonce", json!({}), json!({ "nonce": "another" }), "another sign-in"),
        ("no nonce", json!({}), json!({ "nonce": null }), "another sign-in"),
        ("audience", json!({}), json!({ "aud": "other" }), "another server"),
        ("no audience", json!({}), json!({ "aud": null }), "cannot be read"),
        (
            "party",
            json!({}),
            json!({ "aud": ["ships", "other"], "azp": "other" }),
            "another server",
        ),
        ("no party", json!({}), json!({ "aud": ["ships", "other"] }), "another server"),
        ("issuer", json!({}), json!({ "iss": "https://evil.example" }), "another provider"),
        (
            "issuers",
            json!({}),
            json!({ "iss": ["https://evil.example", hostile.url] }),
            "cannot be read",
        ),
        ("no issuer", json!({}), json!({ "iss": null }), "cannot be read"),
        ("expired", json!({}), json!({ "exp": now_s() - 61 }), "expired"),
        ("no end", json!({}), json!({ "exp": null }), "lacks"),
        ("no number", json!({}), json!({ "exp": "never" }), "lacks"),
        ("not yet", json!({}), json!({ "nbf": now_s() + 120 }), "not valid yet"),
        ("nobody", json!({}), json!({ "sub": "" }), "names nobody"),
        ("no subject", json!({}), json!({ "sub": null }), "cannot be read"),
        ("too long", json!({}), json!({ "sub": "a".repeat(256) }), "names nobody"),
        ("unknown key", json!({ "kid": "other" }), json!({}), "does not publish"),
        ("unsigned", json!({ "alg": "none" }), json!({}), "no signed token"),
        ("shared secret", json!({ "alg": "HS256" }), json!({}), "shared secret"),
        ("other algorithm", json!({ "alg": "RS256" }), json!({}), "does not publish"),
        ("critical", json!({ "crit": ["b64"], "b64": false }), json!({}), "not known here"),
    ];
    for (name, head, claims, why) in cases {
        hostile.told().head = head.as_object().unwrap().clone();
        hostile.told().claims = claims.as_object().unwrap().clone();
        match signed_in(&server, &hostile).await {
            Err(Failure::Untrusted(said)) => assert!(said.contains(why), "{name}: {said}"),
            other => panic!("{name}: {other:?}"),
        }
    }
    hostile.told().head.clear();
    hostile.told().claims =
        json!({ "exp": now_s() - 30, "aud": ["ships"] }).as_object().unwrap().clone();
    assert!(signed_in(&server, &hostile).await.is_ok(), "clocks may be a minute apart");
}

/// What is done to a signed token, by name.
type Mangling = (&'static str, fn(String) -> String);

/// Tokens that were changed after they had been signed.
#[tokio::test]
async fn changed_tokens_are_refused() {
    fn parts(token: &str) -> Vec<String> {
        token.split('.').map(str::to_owned).collect()
    }
    let manglings: [Mangling; 6] = [
        ("other claims", |token| {
            let mut parts = parts(&token);
            let claims = BASE64_URL_SAFE_NO_PAD.decode(&parts[1]).unwrap();
            let claims = String::from_utf8(claims).unwrap().replace("7-of-9", "1-of-9");
            parts[1] = BASE64_URL_SAFE_NO_PAD.encode(claims);
            parts.join(".")
        }),
        ("no signature", |token| format!("{}.", token.rsplit_once('.').unwrap().0)),
        ("none, and no signature", |token| {
            let mut parts = parts(&token);
            parts[0] = BASE64_URL_SAFE_NO_PAD.encode(r#"{"alg":"none"}"#);
            format!("{}.{}.", parts[0], parts[1])
        }),
        // The published key as the secret of an HMAC.
        ("confused", |token| {
            let mut parts = parts(&token);
            parts[0] = BASE64_URL_SAFE_NO_PAD.encode(r#"{"alg":"HS256","kid":"first"}"#);
            let key = ring::hmac::Key::new(ring::hmac::HMAC_SHA256, b"published");
            let signed = format!("{}.{}", parts[0], parts[1]);
            let tag = ring::hmac::sign(&key, signed.as_bytes());
            format!("{signed}.{}", BASE64_URL_SAFE_NO_PAD.encode(tag))
        }),
        ("two parts", |token| token.rsplit_once('.').unwrap().0.to_owned()),
        ("nothing", |_| String::new()),
    ];
    let hostile = Hostile::start().await;
    let server = knowing(&hostile, |_| {});
    for (name, mangle) in manglings {
        hostile.told().mangle = mangle;
        let done = signed_in(&server, &hostile).await;
        assert!(matches!(done, Err(Failure::Untrusted(_))), "{name}: {done:?}");
    }
}

#[tokio::test]
async fn new_keys_are_asked_for_and_withdrawn_ones_refused() {
    let hostile = Hostile::start().await;
    let server = knowing(&hostile, |_| {});
    assert!(signed_in(&server, &hostile).await.is_ok());
    hostile.told().add_key("second");
    hostile.told().signs = "second".into();
    let unknown = signed_in(&server, &hostile).await;
    assert!(matches!(unknown, Err(Failure::Untrusted(_))), "{unknown:?}");
    hostile.told().published = vec!["second".into()];
    assert!(signed_in(&server, &hostile).await.is_ok(), "a new key");
    assert!(signed_in(&server, &hostile).await.is_ok());
    assert_eq!(hostile.told().asked["/keys"], 3, "the first, none, the second");
    hostile.told().signs = "first".into();
    let withdrawn = signed_in(&server, &hostile).await;
    assert!(matches!(withdrawn, Err(Failure::Untrusted(_))), "{withdrawn:?}");
}

#[tokio::test]
async fn an_answer_belongs_to_the_browser_that_asked() {
    let hostile = Hostile::start().await;
    let server = knowing(&hostile, |_| {});
    let (own, other) = (begun(&server).await, begun(&server).await);
    let query = hostile.lets_through(&own.place);
    let answer = Answer::read(&query);
    for (ticket, now_s) in [
        (None, now_s()),
        (Some(other.ticket.as_str()), now_s()),
        (Some("damaged"), now_s()),
        (Some(own.ticket.as_str()), now_s() + 601),
    ] {
        assert_eq!(server.finish(ticket, &answer, now_s).await, Err(Failure::Expired));
    }
    for query in ["", "code=a", "code=a&state=b", &format!("{query}&state=b")] {
        assert_eq!(finished(&server, &own, query).await, Err(Failure::Expired), "{query}");
    }
    assert!(!hostile.told().asked.contains_key("/token"), "nothing was asked for any of them");
    // A server with another secret has sealed the ticket.
    let elsewhere = knowing(&hostile, |told| told.client_secret_file = None);
    assert_eq!(elsewhere.finish(Some(&own.ticket), &answer, now_s()).await, Err(Failure::Expired));
    // Somebody else's code under one's own state.
    let mine = hostile.lets_through(&other.place);
    let theirs = query.split('&').next().unwrap();
    let injected = format!("{theirs}&{}", mine.split_once('&').unwrap().1);
    assert_eq!(finished(&server, &other, &injected).await, Err(Failure::Expired), "by PKCE");
    hostile.told().checks_pkce = false;
    let query = hostile.lets_through(&own.place);
    let injected =
        format!("{}&{}", query.split('&').next().unwrap(), mine.split_once('&').unwrap().1);
    let by_nonce = finished(&server, &other, &injected).await;
    assert!(matches!(by_nonce, Err(Failure::Untrusted(why)) if why.contains("another sign-in")));
}

#[tokio::test]
async fn another_provider_cannot_answer() {
    let hostile = Hostile::start().await;
    let server = knowing(&hostile, |_| {});
    let begun = begun(&server).await;
    let query = hostile.lets_through(&begun.place);
    let (without, _) = query.split_once("&iss=").unwrap();
    for query in [without.to_owned(), format!("{without}&iss=https%3A%2F%2Fevil.example")] {
        let done = finished(&server, &begun, &query).await;
        assert!(matches!(done, Err(Failure::Untrusted(_))), "{query}: {done:?}");
    }
    assert!(finished(&server, &begun, &query).await.is_ok());
    for change in [
        json!({ "issuer": "https://evil.example" }),
        json!({ "issuer": format!("{}/", hostile.url) }),
        json!({ "token_endpoint": "http://evil.example/token" }),
        json!({ "jwks_uri": "file:///etc/passwd" }),
        json!({ "authorization_endpoint": "javascript:alert(1)" }),
        json!({ "token_endpoint": null }),
    ] {
        hostile.told().discovery = change.as_object().unwrap().clone();
        let begun = knowing(&hostile, |_| {}).begin(Purpose::SignIn, "/", now_s()).await;
        assert!(matches!(begun, Err(Failure::Provider(_))), "{change}");
    }
}

#[tokio::test]
async fn what_the_provider_says_instead_is_told_apart() {
    let hostile = Hostile::start().await;
    let server = knowing(&hostile, |_| {});
    let begun = begun(&server).await;
    let query = hostile.lets_through(&begun.place);
    let (_, rest) = query.split_once('&').unwrap();
    let says = async |error: &str| {
        finished(&server, &begun, &format!("error={error}&{rest}")).await.unwrap_err()
    };
    assert_eq!(says("access_denied").await, Failure::Denied);
    assert_eq!(says("invalid_scope").await, Failure::Refused("invalid_scope".into()));
    assert!(matches!(says("temporarily_unavailable").await, Failure::Unreachable(_)));
    let written = says("%3Cscript%3E").await.to_string();
    assert!(!written.contains("script>"), "{written}");
    hostile.told().down = true;
    let down = finished(&server, &begun, &query).await;
    assert!(matches!(down, Err(Failure::Unreachable(why)) if why.contains("503")));
}

#[tokio::test]
async fn a_provider_that_is_down_is_asked_again() {
    let hostile = Hostile::start().await;
    let server = knowing(&hostile, |_| {});
    hostile.told().down = true;
    let begun = server.begin(Purpose::SignIn, "/", now_s()).await;
    assert!(matches!(begun, Err(Failure::Unreachable(_))));
    hostile.told().down = false;
    assert!(signed_in(&server, &hostile).await.is_ok());
    let nobody = std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
    let gone = knowing(&hostile, |told| told.issuer = Some(format!("http://{nobody}")));
    let begun = gone.begin(Purpose::SignIn, "/", now_s()).await;
    assert!(matches!(begun, Err(Failure::Unreachable(why)) if why == "no connection"));
    hostile.told().discovery = json!({ "x": "a".repeat(2 << 20) }).as_object().unwrap().clone();
    let begun = knowing(&hostile, |_| {}).begin(Purpose::SignIn, "/", now_s()).await;
    assert!(matches!(begun, Err(Failure::Provider(why)) if why.contains("too long")));
}

#[tokio::test]
async fn the_server_shows_who_it_is_as_the_provider_wants_it() {
    let hostile = Hostile::start().await;
    let by = |hostile: &Hostile| hostile.told().client_by;
    let methods = json!({ "token_endpoint_auth_methods_supported": ["client_secret_post"] });
    hostile.told().discovery = methods.as_object().unwrap().clone();
    assert!(signed_in(&knowing(&hostile, |_| {}), &hostile).await.is_ok());
    assert_eq!(by(&hostile), "body");
    let public = knowing(&hostile, |told| told.client_secret_file = None);
    assert!(signed_in(&public, &hostile).await.is_ok());
    assert_eq!(by(&hostile), "nothing");
    let wrong = knowing(&hostile, |told| told.client_id = Some("ship".into()));
    hostile.told().discovery.clear();
    let begun = begun(&wrong).await;
    let place = begun.place.replace("client_id=ship", "client_id=ships");
    let query = hostile.lets_through(&place);
    let done = finished(&wrong, &begun, &query).await;
    assert_eq!(done, Err(Failure::Refused("invalid_client".into())));
}

#[tokio::test]
async fn what_the_token_lacks_is_asked_for_of_the_same_person() {
    let hostile = Hostile::start().await;
    let by_groups = |told: &mut OpenIdArguments| {
        told.auto_create = true;
        told.group_roles = vec!["yard=engineer".into(), "owners=approver@ship:kcs".into()];
    };
    let server = knowing(&hostile, by_groups);
    hostile.told().described =
        json!({ "sub": "7-of-9", "groups": ["yard", "owners"], "nonce": "x" });
    let identity = signed_in(&server, &hostile).await.unwrap().identity;
    let admission = server.settings().admission();
    let roles: Vec<String> =
        admission.roles(&identity.claims).iter().map(ToString::to_string).collect();
    assert_eq!(roles, ["engineer", "approver@ship:kcs"]);
    assert_eq!(admission.name(&identity.claims), Ok("ann".into()));
    for described in [json!({ "sub": "1-of-9", "groups": ["yard"] }), json!({ "groups": ["yard"] })]
    {
        hostile.told().described = described;
        let done = signed_in(&server, &hostile).await;
        assert!(matches!(done, Err(Failure::Untrusted(why)) if why.contains("somebody else")));
    }
    hostile.told().claims = json!({ "groups": [] }).as_object().unwrap().clone();
    let asked = hostile.told().asked["/userinfo"];
    let identity = signed_in(&server, &hostile).await.unwrap().identity;
    assert!(admission.roles(&identity.claims).is_empty());
    assert_eq!(hostile.told().asked["/userinfo"], asked, "the token says all");
}
