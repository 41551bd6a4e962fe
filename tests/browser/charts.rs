//! Charts answer the pointer, the slider and the keyboard: a turning circle of the playground.

use sistership_store::testing::TestDatabase;
use sistership_tests::server::TestServer;

use crate::driver::Browser;

/// The number that a script returns.
async fn number(browser: &Browser, script: &str) -> f64 {
    browser.run(script).await.as_f64().unwrap_or(f64::NAN)
}

/// The value of a quantity that the chart shows at its cursor.
async fn value_at_cursor(browser: &Browser, quantity: &str) -> f64 {
    let cell = format!("document.querySelector(\"td[data-value='{quantity}']\").textContent");
    number(browser, &format!("return Number({cell})")).await
}

async fn time_at_cursor(browser: &Browser) -> f64 {
    number(browser, "return Number(document.querySelector('.chart-tools input').value)").await
}

/// Width of the range of times that a panel shows, as a share of all.
async fn shown_share(browser: &Browser, panel: &str) -> f64 {
    let script = "const box = document.querySelector(\"PANEL\");
        return box.viewBox.baseVal.width / Number(box.getAttribute('width'))";
    number(browser, &script.replace("PANEL", panel)).await
}

#[tokio::test(flavor = "multi_thread")]
async fn a_chart_answers_pointer_slider_and_zoom() {
    let Some(browser) = Browser::start().await else { return };
    let server = TestServer::on(TestDatabase::new_sqlite(), &[]).await;
    browser.go(&format!("{}/playground?model=mariner&rudder=20", server.url())).await;
    browser.until("Tactical diameter").await;

    // In the middle of the panel of the yaw rate the ship turns steadily: r = u / R.
    let (yaw, ground) = ("svg[data-quantity='r']", "svg[data-quantity='ground']");
    browser.point(yaw, &[(0.4, 0.5), (0.5, 0.5)], false).await;
    let (t_s, r_deg_s) = (time_at_cursor(&browser).await, value_at_cursor(&browser, "r").await);
    let whole = number(&browser, "return Number(document.querySelector('.chart-tools input').max)");
    let whole = whole.await;
    assert!((t_s / whole - 0.5).abs() < 0.01, "{t_s} of {whole}");
    assert!((0.5..0.7).contains(&r_deg_s), "{r_deg_s} deg/s");
    let spots = "return document.querySelectorAll('.spot').length";
    assert!(number(&browser, spots).await >= 6.0, "track and channels have the same cursor");

    // The slider moves the outline along the track.
    let outline = "return document.querySelector('.here').getAttribute('d')";
    let before = browser.run(outline).await;
    browser.keys(".chart-tools input", "\u{e010}").await;
    assert!((value_at_cursor(&browser, "delta").await - 20.0).abs() < 0.1);
    assert!((time_at_cursor(&browser).await - whole).abs() < 1e-6);
    assert_ne!(browser.run(outline).await, before, "the End key moves the ship");

    // The pointer on the track finds the time, and a drag zooms into a quarter of it.
    browser.point(ground, &[(0.4, 0.5), (0.5, 0.98)], false).await;
    assert!(time_at_cursor(&browser).await < whole, "a place on the track is a time");
    browser.point(yaw, &[(0.25, 0.5), (0.4, 0.5), (0.5, 0.5)], true).await;
    let share = shown_share(&browser, yaw).await;
    assert!((share - 0.25).abs() < 0.02, "{share}");
    assert!((shown_share(&browser, "svg[data-quantity='u']").await - share).abs() < 1e-9);
    browser.run("[...document.querySelectorAll('.chart-tools button')].find((one) => one.textContent === 'Reset').click()").await;
    assert!((shown_share(&browser, yaw).await - 1.0).abs() < 1e-9);

    // A line is hidden by the legend, by the keyboard too.
    browser.keys(".legend [role='button']", "\u{e007}").await;
    assert!(number(&browser, spots).await < 1.0, "a hidden line has no cursor");
    browser.keys(".legend [role='button']", "\u{e007}").await;
    browser.accessible("chart").await;
}
