//! Pages as a browser asks for them.

use std::time::{Duration, Instant};

use reqwest::Method;
use sistership_tests::server::TestServer;

/// What a page may take until its first byte, ms, and have beside its plots, bytes.
const FIRST_BYTE_MS: f64 = 20.0;
const BYTES: usize = 100_000;

/// What was measured of a page.
pub struct Measured {
    first_ms: f64,
    /// Of the requests after the first, in rising order.
    others_ms: Vec<f64>,
    bytes: usize,
    plots: usize,
}

impl Measured {
    /// Asks for a page once, and then so many times.
    ///
    /// # Panics
    /// Where it does not answer with 200.
    pub async fn of(server: &TestServer, page: &str, requests: usize) -> Self {
        let (first, text) = asked(server, page).await;
        let mut others_ms = Vec::new();
        for _ in 0..requests {
            others_ms.push(ms(asked(server, page).await.0));
        }
        others_ms.sort_by(f64::total_cmp);
        Self { first_ms: ms(first), others_ms, bytes: text.len(), plots: plots(&text) }
    }

    fn median_ms(&self) -> f64 {
        self.others_ms.get(self.others_ms.len() / 2).copied().unwrap_or(self.first_ms)
    }

    /// Whether it is as fast and as small as it should be.
    pub fn is_met(&self) -> bool {
        let slowest = self.first_ms.max(self.median_ms());
        slowest <= FIRST_BYTE_MS && self.bytes - self.plots <= BYTES
    }

    /// A row of the table.
    pub fn row(&self, page: &str) -> String {
        let longest = self.others_ms.last().copied().unwrap_or(self.first_ms);
        let kb = |bytes: usize| bytes as f64 / 1e3;
        format!(
            "| `{page}` | {:.0} | {:.0} | {:.1} | {:.1} | {longest:.1} |",
            kb(self.bytes),
            kb(self.plots),
            self.first_ms,
            self.median_ms(),
        )
    }
}

fn ms(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

/// The time until the first byte of a page's body, and the page.
async fn asked(server: &TestServer, page: &str) -> (Duration, String) {
    let request = server.request(Method::GET, page).header("accept", "text/html");
    let begun = Instant::now();
    let mut response = request.send().await.expect("an answer");
    assert_eq!(response.status(), 200, "{page}");
    let mut body = response.chunk().await.expect("a body").unwrap_or_default().to_vec();
    let first = begun.elapsed();
    while let Some(chunk) = response.chunk().await.expect("a body") {
        body.extend_from_slice(&chunk);
    }
    (first, String::from_utf8(body).expect("text"))
}

/// The bytes of a page's plots.
fn plots(page: &str) -> usize {
    let pieces = page.split("<svg").skip(1);
    pieces.map(|piece| piece.find("</svg>").map_or(0, |end| end + "<svg</svg>".len())).sum()
}
