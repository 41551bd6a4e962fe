//! A large fleet, made by REST.

use std::ops::RangeInclusive;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use reqwest::Method;
use serde_json::{Value, json};
use sistership_tests::server::TestServer;

/// Requests at a time.
const AT_ONCE: usize = 8;
/// Between two looks at what the index has done.
const PAUSE: Duration = Duration::from_millis(500);

/// Makes so many ships, and waits until they can be searched for.
pub async fn made(server: &TestServer, ships: usize) {
    let next = AtomicUsize::new(0);
    let maker = async || {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= ships {
                return;
            }
            let sent = server.send(Method::POST, "/v1/ships", &ship(number), &[]).await;
            assert_eq!(sent.0, 201, "{}", sent.1);
        }
    };
    futures::future::join_all((0..AT_ONCE).map(|_| maker())).await;
    settled(server).await;
}

/// Waits until the fleet's page says nothing of ships that change; of a page that is not measured.
pub async fn settled(server: &TestServer) {
    loop {
        let asked = server.request(Method::GET, "/?standing=holds").header("accept", "text/html");
        let page = asked.send().await.expect("an answer").text().await.expect("a page");
        tokio::time::sleep(PAUSE).await;
        if !page.contains("Some ships changed a moment ago") {
            return;
        }
    }
}

/// A ship of made-up particulars within what is usual for its kind.
fn ship(number: usize) -> Value {
    let mut random = ChaCha12Rng::seed_from_u64(number as u64);
    let mut within = |range: RangeInclusive<f64>| random.random_range(range);
    let length = within(100.0..=300.0);
    let beam = length / within(5.5..=7.5);
    let draught = beam / within(2.2..=3.4);
    let block = within(0.55..=0.85);
    let category = ["tanker", "dry-cargo"][number % 2];
    json!({
        "name": format!("ship-{number:05}"),
        "title": format!("Ship {number}"),
        "category": category,
        "kind": "vessel",
        "sources": { "made-up": { "citation": "made up for a measurement" } },
        "particulars": { "source": "made-up", "values": {
            "lpp_m": length,
            "beam_m": beam,
            "draught_m": draught,
            "block_coefficient": block,
            "displacement_m3": block * length * beam * draught,
            "service_speed_m_s": within(6.0..=11.0),
            "rudder_area_m2": length * draught / 55.0,
            "propeller_diameter_m": 0.5 * draught,
        } },
    })
}
