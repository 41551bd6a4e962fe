//! A person's journey in a real browser: signed in, a ship is typed in, odd files are uploaded with
//! a corrected mapping, a model is refined and compared with its source, a second person promotes
//! it, a hidden current shows that it does not hold, and it is rolled back.
#![allow(clippy::unwrap_used)]

mod charts;
mod driver;
mod files;
mod first_steps;
mod german_sheet;

use std::net::TcpListener;

use driver::Browser;
use serde_json::Value;
use sistership_auth::openid::testing::RealProvider;
use sistership_store::testing::TestDatabase;
use sistership_tests::binary;
use sistership_tests::server::TestServer;

const SHIP: &str = "browsed";

/// What a command says that is run on the server's store.
fn told(server: &TestServer, words: &[&str]) -> Value {
    let store = server.store_arguments();
    let store: Vec<&str> = store.iter().map(String::as_str).collect();
    binary::json(&[words, &store, &["--json"]].concat(), 0)
}

/// A user of the server with a role, and the password drawn for it.
fn user(server: &TestServer, name: &str, role: &str) -> String {
    let added = told(server, &["users", "add", name, "--role", role]);
    added["password"].as_str().unwrap().to_owned()
}

async fn sign_in(browser: &Browser, server: &TestServer, name: &str, password: &str) {
    browser.go(&format!("{}/sign-in", server.url())).await;
    browser.fill("#name", name).await;
    browser.fill("#password", password).await;
    browser.leave_by("main form button").await;
    browser.until("Your fleet").await;
}

async fn shown(browser: &Browser, name: &str) {
    browser.looked_at(name).await;
    browser.accessible(name).await;
}

async fn create(browser: &Browser, server: &TestServer) {
    browser.go(&format!("{}/new-ship", server.url())).await;
    shown(browser, "new-ship").await;
    browser.click("main form details > summary").await;
    for (field, text) in files::PARTICULARS {
        browser.fill(&format!("#{field}"), text).await;
    }
    for (field, text) in [
        ("name", SHIP),
        ("title", "A ship in a browser"),
        ("category", "dry-cargo"),
        ("citation", "Typed in by a person"),
    ] {
        browser.fill(&format!("#{field}"), text).await;
    }
    browser.leave_by("main form button").await;
    browser.until("A ship in a browser").await;
    assert_eq!(browser.path().await, format!("/ships/{SHIP}"));
}

/// Uploads files, corrects what the heading's column is taken for, and stores the trials.
async fn upload(browser: &Browser, server: &TestServer, files: &[String], name: &str) {
    browser.go(&format!("{}/ships/{SHIP}/upload", server.url())).await;
    browser.keys("#files", &files.join("\n")).await;
    browser.leave_by("main form button").await;
    browser.until("Check the upload").await;
    shown(browser, name).await;
    // The compass stands in degrees under a name that says nothing.
    let column = "select[aria-label='Channel of kompass']";
    let chosen = format!(
        "const list = document.querySelector(\"{column}\");
        list.value = 'psi'; document.querySelector(\"input[aria-label='Unit of kompass']\").value = 'deg';
        document.querySelectorAll(\"input[name^='derive_']\").forEach(box => box.checked = false);"
    );
    browser.run(&chosen).await;
    browser.leave_by("button[value='look']").await;
    browser.until("All files can be read").await;
    browser.leave_by("button[value='keep']").await;
    browser.until("stored").await;
}

/// Opens the ship's page with its menu of actions.
async fn open_actions(browser: &Browser, server: &TestServer) {
    browser.go(&format!("{}/ships/{SHIP}", server.url())).await;
    browser.click("#actions > summary").await;
}

async fn refined(browser: &Browser, server: &TestServer) {
    open_actions(browser, server).await;
    browser.fill("#source", "mariner").await;
    browser.choose("#method", "weak").await;
    browser.leave_by(&format!("form[action='/ships/{SHIP}/refine'] button")).await;
    let under_way = browser.until("Refinement of").await;
    assert!(browser.path().await.starts_with("/jobs/"), "{under_way}");
    // Progress moves without the page being loaded anew.
    browser.until("succeeded").await;
    shown(browser, "job").await;
    browser.go(&format!("{}{}", server.url(), browser.path().await)).await;
    browser.leave_by("main a[href*='/v1/reports/']").await;
    browser.until("Errors before and after").await;
    shown(browser, "report").await;
}

async fn compared(browser: &Browser, server: &TestServer) {
    browser.go(&format!("{}/compare?v={SHIP}/1&v=mariner/1", server.url())).await;
    let text = browser.until("mariner/1").await;
    assert!(text.contains("tactical diameter"), "{text}");
    shown(browser, "compare").await;
    browser.go(&format!("{}/ships/{SHIP}/versions/1", server.url())).await;
    browser.until("Lineage").await;
    shown(browser, "version").await;
    browser.leave_by("main a[href*='/validation']").await;
    browser.until("There are no data to validate this model").await;
    browser.go(&format!("{}/ships/kcs/versions/1", server.url())).await;
    browser.leave_by("main a[href*='/validation']").await;
    browser.until("ITTC 7.5-02-06-03").await;
    shown(browser, "validation").await;
}

/// Makes a version champion on the ship's page.
async fn promote(browser: &Browser, server: &TestServer, reason: &str) -> String {
    open_actions(browser, server).await;
    browser.fill("#reason", reason).await;
    browser.leave_by(&format!("form[action='/ships/{SHIP}/champion'] button")).await;
    browser.text().await
}

#[tokio::test(flavor = "multi_thread")]
async fn a_person_refines_and_another_promotes_in_a_browser() {
    let Some(browser) = Browser::start().await else { return };
    let server = TestServer::on(TestDatabase::new_sqlite(), &["--accounts"]).await;
    let [ann, bob, root] = [("ann", "engineer"), ("bob", "approver"), ("root", "admin")]
        .map(|(name, role)| user(&server, name, role));
    sign_in(&browser, &server, "root", &root).await;
    browser.go(&format!("{}/users", server.url())).await;
    shown(&browser, "users").await;
    browser.go(&format!("{}/audit", server.url())).await;
    shown(&browser, "audit").await;
    browser.go(&format!("{}/users", server.url())).await;
    browser.leave_by("form[action='/settings'] button").await;

    sign_in(&browser, &server, "ann", &ann).await;
    shown(&browser, "fleet").await;
    create(&browser, &server).await;
    let folder = tempfile::tempdir().unwrap();
    upload(&browser, &server, &files::calm(folder.path()), "upload").await;
    refined(&browser, &server).await;
    compared(&browser, &server).await;

    // Who made it does not promote it; another person does.
    let refused = promote(&browser, &server, "I like it").await;
    assert!(refused.contains("another person") || refused.contains("approver"), "{refused}");
    sign_in(&browser, &server, "bob", &bob).await;
    let promoted = promote(&browser, &server, "looked over").await;
    assert!(promoted.contains("A ship in a browser"), "{promoted}");
    shown(&browser, "ship").await;

    // A note that others see, with its author.
    browser.click("#actions > summary").await;
    browser.fill("#text", "bow thruster out of order").await;
    browser.leave_by(&format!("form[action='/ships/{SHIP}/note'] button")).await;
    let noted = browser.until("bow thruster out of order").await;
    assert!(noted.contains("bob"), "{noted}");

    // A trial with a current that nobody has said.
    sign_in(&browser, &server, "ann", &ann).await;
    upload(&browser, &server, &files::in_a_current(folder.path()), "upload-current").await;
    browser.leave_by("main a[href^='/jobs/']").await;
    browser.until("Diagnosis of").await;
    browser.until("succeeded").await;
    browser.go(&format!("{}/ships/{SHIP}", server.url())).await;
    let ship = browser.until("does not hold").await;
    assert!(ship.contains("current"), "{ship}");
    shown(&browser, "ship-does-not-hold").await;
    browser.leave_by("main a[href^='/trials/']").await;
    browser.until("Errors of the champion").await;
    shown(&browser, "trial").await;

    // Its model with the current is promoted by mistake, and rolled back.
    sign_in(&browser, &server, "bob", &bob).await;
    open_actions(&browser, &server).await;
    browser.choose("#promoted", "2").await;
    browser.fill("#reason", "by mistake").await;
    browser.leave_by(&format!("form[action='/ships/{SHIP}/champion'] button")).await;
    browser.until("More actions").await;
    browser.click("#actions > summary").await;
    browser.leave_by(&format!("form[action='/ships/{SHIP}/champion'] button.quiet")).await;
    browser.until("does not hold").await;
    told(&server, &["family", "create", "sisters", "--foundation", "mariner/1", "--ship", SHIP]);
    let summary = format!("/ships/{SHIP}/versions/1/acceptance");
    let particulars = format!("/ships/{SHIP}/particulars");
    let pages = [
        ("/jobs", "jobs"),
        ("/zoo", "zoo"),
        ("/zoo/laws/mmg", "law"),
        ("/zoo/effects/wind", "effect"),
        ("/families", "families"),
        ("/families/sisters", "family"),
        (summary.as_str(), "acceptance"),
        (particulars.as_str(), "particulars"),
    ];
    for (path, name) in pages {
        browser.go(&format!("{}{path}", server.url())).await;
        shown(&browser, name).await;
    }
    browser.go(&format!("{}/playground?model={SHIP}", server.url())).await;
    browser.until("Tactical diameter").await;
    shown(&browser, "playground").await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_person_signs_in_at_a_provider_in_a_browser() {
    let listen = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().to_string();
    let url = format!("http://{listen}");
    let Some(provider) = RealProvider::start(&url) else { return };
    let Some(browser) = Browser::start().await else { return };
    let folder = tempfile::tempdir().unwrap();
    let secret = folder.path().join("secret");
    std::fs::write(&secret, RealProvider::SECRET).unwrap();
    let (issuer, secret) = (provider.issuer.as_str(), secret.to_str().unwrap());
    let flags =
        ["--accounts", "--listen", &listen, "--oidc-client-id", "ships", "--oidc-base-url", &url]
            .into_iter()
            .chain(["--oidc-issuer", issuer, "--oidc-client-secret-file", secret])
            .chain([
                "--oidc-title",
                "the yard",
                "--oidc-auto-create",
                "--oidc-default-role",
                "reader",
            ]);
    let flags: Vec<&str> = flags.collect();
    let (server, log) = TestServer::logged(TestDatabase::new_sqlite(), &flags).await;
    browser.go(&format!("{}/jobs", server.url())).await;
    shown(&browser, "sign-in").await;
    browser.leave_by("main a.button").await;
    browser.fill("input[name='login']", "carl").await;
    browser.fill("input[name='password']", "any").await;
    browser.leave_by("button[type='submit']").await;
    browser.leave_by("button[type='submit']").await;
    browser.until("carl").await;
    assert_eq!(browser.path().await, "/jobs", "where carl wanted to go");
    browser.go(&format!("{}/account", server.url())).await;
    browser.until("Link with the yard").await;
    shown(&browser, "account").await;
    let log = std::fs::read_to_string(log).unwrap();
    assert!(log.contains("/sign-in/oidc/callback"), "{log}");
    for kept in [RealProvider::SECRET, "code=", "state=", "eyJ"] {
        assert!(!log.contains(kept), "the log holds {kept}");
    }
}
