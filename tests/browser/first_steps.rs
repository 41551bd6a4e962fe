//! An empty server leads from one step to the next, and lists are compared by check boxes.

use sistership_store::testing::TestDatabase;
use sistership_tests::server::TestServer;

use crate::driver::Browser;
use crate::files;

#[tokio::test(flavor = "multi_thread")]
async fn primary_buttons_lead_from_an_empty_server_to_a_refined_model() {
    let Some(browser) = Browser::start().await else { return };
    let server = TestServer::on(TestDatabase::new_sqlite(), &[]).await;
    browser.go(server.url()).await;
    let empty = browser.until("Add your ship").await;
    assert!(!empty.contains("kvlcc2"), "published ships are in the library: {empty}");
    browser.accessible("first-steps").await;
    browser.leave_by(".step.next a.button").await;
    browser.click("main form details > summary").await;
    for (field, text) in files::PARTICULARS {
        browser.fill(&format!("#{field}"), text).await;
    }
    for (field, text) in [
        ("name", "own"),
        ("title", "A first ship"),
        ("category", "dry-cargo"),
        ("citation", "Typed in by a person"),
    ] {
        browser.fill(&format!("#{field}"), text).await;
    }
    browser.leave_by("main form button").await;
    browser.until("The ship has no trials yet").await;
    browser.leave_by(".next-step a.button").await;
    assert_eq!(browser.path().await, "/ships/own/upload");
}

#[tokio::test(flavor = "multi_thread")]
async fn marked_ships_are_compared() {
    let Some(browser) = Browser::start().await else { return };
    let server = TestServer::on(TestDatabase::new_sqlite(), &[]).await;
    let library = format!("{}/?ships=library", server.url());
    // The index is made within seconds after the start.
    for _ in 0..100 {
        browser.go(&library).await;
        if browser.text().await.contains("sr108") {
            break;
        }
        tokio::time::sleep(std::time::Duration::from_millis(300)).await;
    }
    browser.looked_at("library").await;
    for ship in ["mariner", "sr108"] {
        browser.click(&format!("input[name='v'][value='{ship}']")).await;
    }
    browser.leave_by("form[action='/compare'] button").await;
    let both = browser.until("tactical diameter").await;
    assert!(both.contains("mariner/") && both.contains("sr108/"), "{both}");
    assert_eq!(browser.path().await, "/compare?v=mariner&v=sr108");
    let charts = browser.run("return document.querySelectorAll('.chart-tools').length").await;
    assert_eq!(charts.as_i64(), Some(2), "turning circles and zigzags");
}

#[tokio::test(flavor = "multi_thread")]
async fn the_keyboard_alone_loads_the_example_and_states_its_conditions() {
    let Some(browser) = Browser::start().await else { return };
    let server = TestServer::on(TestDatabase::new_sqlite(), &[]).await;
    browser.go(server.url()).await;
    browser.tab_to("form[action='/example'] button").await;
    browser.press("\u{e007}").await;
    browser.until("no model that is fitted to them").await;
    assert_eq!(browser.path().await, "/ships/northern-star");
    browser.accessible("example").await;
    browser.tab_to("a[href$='/conditions']").await;
    browser.press("\u{e007}").await;
    browser.until("Conditions of the trials").await;
    browser.looked_at("conditions").await;
    browser.accessible("conditions").await;
    browser.tab_to("#place").await;
    browser.press("Skagerrak").await;
    browser.tab_to("main form button").await;
    browser.press("\u{e007}").await;
    browser.until("Similar ships").await;
    browser.go(&format!("{}/ships/northern-star/conditions", server.url())).await;
    let place = browser.run("return document.querySelector('#place').value").await;
    assert_eq!(place, "Skagerrak");
    for (path, name) in [
        ("/ships/mariner/versions/1/acceptance", "acceptance"),
        ("/webhooks", "webhooks"),
        ("/new-ship", "new-ship"),
    ] {
        browser.go(&format!("{}{path}", server.url())).await;
        browser.looked_at(name).await;
        browser.accessible(name).await;
    }
}
