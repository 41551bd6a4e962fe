//! Against a provider that lies: what a server must refuse, and what it must take.
#![allow(clippy::unwrap_used)]

use base64::Engine as _;
use base64::prelude::BASE64_URL_SAFE_NO_PAD;
use serde_json::{Value, json};
use sistership_auth::openid::testing::{CLIENT, ScriptedProvider, now_s};
use sistership_auth::openid::{
    CallbackQuery, OpenIdArguments, OpenIdProvider, SignInFailure, SignInPurpose, SignInResult,
    SignInStart,
};

/// A server that knows a provider, with further settings.
fn knowing(
    hostile: &ScriptedProvider,
    change: impl FnOnce(&mut OpenIdArguments),
) -> OpenIdProvider {
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
    let settings = told.resolve_settings(&OpenIdArguments::default()).unwrap().unwrap();
    OpenIdProvider::new(settings).unwrap()
}

async fn begun(server: &OpenIdProvider) -> SignInStart {
    server.begin_sign_in(SignInPurpose::SignIn, "/ships", now_s()).await.unwrap()
}

async fn finished(
    server: &OpenIdProvider,
    begun: &SignInStart,
    query: &str,
) -> Result<SignInResult, SignInFailure> {
    server.finish_sign_in(Some(&begun.ticket), &CallbackQuery::read(query), now_s()).await
}

/// A whole sign-in.
async fn signed_in(
    server: &OpenIdProvider,
    hostile: &ScriptedProvider,
) -> Result<SignInResult, SignInFailure> {
    let begun = begun(server).await;
    let query = hostile.accept_person(&begun.place);
    finished(server, &begun, &query).await
}

#[tokio::test]
async fn an_honest_answer_is_taken_once() {
    let hostile = ScriptedProvider::start().await;
    let server = knowing(&hostile, |_| {});
    let begun = begun(&server).await;
    let query = hostile.accept_person(&begun.place);
    let done = finished(&server, &begun, &query).await.unwrap();
    assert_eq!(
        (done.identity.issuer, done.identity.subject.as_str()),
        (hostile.url.clone(), "7-of-9")
    );
    assert_eq!((done.purpose, done.next.as_str()), (SignInPurpose::SignIn, "/ships"));
    assert_eq!(hostile.lock_script().client_by, "header");
    assert_eq!(
        finished(&server, &begun, &query).await,
        Err(SignInFailure::Expired),
        "the code is used"
    );
    assert_eq!(hostile.lock_script().asked["/keys"], 1);
}

/// Claims and heads that no honest provider sends, and what is said of them.
#[tokio::test]
async fn forged_tokens_are_refused() {
    let hostile = ScriptedProvider::start().await;
    let server = knowing(&hostile, |_| {});
    let cases: &[(&str, Value, Value, &str)] = &[
        ("nonce", json!({}), json!({ "nonce": "another" }), "another sign-in"),
        ("no nonce", json!({}), json!({ "nonce": null }), "another sign-in"),
        ("audience", json!({}), json!({ "aud": "other" }), "another server"),
        ("no audience", json!({}), json!({ "aud": null }), "cannot be parsed"),
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
            "cannot be parsed",
        ),
        ("no issuer", json!({}), json!({ "iss": null }), "cannot be parsed"),
        ("expired", json!({}), json!({ "exp": now_s() - 61 }), "expired"),
        ("no end", json!({}), json!({ "exp": null }), "lacks"),
        ("no number", json!({}), json!({ "exp": "never" }), "lacks"),
        ("not yet", json!({}), json!({ "nbf": now_s() + 120 }), "not valid yet"),
        ("nobody", json!({}), json!({ "sub": "" }), "has no subject"),
        ("no subject", json!({}), json!({ "sub": null }), "cannot be parsed"),
        ("too long", json!({}), json!({ "sub": "a".repeat(256) }), "has no subject"),
        ("unknown key", json!({ "kid": "other" }), json!({}), "does not publish"),
        ("unsigned", json!({ "alg": "none" }), json!({}), "not a signed token"),
        ("shared secret", json!({ "alg": "HS256" }), json!({}), "shared secret"),
        ("other algorithm", json!({ "alg": "RS256" }), json!({}), "does not publish"),
        ("critical", json!({ "crit": ["b64"], "b64": false }), json!({}), "not supported"),
    ];
    for (name, head, claims, why) in cases {
        hostile.lock_script().head = head.as_object().unwrap().clone();
        hostile.lock_script().claims = claims.as_object().unwrap().clone();
        match signed_in(&server, &hostile).await {
            Err(SignInFailure::Untrusted(said)) => assert!(said.contains(why), "{name}: {said}"),
            other => panic!("{name}: {other:?}"),
        }
    }
    hostile.lock_script().head.clear();
    hostile.lock_script().claims =
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
    let hostile = ScriptedProvider::start().await;
    let server = knowing(&hostile, |_| {});
    for (name, mangle) in manglings {
        hostile.lock_script().mangle = mangle;
        let done = signed_in(&server, &hostile).await;
        assert!(matches!(done, Err(SignInFailure::Untrusted(_))), "{name}: {done:?}");
    }
}

#[tokio::test]
async fn new_keys_are_asked_for_and_withdrawn_ones_refused() {
    let hostile = ScriptedProvider::start().await;
    let server = knowing(&hostile, |_| {});
    assert!(signed_in(&server, &hostile).await.is_ok());
    hostile.lock_script().add_key("second");
    hostile.lock_script().signs = "second".into();
    let unknown = signed_in(&server, &hostile).await;
    assert!(matches!(unknown, Err(SignInFailure::Untrusted(_))), "{unknown:?}");
    hostile.lock_script().published = vec!["second".into()];
    assert!(signed_in(&server, &hostile).await.is_ok(), "a new key");
    assert!(signed_in(&server, &hostile).await.is_ok());
    assert_eq!(hostile.lock_script().asked["/keys"], 3, "the first, none, the second");
    hostile.lock_script().signs = "first".into();
    let withdrawn = signed_in(&server, &hostile).await;
    assert!(matches!(withdrawn, Err(SignInFailure::Untrusted(_))), "{withdrawn:?}");
}

#[tokio::test]
async fn an_answer_belongs_to_the_browser_that_asked() {
    let hostile = ScriptedProvider::start().await;
    let server = knowing(&hostile, |_| {});
    let (own, other) = (begun(&server).await, begun(&server).await);
    let query = hostile.accept_person(&own.place);
    let answer = CallbackQuery::read(&query);
    for (ticket, now_s) in [
        (None, now_s()),
        (Some(other.ticket.as_str()), now_s()),
        (Some("damaged"), now_s()),
        (Some(own.ticket.as_str()), now_s() + 601),
    ] {
        assert_eq!(
            server.finish_sign_in(ticket, &answer, now_s).await,
            Err(SignInFailure::Expired)
        );
    }
    for query in ["", "code=a", "code=a&state=b", &format!("{query}&state=b")] {
        assert_eq!(finished(&server, &own, query).await, Err(SignInFailure::Expired), "{query}");
    }
    assert!(
        !hostile.lock_script().asked.contains_key("/token"),
        "nothing was asked for any of them"
    );
    // A server with another secret has sealed the ticket.
    let elsewhere = knowing(&hostile, |told| told.client_secret_file = None);
    assert_eq!(
        elsewhere.finish_sign_in(Some(&own.ticket), &answer, now_s()).await,
        Err(SignInFailure::Expired)
    );
    // Somebody else's code under one's own state.
    let mine = hostile.accept_person(&other.place);
    let theirs = query.split('&').next().unwrap();
    let injected = format!("{theirs}&{}", mine.split_once('&').unwrap().1);
    assert_eq!(finished(&server, &other, &injected).await, Err(SignInFailure::Expired), "by PKCE");
    hostile.lock_script().checks_pkce = false;
    let query = hostile.accept_person(&own.place);
    let injected =
        format!("{}&{}", query.split('&').next().unwrap(), mine.split_once('&').unwrap().1);
    let by_nonce = finished(&server, &other, &injected).await;
    assert!(
        matches!(by_nonce, Err(SignInFailure::Untrusted(why)) if why.contains("another sign-in"))
    );
}

#[tokio::test]
async fn another_provider_cannot_answer() {
    let hostile = ScriptedProvider::start().await;
    let server = knowing(&hostile, |_| {});
    let begun = begun(&server).await;
    let query = hostile.accept_person(&begun.place);
    let (without, _) = query.split_once("&iss=").unwrap();
    for query in [without.to_owned(), format!("{without}&iss=https%3A%2F%2Fevil.example")] {
        let done = finished(&server, &begun, &query).await;
        assert!(matches!(done, Err(SignInFailure::Untrusted(_))), "{query}: {done:?}");
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
        hostile.lock_script().discovery = change.as_object().unwrap().clone();
        let begun =
            knowing(&hostile, |_| {}).begin_sign_in(SignInPurpose::SignIn, "/", now_s()).await;
        assert!(matches!(begun, Err(SignInFailure::Provider(_))), "{change}");
    }
}

#[tokio::test]
async fn what_the_provider_says_instead_is_told_apart() {
    let hostile = ScriptedProvider::start().await;
    let server = knowing(&hostile, |_| {});
    let begun = begun(&server).await;
    let query = hostile.accept_person(&begun.place);
    let (_, rest) = query.split_once('&').unwrap();
    let says = async |error: &str| {
        finished(&server, &begun, &format!("error={error}&{rest}")).await.unwrap_err()
    };
    assert_eq!(says("access_denied").await, SignInFailure::Denied);
    assert_eq!(says("invalid_scope").await, SignInFailure::Refused("invalid_scope".into()));
    assert!(matches!(says("temporarily_unavailable").await, SignInFailure::Unreachable(_)));
    let written = says("%3Cscript%3E").await.to_string();
    assert!(!written.contains("script>"), "{written}");
    hostile.lock_script().down = true;
    let down = finished(&server, &begun, &query).await;
    assert!(matches!(down, Err(SignInFailure::Unreachable(why)) if why.contains("503")));
}

#[tokio::test]
async fn a_provider_that_is_down_is_asked_again() {
    let hostile = ScriptedProvider::start().await;
    let server = knowing(&hostile, |_| {});
    hostile.lock_script().down = true;
    let begun = server.begin_sign_in(SignInPurpose::SignIn, "/", now_s()).await;
    assert!(matches!(begun, Err(SignInFailure::Unreachable(_))));
    hostile.lock_script().down = false;
    assert!(signed_in(&server, &hostile).await.is_ok());
    let nobody = std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
    let gone = knowing(&hostile, |told| told.issuer = Some(format!("http://{nobody}")));
    let begun = gone.begin_sign_in(SignInPurpose::SignIn, "/", now_s()).await;
    assert!(matches!(begun, Err(SignInFailure::Unreachable(why)) if why == "no connection"));
    hostile.lock_script().discovery =
        json!({ "x": "a".repeat(2 << 20) }).as_object().unwrap().clone();
    let begun = knowing(&hostile, |_| {}).begin_sign_in(SignInPurpose::SignIn, "/", now_s()).await;
    assert!(matches!(begun, Err(SignInFailure::Provider(why)) if why.contains("too long")));
}

#[tokio::test]
async fn the_server_shows_who_it_is_as_the_provider_wants_it() {
    let hostile = ScriptedProvider::start().await;
    let by = |hostile: &ScriptedProvider| hostile.lock_script().client_by;
    let methods = json!({ "token_endpoint_auth_methods_supported": ["client_secret_post"] });
    hostile.lock_script().discovery = methods.as_object().unwrap().clone();
    assert!(signed_in(&knowing(&hostile, |_| {}), &hostile).await.is_ok());
    assert_eq!(by(&hostile), "body");
    let public = knowing(&hostile, |told| told.client_secret_file = None);
    assert!(signed_in(&public, &hostile).await.is_ok());
    assert_eq!(by(&hostile), "nothing");
    let wrong = knowing(&hostile, |told| told.client_id = Some("ship".into()));
    hostile.lock_script().discovery.clear();
    let begun = begun(&wrong).await;
    let place = begun.place.replace("client_id=ship", "client_id=ships");
    let query = hostile.accept_person(&place);
    let done = finished(&wrong, &begun, &query).await;
    assert_eq!(done, Err(SignInFailure::Refused("invalid_client".into())));
}

#[tokio::test]
async fn what_the_token_lacks_is_asked_for_of_the_same_person() {
    let hostile = ScriptedProvider::start().await;
    let by_groups = |told: &mut OpenIdArguments| {
        told.auto_create = true;
        told.group_roles = vec!["yard=engineer".into(), "owners=approver@ship:kcs".into()];
    };
    let server = knowing(&hostile, by_groups);
    hostile.lock_script().described =
        json!({ "sub": "7-of-9", "groups": ["yard", "owners"], "nonce": "x" });
    let identity = signed_in(&server, &hostile).await.unwrap().identity;
    let admission = server.settings().admission_rules();
    let roles: Vec<String> =
        admission.granted_roles(&identity.claims).iter().map(ToString::to_string).collect();
    assert_eq!(roles, ["engineer", "approver@ship:kcs"]);
    assert_eq!(admission.account_name(&identity.claims), Ok("ann".into()));
    for described in [json!({ "sub": "1-of-9", "groups": ["yard"] }), json!({ "groups": ["yard"] })]
    {
        hostile.lock_script().described = described;
        let done = signed_in(&server, &hostile).await;
        assert!(matches!(done, Err(SignInFailure::Untrusted(why)) if why.contains("another user")));
    }
    hostile.lock_script().claims = json!({ "groups": [] }).as_object().unwrap().clone();
    let asked = hostile.lock_script().asked["/userinfo"];
    let identity = signed_in(&server, &hostile).await.unwrap().identity;
    assert!(admission.granted_roles(&identity.claims).is_empty());
    assert_eq!(hostile.lock_script().asked["/userinfo"], asked, "the token says all");
}
