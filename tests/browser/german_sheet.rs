//! A German sheet with spikes: a column is corrected, a range excluded, and the readings are kept as
//! a template, by which the next sheet is read; then a model is refined.

use serde_json::json;
use sistership_store::testing::TestDatabase;
use sistership_tests::server::TestServer;

use crate::driver::Browser;
use crate::{SHIP, create, files, shown};

/// Two clicks into the panel of the yaw rate, the third from the top, at two fifths and half of the
/// plot.
const CLICKS: &str = "const plot = document.querySelector('figure[data-trial] svg');
    const box = plot.getBoundingClientRect();
    for (const share of [0.4, 0.5]) plot.dispatchEvent(new MouseEvent('click', {
        clientX: box.left + share * box.width, clientY: box.top + 240 * box.width / 420 }));
    return ['trial', 'channel', 'from', 'to'].map(
        name => document.getElementById('range_' + name).value);";

async fn choose_files(browser: &Browser, server: &TestServer, files: &[String]) {
    browser.go(&format!("{}/ships/{SHIP}/upload", server.url())).await;
    browser.keys("#files", &files.join("\n")).await;
    browser.leave_by("main form button").await;
    browser.until("Check the upload").await;
}

async fn corrected(browser: &Browser) {
    let page = browser.until("values of psi: spikes").await;
    assert!(page.contains("7 values of psi: spikes"), "{page}");
    let chosen =
        "document.querySelector(\"select[aria-label='Channel of Kanal 7']\").value = 'depth'";
    browser.run(chosen).await;
    browser.fill("input[aria-label='Unit of Kanal 7']", "m").await;
    browser.leave_by("button[value='look']").await;
    let page = browser.until("given on this page").await;
    assert!(page.contains("All files can be read") && page.contains("over 99 %"), "{page}");
    shown(browser, "upload-sheet").await;
}

async fn excluded(browser: &Browser) {
    let fields = browser.run(CLICKS).await;
    assert_eq!((&fields[0], &fields[1]), (&json!("0"), &json!("r")));
    let time = |at: usize| fields[at].as_str().unwrap().parse::<f64>().unwrap();
    assert!(time(2) > 150.0 && time(3) > time(2) + 50.0 && time(3) < 400.0, "{fields}");
    browser.leave_by("button[value='exclude']").await;
    let page = browser.until("values of r: excluded on the upload page").await;
    assert!(page.contains("values of psi: spikes"), "{page}");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_german_sheet_is_corrected_once_and_read_by_its_template() {
    let Some(browser) = Browser::start().await else { return };
    let server = TestServer::on(TestDatabase::new_sqlite(), &[]).await;
    create(&browser, &server).await;
    let folder = tempfile::tempdir().unwrap();
    let sheets = files::german(folder.path());
    choose_files(&browser, &server, &sheets[..2]).await;
    corrected(&browser).await;
    excluded(&browser).await;
    browser.fill("#template_name", "werft").await;
    browser.leave_by("button[value='save-template']").await;
    browser.until("are read by the template werft").await;
    browser.leave_by("button[value='keep']").await;
    browser.until("2 trials are stored").await;

    choose_files(&browser, &server, &sheets[2..]).await;
    browser.until("has the same columns as the template werft").await;
    browser.leave_by("form.banner button").await;
    browser.until("are read by the template werft").await;
    let depth = "return document.querySelector(\"select[aria-label='Channel of Kanal 7']\").value";
    assert_eq!(browser.run(depth).await, json!("depth"));
    browser.leave_by("button[value='keep']").await;
    browser.until("1 trial is stored").await;
    shown(&browser, "upload-stored").await;
    browser.leave_by("main form button").await;
    browser.until("Refinement of").await;
    browser.until("succeeded").await;
}
